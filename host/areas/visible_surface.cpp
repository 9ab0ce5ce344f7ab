#include "gnomon/areas/visible_surface.h"

#include "gnomon/areas/solid_angle.h"

namespace gnomon {
namespace {

Polygon3d in_local(const AreaFrame& frame, Polygon3d polygon) {
  for (Vec3d& corner : polygon) corner = to_local(frame, corner);
  return polygon;
}

// The half-space of points whose world coordinate on an axis is >= (sign 1) or <= (sign -1) a bound, in local
// coordinates.
Plane local_bound(const AreaFrame& frame, std::size_t axis, double sign, double bound) {
  return {sign * Vec3d{frame.right[axis], frame.up[axis], frame.forward[axis]},
          sign * (frame.origin[axis] - bound)};
}

Polygon3d window_at(double z, const WindowSlopes& slopes) {
  const double x = z * slopes.x;
  const double y = z * slopes.y;
  return {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}};
}

// What of the near plane is inside the box.
Polygon3d cap_of(const Frustum& frustum, const Box3d& box, const WindowSlopes& slopes) {
  Polygon3d cap = window_at(frustum.near_distance, slopes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cap = clip(cap, local_bound(frustum.frame, axis, 1.0, box.lo[axis]));
    cap = clip(cap, local_bound(frustum.frame, axis, -1.0, box.hi[axis]));
  }
  return cap;
}

// For an eye in the closed box: the window's directions that lead inside, which are all but for an eye on a
// face. A flat box has both faces there and no inside; like a box with one face there it gets half of the
// directions, which half does not matter to their solid angle.
Polygon3d directions_inside(const Frustum& frustum, const Box3d& box, const WindowSlopes& slopes) {
  const Vec3d& eye = frustum.frame.origin;
  Polygon3d window = window_at(frustum.near_distance, slopes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (eye[axis] == box.lo[axis]) {
      window = clip(window, local_bound(frustum.frame, axis, 1.0, eye[axis]));
    } else if (eye[axis] == box.hi[axis]) {
      window = clip(window, local_bound(frustum.frame, axis, -1.0, eye[axis]));
    }
  }
  return window;
}

}  // namespace

std::vector<Polygon3d> visible_surface(const Frustum& frustum, const Box3d& box, RayStart start,
                                       const WindowSlopes& slopes) {
  if (is_empty(box)) return {};
  const Vec3d& eye = frustum.frame.origin;
  if (start == RayStart::kEye && contains(box, eye)) return {directions_inside(frustum, box, slopes)};
  const std::array<Plane, 5> window{{{{1.0, 0.0, slopes.x}, 0.0},
                                     {{-1.0, 0.0, slopes.x}, 0.0},
                                     {{0.0, 1.0, slopes.y}, 0.0},
                                     {{0.0, -1.0, slopes.y}, 0.0},
                                     {{0.0, 0.0, 1.0}, -frustum.near_distance}}};
  // From the eye only the four sides cut, and they meet in the eye: nothing beside or behind it is left.
  const std::span<const Plane> cuts(window.data(), start == RayStart::kEye ? 4 : 5);
  std::vector<Polygon3d> pieces;
  const auto add = [&pieces](Polygon3d piece) {
    if (piece.size() >= 3) pieces.push_back(std::move(piece));
  };
  for (unsigned axis = 0; axis < 3; ++axis) {
    const bool below = eye[axis] < box.lo[axis];
    const bool above = eye[axis] > box.hi[axis];
    if (below || above) add(clip(in_local(frustum.frame, face_of(box, axis, above)), cuts));
  }
  if (start == RayStart::kWindow) add(cap_of(frustum, box, slopes));
  return pieces;
}

}  // namespace gnomon
