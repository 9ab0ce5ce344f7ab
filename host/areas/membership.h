// Which triangles belong to an influence area. Not for boxes (InfluenceArea::overlaps). Feeds local trees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/areas/influence_area.h"

namespace gnomon {

enum class Membership {
  kExact,            // triangle and region share a point: what "no nearer hit is missed" needs
  kVertices,         // a corner is inside: the thesis' program; loses triangles
  kVerticesOrEdges,  // a corner is inside or an edge crosses: the thesis' text; loses triangles that span the
                     // region
};

// Whether closed triangle and closed region share a point: by cutting the triangle with the region's
// half-spaces, or its distance from a ball's centre. Conservative: within 2^-40 of the largest coordinate of
// either counts, far above double rounding and far below float's. Corners that are not finite never belong.
[[nodiscard]] bool touches(const InfluenceArea& area, const GnTriangle& triangle,
                           Membership membership = Membership::kExact);

// The indices of the triangles that touch, ascending. At most 2^32 - 1 triangles.
[[nodiscard]] std::vector<std::uint32_t> members(const InfluenceArea& area,
                                                 std::span<const GnTriangle> triangles,
                                                 Membership membership = Membership::kExact);

// From a point to the nearest one of a closed triangle, which may be flat or a point. Relative error 2^-40,
// or 2^-48 of the coordinates.
[[nodiscard]] double distance_to_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace gnomon
