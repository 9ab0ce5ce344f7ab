#include "gnomon/areas/solids.h"

namespace gnomon {
namespace {

constexpr double kUpAlongDirection = 0x1p-20;

Vec3d replacement_right(const Vec3d& forward) {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(forward[axis]) < std::abs(forward[least])) least = axis;
  }
  Vec3d right{0.0, 0.0, 0.0};
  right[least] = 1.0;
  return right;
}

}  // namespace

AreaFrame look_along(const Vec3d& origin, const Vec3d& direction, const Vec3d& up_hint) {
  const Vec3d forward = unit_of(direction);
  Vec3d right = cross(unit_of(up_hint), forward);
  if (length(right) <= kUpAlongDirection) right = replacement_right(forward);
  right = unit_of(right);
  // Once more, because a short cross product is orthogonal only to its own rounding.
  right = unit_of(right - dot(right, forward) * forward);
  return {origin, right, cross(forward, right), forward};
}

Vec3d to_local(const AreaFrame& frame, const Vec3d& point) {
  const Vec3d d = point - frame.origin;
  return {dot(d, frame.right), dot(d, frame.up), dot(d, frame.forward)};
}

Vec3d to_world(const AreaFrame& frame, const Vec3d& local) {
  return frame.origin + local[0] * frame.right + local[1] * frame.up + local[2] * frame.forward;
}

bool contains(const OrientedBox& body, const Vec3d& point) {
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k)
    inside &= std::abs(dot(point - body.centre, body.axes[k])) <= body.half[k];
  return inside;
}

bool contains(const Frustum& body, const Vec3d& point) {
  const auto [x, y, z] = to_local(body.frame, point);
  return body.near_distance <= z && z <= body.far_distance && std::abs(x) <= z * body.tan_x &&
         std::abs(y) <= z * body.tan_y;
}

bool contains(const Ball& body, const Vec3d& point) {
  return length(point - body.centre) <= body.radius;
}

std::array<Plane, 6> planes_of(const OrientedBox& body) {
  std::array<Plane, 6> planes{};
  for (std::size_t k = 0; k < 3; ++k) {
    planes[2 * k] = plane_through(body.centre - body.half[k] * body.axes[k], body.axes[k]);
    planes[2 * k + 1] = plane_through(body.centre + body.half[k] * body.axes[k], -body.axes[k]);
  }
  return planes;
}

std::array<Plane, 6> planes_of(const Frustum& body) {
  const AreaFrame& f = body.frame;
  return {plane_through(f.origin + body.near_distance * f.forward, f.forward),
          plane_through(f.origin + body.far_distance * f.forward, -f.forward),
          plane_through(f.origin, unit_of(body.tan_x * f.forward + f.right)),
          plane_through(f.origin, unit_of(body.tan_x * f.forward - f.right)),
          plane_through(f.origin, unit_of(body.tan_y * f.forward + f.up)),
          plane_through(f.origin, unit_of(body.tan_y * f.forward - f.up))};
}

std::array<Vec3d, 8> corners_of(const OrientedBox& body) {
  std::array<Vec3d, 8> corners{};
  for (unsigned i = 0; i < 8; ++i) {
    corners[i] = body.centre;
    for (unsigned k = 0; k < 3; ++k) {
      const double side = (i >> k & 1U) != 0 ? body.half[k] : -body.half[k];
      corners[i] = corners[i] + side * body.axes[k];
    }
  }
  return corners;
}

std::array<Vec3d, 8> corners_of(const Frustum& body) {
  std::array<Vec3d, 8> corners{};
  for (unsigned i = 0; i < 8; ++i) {
    const double z = (i & 4U) != 0 ? body.far_distance : body.near_distance;
    const double x = (i & 1U) != 0 ? body.tan_x : -body.tan_x;
    const double y = (i & 2U) != 0 ? body.tan_y : -body.tan_y;
    corners[i] = to_world(body.frame, {x * z, y * z, z});
  }
  return corners;
}

}  // namespace gnomon
