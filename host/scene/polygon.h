// Splitting a polygon into triangles. Our own, because tinyobjloader 2.0 rc10 makes overlapping and missing
// triangles of concave polygons and chooses their projection by a fixed epsilon. Feeds obj_import.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

// Corner numbers of triangles, three each.
using PolygonTriangles = std::vector<std::array<std::uint32_t, 3>>;

// Exactly corners.size() - 2 triangles, wound as the polygon (3 corners or more): a fan from the first corner
// when it is strictly convex, else ears clipped in the plane of its mean normal. Where that finds no ear (the
// outline crosses itself or is flat) or takes too long (thousands of corners in a nasty order), the rest
// becomes a fan.
[[nodiscard]] PolygonTriangles split_polygon(std::span<const Vec3> corners);

}  // namespace gnomon
