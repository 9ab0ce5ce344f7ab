#include "gnomon/stability/aim.h"

#include <algorithm>
#include <cmath>

namespace gnomon::stability {

Ray ray_of(const Point& origin, const Point& direction, float tmin, float tmax) {
  Ray ray{};
  std::copy(origin.begin(), origin.end(), ray.origin);
  std::copy(direction.begin(), direction.end(), ray.direction);
  ray.tmin = tmin;
  ray.tmax = tmax;
  return ray;
}

Point middle_of(const Point& a, const Point& b) {
  Point m{};
  for (std::size_t k = 0; k < 3; ++k) m[k] = 0.5F * a[k] + 0.5F * b[k];
  return m;
}

Ray towards(const Point& origin, const Point& target) {
  return ray_of(origin, {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
}

bool passes_exactly(const Ray& ray, const Point& target) {
  for (std::size_t k = 0; k < 3; ++k) {
    // Exact where both are floats within 2^29 of each other; a ray that is not exact differs by more than
    // this rounds.
    if (static_cast<double>(ray.origin[k]) + static_cast<double>(ray.direction[k]) !=
        static_cast<double>(target[k]))
      return false;
  }
  return true;
}

Ray through(const Point& target, float reach, SteadyRandom& random) {
  Point origin{};
  Point direction{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double place = target[k];
    const float magnitude = std::fabs(target[k]);
    if (magnitude == 0.0F) {
      direction[k] = static_cast<float>(random.between(-1.0, 1.0)) * reach;
      origin[k] = -direction[k];
      continue;
    }
    // In last bits of the target: an even number of them up to twice the target is a float.
    const double bit =
        static_cast<double>(std::nextafter(magnitude, kInfinity)) - static_cast<double>(magnitude);
    const double wanted = random.between(-1.0, 1.0) * static_cast<double>(std::min(magnitude, reach));
    const double start = 2.0 * std::nearbyint((place - wanted) / (2.0 * bit));
    origin[k] = static_cast<float>(start * bit);
    direction[k] = static_cast<float>(place - start * bit);
  }
  if (direction == Point{0, 0, 0}) {  // a reach of less than the target's last bits
    direction[1] = 0x1p-20F * std::max(std::fabs(target[1]), 1.0F);
    origin[1] = target[1] - direction[1];
  }
  return ray_of(origin, direction);
}

Point place_on(const Triangle& triangle, std::uint32_t kind, SteadyRandom& random) {
  const Point a = corner(triangle, 0);
  const Point b = corner(triangle, 1);
  const Point c = corner(triangle, 2);
  const std::uint32_t which = random.below(3);
  if (kind == 0) return corner(triangle, which);
  if (kind == 1) return middle_of(corner(triangle, which), corner(triangle, (which + 1) % 3));
  Point p{};
  for (std::size_t k = 0; k < 3; ++k) p[k] = 0.25F * a[k] + 0.25F * b[k] + 0.5F * c[k];
  return p;
}

float Extent::size() const {
  return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
}

Extent extent_of(std::span<const Triangle> triangles) {
  Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const Triangle& t : triangles) {
    for (const float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) {
        extent.lo[k] = std::min(extent.lo[k], v[k]);
        extent.hi[k] = std::max(extent.hi[k], v[k]);
      }
    }
  }
  return extent;
}

}  // namespace gnomon::stability
