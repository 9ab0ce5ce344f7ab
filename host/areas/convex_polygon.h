// Convex polygons in the plane: the outlines of boxes as an area sees them. Not for concave ones. A polygon
// is its corners in order, either way round; corners may repeat or lie on a side. Feeds projection and
// overlap measures.
#pragma once

#include <span>
#include <vector>

#include "gnomon/areas/vector.h"

namespace gnomon {

using Polygon2d = std::vector<Vec2d>;

// Gauss's formula (thesis A.10), positive for counter-clockwise corners. Taken from the first corner, so its
// error is 2^-50 of the polygon's extent squared wherever it lies. Fewer than three corners have no area.
[[nodiscard]] double signed_area_of(std::span<const Vec2d> polygon);
[[nodiscard]] double area_of(std::span<const Vec2d> polygon);

// Whether the point is in the closed polygon (thesis A.8). Within 2^-48 of the extent of polygon and point
// together counts as on a side. Segments and points are polygons too; without corners nothing is inside.
[[nodiscard]] bool contains(std::span<const Vec2d> polygon, const Vec2d& point);

// What two polygons share, counter-clockwise (thesis A.9, by clipping one with every side of the other:
// Sutherland and Hodgman 1974). Corners have no tolerance: parallel and common sides are ordinary cases.
// Polygons that only touch share a point, a segment or nothing, all of area 0.
[[nodiscard]] Polygon2d intersection_of(std::span<const Vec2d> a, std::span<const Vec2d> b);

// The same points sorted counter-clockwise about their mean, for corners of a convex polygon in any order
// (thesis A.9.3). Ties by distance from the mean, then by place: a strict weak order of any input without
// NaN.
[[nodiscard]] Polygon2d in_counter_clockwise_order(std::span<const Vec2d> points);

// The smallest convex polygon around any points, counter-clockwise, without corners on a side (Andrew 1979).
[[nodiscard]] Polygon2d convex_hull_of(std::span<const Vec2d> points);

}  // namespace gnomon
