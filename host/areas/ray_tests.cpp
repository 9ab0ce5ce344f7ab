#include "gnomon/areas/ray_tests.h"

#include <array>

namespace gnomon {
namespace {

constexpr double kParallel = 0x1p-50;
constexpr double kOnEdge = 0x1p-46;

}  // namespace

Ray3d to_ray3d(const GnRay& ray) {
  Ray3d out{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    out.origin[axis] = static_cast<double>(ray.origin[axis]);
    out.direction[axis] = static_cast<double>(ray.direction[axis]);
  }
  return out;
}

std::optional<Interval> intersect(const Ray3d& ray, const Box3d& box) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Interval inside{-kInfinity, kInfinity};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis];
    const double d = ray.direction[axis];
    if (d == 0.0) {
      // Dividing would give 0/0 for an origin in a face, and NaN would decide by the order of comparisons.
      if (!(box.lo[axis] <= o && o <= box.hi[axis])) return std::nullopt;
      continue;
    }
    // Chosen by the sign of d, not sorted: so an empty box stays empty.
    inside.entry = larger(((d > 0.0 ? box.lo[axis] : box.hi[axis]) - o) / d, inside.entry);
    inside.exit = smaller(((d > 0.0 ? box.hi[axis] : box.lo[axis]) - o) / d, inside.exit);
  }
  if (!(inside.entry <= inside.exit && inside.exit >= 0.0)) return std::nullopt;
  return inside;
}

Plane plane_through(const Vec3d& point, const Vec3d& normal) {
  return {normal, -dot(normal, point)};
}

double signed_distance(const Plane& plane, const Vec3d& point) {
  return dot(plane.normal, point) + plane.offset;
}

std::optional<double> intersect(const Ray3d& ray, const Plane& plane) {
  const double slope = dot(plane.normal, ray.direction);
  double terms = 0.0;
  for (unsigned axis = 0; axis < 3; ++axis) terms += std::abs(plane.normal[axis] * ray.direction[axis]);
  if (!(std::abs(slope) > kParallel * terms)) return std::nullopt;
  return -signed_distance(plane, ray.origin) / slope;
}

std::optional<double> intersect(const Ray3d& ray, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  if (!(magnitude(normal) > 0.0)) return std::nullopt;
  // The plane as seen from the first corner: far from the origin n.o + offset would cancel.
  const std::optional<double> t =
      intersect(Ray3d{ray.origin - a, ray.direction}, plane_through({0.0, 0.0, 0.0}, normal));
  if (!t || *t < 0.0) return std::nullopt;
  const Vec3d point = ray.origin + *t * ray.direction;
  const double scale =
      larger(larger(magnitude(a), magnitude(b)), larger(magnitude(c), magnitude(ray.origin)));
  const std::array<Vec3d, 3> corners{a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d edge = corners[(i + 1) % 3] - corners[i];
    const double side = dot(cross(edge, point - corners[i]), normal);
    if (side < -kOnEdge * scale * length(edge) * length(normal)) return std::nullopt;
  }
  return t;
}

}  // namespace gnomon
