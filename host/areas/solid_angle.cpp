#include "gnomon/areas/solid_angle.h"

#include <numbers>

namespace gnomon {

double solid_angle_of(const Vec3d& eye, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u = a - eye;
  const Vec3d v = b - eye;
  const Vec3d w = c - eye;
  const double u_length = length(u);
  const double v_length = length(v);
  const double w_length = length(w);
  const double volume = std::abs(dot(u, cross(b - a, c - a)));
  const double rest =
      u_length * v_length * w_length + dot(u, v) * w_length + dot(u, w) * v_length + dot(v, w) * u_length;
  return 2.0 * std::atan2(volume, rest);
}

double solid_angle_of(const Vec3d& eye, const Polygon3d& polygon) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += solid_angle_of(eye, polygon[0], polygon[i - 1], polygon[i]);
  return sum;
}

Polygon3d face_of(const Box3d& box, unsigned axis, bool at_hi) {
  const unsigned u = 1U << (axis + 1) % 3;
  const unsigned v = 1U << (axis + 2) % 3;
  const unsigned base = at_hi ? 1U << axis : 0U;
  return {corner_of(box, base), corner_of(box, base | u), corner_of(box, base | u | v),
          corner_of(box, base | v)};
}

double solid_angle_of(const Vec3d& eye, const Box3d& box) {
  if (is_empty(box)) return 0.0;
  double inside = 4.0 * std::numbers::pi;
  double seen = 0.0;
  bool outside = false;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const bool below = eye[axis] < box.lo[axis];
    const bool above = eye[axis] > box.hi[axis];
    if (below || above) {
      outside = true;
      seen += solid_angle_of(eye, face_of(box, axis, above));
    } else if (eye[axis] == box.lo[axis] || eye[axis] == box.hi[axis]) {
      inside *= 0.5;
    }
  }
  return outside ? seen : inside;
}

}  // namespace gnomon
