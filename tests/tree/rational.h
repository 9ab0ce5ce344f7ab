// The ray-triangle problem in rational arithmetic, straight from its definition, and seeded floats to try it
// on. Feeds the tests of the oracle and of the judge.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>

#include "gnomon/shared/layout.h"

namespace rational {

using Rational = boost::multiprecision::cpp_rational;
inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
using Point = std::array<float, 3>;
using Exact = std::array<Rational, 3>;

inline GnRay ray_of(const Point& o, const Point& d, float tmin = 0.0F, float tmax = kInf) {
  return {{o[0], o[1], o[2]}, tmin, {d[0], d[1], d[2]}, tmax};
}

inline GnTriangle triangle_of(const Point& a, const Point& b, const Point& c) {
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}};
}

// Seeded values: the standard's distributions differ between libraries, its engines do not. Draw inside
// braces, whose order is fixed, never as the arguments of one call.
class Source {
 public:
  explicit Source(std::uint64_t seed) : engine_(seed) {}
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  float unit() { return static_cast<float>(engine_() >> 40) * 0x1p-23F - 1.0F; }  // [-1, 1)
  float any_finite() {
    const float value = gn_float_of(static_cast<gn_u32>(engine_()));
    return std::isfinite(value) ? value : 0.0F;
  }
  Point point(float scale = 1.0F, float offset = 0.0F) {
    return {offset + scale * unit(), offset + scale * unit(), offset + scale * unit()};
  }
  Point lattice(int size) {
    return {static_cast<float>(integer(-size, size)), static_cast<float>(integer(-size, size)),
            static_cast<float>(integer(-size, size))};
  }
  // Multiples of 2^-19: differences and up to eight times these are exact floats.
  Point coarse_point() {
    const auto coordinate = [&] { return std::round(unit() * 0x1p19F) * 0x1p-19F; };
    return {coordinate(), coordinate(), coordinate()};
  }
  GnTriangle triangle(float scale = 1.0F, float offset = 0.0F) {
    const std::array<Point, 3> p{point(scale, offset), point(scale, offset), point(scale, offset)};
    return triangle_of(p[0], p[1], p[2]);
  }
  // From a point of the given scale, towards anywhere.
  GnRay ray(float scale = 1.0F, float offset = 0.0F) {
    const std::array<Point, 2> p{point(scale, offset), point()};
    return ray_of(p[0], p[1]);
  }

 private:
  std::mt19937_64 engine_;
};

inline Exact exact(const float p[3]) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

inline Exact minus(const Exact& a, const Exact& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Rational determinant(const Exact& a, const Exact& b, const Exact& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// A ray's line and an edge.
struct Edge {
  Point d, o, a, b;
};

inline int rational_sign(const Edge& e) {
  const Exact origin = exact(e.o.data());
  return determinant(exact(e.d.data()), minus(exact(e.a.data()), origin), minus(exact(e.b.data()), origin))
      .sign();
}

struct RationalHit {
  Rational t, u, v;
};

inline std::optional<RationalHit> rational_intersect(const GnRay& ray, const GnTriangle& triangle) {
  const Exact d = exact(ray.direction);
  const Exact a = minus(exact(triangle.v0), exact(ray.origin));
  const Exact b = minus(exact(triangle.v1), exact(ray.origin));
  const Exact c = minus(exact(triangle.v2), exact(ray.origin));
  const std::array<Rational, 3> w{determinant(d, b, c), determinant(d, c, a), determinant(d, a, b)};
  const bool all_up = w[0] >= 0 && w[1] >= 0 && w[2] >= 0;
  const bool all_down = w[0] <= 0 && w[1] <= 0 && w[2] <= 0;
  if (all_up == all_down) return std::nullopt;  // on both sides, or all zero
  const Rational sum = w[0] + w[1] + w[2];
  return RationalHit{determinant(a, b, c) / sum, w[1] / sum, w[2] / sum};
}

// origin + t * direction, rounded to float.
inline Point along(const Point& o, const Point& d, double t) {
  Point p{};
  for (std::size_t i = 0; i < 3; ++i) p[i] = static_cast<float>(o[i] + t * d[i]);
  return p;
}

inline Point nudged(Point p, Source& source) {
  float& value = p[static_cast<std::size_t>(source.integer(0, 2))];
  value = std::nextafter(value, source.unit() > 0.0F ? kInf : -kInf);
  return p;
}

inline Point difference(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace rational
