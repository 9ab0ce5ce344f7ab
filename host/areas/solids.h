// The convex bodies that influence areas are: oriented boxes, frusta and balls, and whether points and boxes
// are in them. Not for rays or projections. Feeds influence_area and membership.
#pragma once

#include <array>

#include "gnomon/areas/box.h"
#include "gnomon/areas/ray_tests.h"

namespace gnomon {

// An orthonormal frame with up x forward = right. Local coordinates are along right, up and forward.
struct AreaFrame {
  Vec3d origin{0.0, 0.0, 0.0};
  Vec3d right{1.0, 0.0, 0.0};
  Vec3d up{0.0, 1.0, 0.0};
  Vec3d forward{0.0, 0.0, 1.0};
};
// right = up x f and up' = f x right, made unit (thesis 1.1). An up hint within 2^-20 of the direction's line
// is replaced: right is then the world axis least along f made orthogonal to it, the first of equals, so (1,
// 0, 0) for f = +-y. Neither vector need have unit length; neither may be {0, 0, 0}.
[[nodiscard]] AreaFrame look_along(const Vec3d& origin, const Vec3d& direction, const Vec3d& up_hint);
[[nodiscard]] Vec3d to_local(const AreaFrame& frame, const Vec3d& point);
[[nodiscard]] Vec3d to_world(const AreaFrame& frame, const Vec3d& local);

// The points within half[k] of the centre along each axes[k]; the axes are orthonormal.
struct OrientedBox {
  Vec3d centre;
  std::array<Vec3d, 3> axes;
  Vec3d half;
};

// The points with local near <= z <= far, |x| <= z tan_x, |y| <= z tan_y, seen from the frame's origin.
struct Frustum {
  AreaFrame frame;
  double tan_x;
  double tan_y;
  double near_distance;
  double far_distance;
};

struct Ball {
  Vec3d centre;
  double radius;
};

// Whether the closed body has the point; no tolerance but a few roundings of the point's distance from the
// body's centre or eye. The frustum needs no division and no matrix (thesis A.7).
[[nodiscard]] bool contains(const OrientedBox& body, const Vec3d& point);
[[nodiscard]] bool contains(const Frustum& body, const Vec3d& point);
[[nodiscard]] bool contains(const Ball& body, const Vec3d& point);

// Whether body and box share a point, by separating axes (thesis A.5): 15 for the oriented box, 26 for the
// frustum (5 + 3 normals, 6 x 3 edge pairs); cross products of edges within 2^-30 of parallel are left out.
// Never false for bodies that touch: a gap must exceed 2^-46 of the coordinates along the axis.
[[nodiscard]] bool overlap(const OrientedBox& body, const Box3d& box);
[[nodiscard]] bool overlap(const Frustum& body, const Box3d& box);
[[nodiscard]] bool overlap(const Ball& body, const Box3d& box);

// The bounding planes, inner side inwards, of unit normals.
[[nodiscard]] std::array<Plane, 6> planes_of(const OrientedBox& body);
[[nodiscard]] std::array<Plane, 6> planes_of(const Frustum& body);

[[nodiscard]] std::array<Vec3d, 8> corners_of(const OrientedBox& body);
[[nodiscard]] std::array<Vec3d, 8> corners_of(const Frustum& body);

}  // namespace gnomon
