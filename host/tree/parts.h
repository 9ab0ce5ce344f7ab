// Triangles divided into parts for the best builder, in plain C++: what the device's parts (kernels/parts.cl)
// are tested against, bit for bit. Not for clipping geometry: triangles stay whole, parts are boxes. Feeds
// the best builder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/shared/layout.h"
#include "gnomon/shared/parts_math.h"

namespace gnomon {

// Every triangle's parts in the order of triangles, each as its box and the triangle's number: together they
// hold the triangle. Those whose boxes waste most are divided, at most `budget` parts more than triangles for
// each of these; where dividing does not pay none is. Throws Error{kBadScene} as primitive_of.
[[nodiscard]] std::vector<GnPrimitive> parts_of(std::span<const GnTriangle> triangles, float budget);

// Whether parts_of divides any triangle: whether spatial splits pay, before anything is built. Throws
// Error{kBadScene} as primitive_of.
[[nodiscard]] bool divides_any(std::span<const GnTriangle> triangles, float budget);

// What is divided. bins: triangles by gn_waste_bin. units: GnPlaneGrid's. Returns the grid's floor.
[[nodiscard]] std::uint32_t waste_floor(std::span<const std::uint32_t> bins, float units, float budget);

// The most parts that so many triangles can have.
[[nodiscard]] std::uint64_t most_parts(std::uint64_t triangles, float budget);

}  // namespace gnomon
