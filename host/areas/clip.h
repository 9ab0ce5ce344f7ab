// Cutting flat convex polygons in space with planes. Feeds visible_surface and membership.
#pragma once

#include <span>
#include <vector>

#include "gnomon/areas/ray_tests.h"

namespace gnomon {

using Polygon3d = std::vector<Vec3d>;

// What lies on the plane's inner side or in it (Sutherland and Hodgman 1974), empty when nothing does. No
// tolerance: callers that must not lose a touching polygon move the plane outwards first.
[[nodiscard]] Polygon3d clip(const Polygon3d& polygon, const Plane& plane);
[[nodiscard]] Polygon3d clip(Polygon3d polygon, std::span<const Plane> planes);

}  // namespace gnomon
