// The part of a box's surface that the rays of a point area meet first, cut to its window in space, before
// anything is divided by depth: so corners beside or behind the eye are ordinary. Feeds projection.
#pragma once

#include <vector>

#include "gnomon/areas/clip.h"
#include "gnomon/areas/ray_measure.h"

namespace gnomon {

// The window as slopes: |x| <= slope_x z and |y| <= slope_y z in local coordinates.
struct WindowSlopes {
  double x;
  double y;
};

// Flat convex polygons in local coordinates (right, up, forward of the eye); seen from the eye none covers
// another and together they cover what the box does. z > 0 but for a touched eye. Rays that begin inside the
// box count as meeting it there: in the near plane, or, from the eye, in every direction that leads inside.
[[nodiscard]] std::vector<Polygon3d> visible_surface(const Frustum& frustum, const Box3d& box, RayStart start,
                                                     const WindowSlopes& slopes);

}  // namespace gnomon
