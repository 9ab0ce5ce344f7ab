// How much of an area's rays meet a box: the projected area heuristic's measures, in double precision and
// with no case left out. The reference for shared and device code, not the fast path. Feeds predictions and
// tests.
#pragma once

#include "gnomon/areas/convex_polygon.h"
#include "gnomon/areas/ray_measure.h"

namespace gnomon {

// The measure of all rays of the area; a culled measure over it is the probability that a ray meets the box.
// Plane 4 w h; solid angle 4 asin(sin(fov_x/2) sin(fov_y/2)), omni 4 pi; near plane its window's area; yaw
// and pitch fov_x fov_y. This and all below throw Error{kInvalidArgument} when the area has no such rays.
[[nodiscard]] double window_measure(const InfluenceArea& area, RayMeasure measure);

// The measure of the rays that meet the box (closed, as the slab test sees it) on their way from their start
// to infinity: "culled" in the thesis (1.6). Flat boxes count; empty ones are 0. Relative error 2^-28, or
// 2^-32 of the window's measure where that is larger.
[[nodiscard]] double culled_measure(const InfluenceArea& area, const Box3d& box, RayMeasure measure,
                                    RayStart start = RayStart::kWindow);

// The same with a window without end ("unculled"). Parallel: all lines along the direction, in closed form
// |n_x| d_y d_z + |n_y| d_x d_z + |n_z| d_x d_y. Solid angle: all directions from the eye. Near plane: of the
// part of the box beyond it, finite because that part is; what lies nearer is left out. kYawPitch has none:
// it throws.
[[nodiscard]] double projected_measure(const InfluenceArea& area, const Box3d& box, RayMeasure measure);

// The outlines behind these measures as convex polygons in the window's plane: coordinates along the frame's
// right and up from its middle, in lengths. For overlaps of siblings. kParallel and kNearPlane only, else
// they throw. A parallel projected_hull has six corners always; the others have none where nothing is seen.
[[nodiscard]] Polygon2d culled_hull(const InfluenceArea& area, const Box3d& box, RayMeasure measure,
                                    RayStart start = RayStart::kWindow);
[[nodiscard]] Polygon2d projected_hull(const InfluenceArea& area, const Box3d& box, RayMeasure measure);

}  // namespace gnomon
