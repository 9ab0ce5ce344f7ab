// Refitting a tree to triangles that have moved, in plain C++: what the device's refit (refit_device.h, which
// says what it promises) is tested against, bit for bit. Feeds tests and tools.
#pragma once

#include <cstddef>
#include <span>

#include "gnomon/tree/bvh.h"
#include "gnomon/tree/wide.h"

namespace gnomon {

// Throws Error: kInvalidArgument (another number of triangles), kBadScene; the tree is then as it was.
void refit_reference(Bvh& bvh, std::span<const GnTriangle> triangles);
void refit_reference(WideBvh& wide, std::span<const GnTriangle> triangles);

// Throws Error{kInvalidArgument} unless a tree of `built` triangles is refitted to as many.
void require_count(std::size_t given, std::size_t built);

}  // namespace gnomon
