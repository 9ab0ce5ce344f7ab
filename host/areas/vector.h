// Points and directions in double precision, as plain arrays so that headers need no vector library. Not for
// pictures or scenes, which have their own. Feeds every file of this room.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace gnomon {

using Vec3d = std::array<double, 3>;
using Vec2d = std::array<double, 2>;

[[nodiscard]] inline Vec3d operator+(const Vec3d& a, const Vec3d& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Vec3d operator-(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vec3d operator-(const Vec3d& a) {
  return {-a[0], -a[1], -a[2]};
}
[[nodiscard]] inline Vec3d operator*(double s, const Vec3d& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
[[nodiscard]] inline double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[nodiscard]] inline Vec2d operator-(const Vec2d& a, const Vec2d& b) {
  return {a[0] - b[0], a[1] - b[1]};
}
// Positive where b is counter-clockwise of a.
[[nodiscard]] inline double cross(const Vec2d& a, const Vec2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

[[nodiscard]] inline double larger(double a, double b) {
  return a > b ? a : b;
}
[[nodiscard]] inline double smaller(double a, double b) {
  return a < b ? a : b;
}

// The largest magnitude of a coordinate: what rounding errors and tolerances are measured by.
[[nodiscard]] inline double magnitude(const Vec3d& a) {
  return larger(std::abs(a[0]), larger(std::abs(a[1]), std::abs(a[2])));
}
[[nodiscard]] inline bool is_finite(const Vec3d& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}
[[nodiscard]] inline double length(const Vec3d& a) {
  return std::sqrt(dot(a, a));
}
// Scaled first, so that no length overflows or vanishes. Not for {0, 0, 0}.
[[nodiscard]] inline Vec3d unit_of(const Vec3d& a) {
  const Vec3d scaled = 1.0 / magnitude(a) * a;
  return 1.0 / length(scaled) * scaled;
}

}  // namespace gnomon
