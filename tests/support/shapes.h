// Small sets of triangles and rays for tests: seeded, no files, no devices.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/shared/layout.h"

namespace gnomon::test {

// Floats from raw engine output, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float between(float low, float high) {
    const double unit = static_cast<double>(engine_()) / 4294967296.0;
    return static_cast<float>(low + (static_cast<double>(high) - low) * unit);
  }
  std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>(engine_() % limit); }

 private:
  std::mt19937 engine_;
};

inline GnTriangle triangle(std::array<float, 3> a, std::array<float, 3> b, std::array<float, 3> c) {
  GnTriangle t{};
  for (std::size_t k = 0; k < 3; ++k) {
    t.v0[k] = a[k];
    t.v1[k] = b[k];
    t.v2[k] = c[k];
  }
  return t;
}

// Triangles of edge length about `size` spread through a cube of side 10 around `offset`.
inline std::vector<GnTriangle> soup(std::uint32_t count, std::uint32_t seed, float size = 0.5F,
                                    float offset = 0.0F) {
  Random random(seed);
  std::vector<GnTriangle> out(count);
  for (GnTriangle& t : out) {
    std::array<float, 3> centre{};
    for (float& x : centre) x = offset + random.between(0.0F, 10.0F);
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] = centre[k] + random.between(-size, size);
    }
  }
  return out;
}

// A square grid of n x n cells, two triangles each, in the plane y = height: flat, axis-aligned, all edges
// shared.
inline std::vector<GnTriangle> grid(std::uint32_t n, float height = 0.0F) {
  std::vector<GnTriangle> out;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return std::array<float, 3>{static_cast<float>(i), height, static_cast<float>(j)};
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      out.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      out.push_back(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  return out;
}

inline std::vector<GnTriangle> repeated(const GnTriangle& t, std::uint32_t count) {
  return {count, t};
}

// Every coordinate times `scale`, plus `offset`.
inline std::vector<GnTriangle> scaled(std::vector<GnTriangle> triangles, float scale, float offset) {
  for (GnTriangle& t : triangles) {
    for (float* v : {t.v0, t.v1, t.v2})
      for (std::size_t k = 0; k < 3; ++k) v[k] = v[k] * scale + offset;
  }
  return triangles;
}

// Named inputs on which builders go wrong.
inline std::vector<std::pair<std::string, std::vector<GnTriangle>>> awkward_inputs() {
  std::vector<std::pair<std::string, std::vector<GnTriangle>>> out;
  out.emplace_back("none", std::vector<GnTriangle>{});
  out.emplace_back("one", soup(1, 1));
  out.emplace_back("two", soup(2, 2));
  out.emplace_back("nine", soup(9, 3));
  out.emplace_back("one triangle 500 times", repeated(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 500));
  out.emplace_back("flat grid", grid(12));
  std::vector<GnTriangle> same_centre;
  for (int i = 1; i <= 100; ++i) {
    const auto r = static_cast<float>(i);
    same_centre.push_back(triangle({-r, -r, -r}, {r, r, r}, {r, -r, 0}));
  }
  out.emplace_back("all centroids equal", same_centre);
  std::vector<GnTriangle> line;
  for (int i = 0; i < 300; ++i) {
    const auto x = static_cast<float>(i * i);
    line.push_back(triangle({x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}));
  }
  out.emplace_back("collinear", line);
  std::vector<GnTriangle> geometric;  // each step doubles: a binned builder peels one off per level
  for (int i = -60; i < 40; ++i) {
    const float x = std::ldexp(1.0F, i);
    geometric.push_back(triangle({x, 0, 0}, {x * 1.5F, 0, 0}, {x, x, 0}));
  }
  out.emplace_back("doubling distances", geometric);
  out.emplace_back("far from the origin", soup(400, 4, 0.5F, 1.0e6F));
  out.emplace_back("very far", soup(400, 5, 0.5F, 1.0e9F));
  std::vector<GnTriangle> signed_zero = grid(4);
  for (GnTriangle& t : signed_zero) {
    for (float* v : {t.v0, t.v1, t.v2}) v[1] = v[0] > 1.5F ? -0.0F : 0.0F;
  }
  out.emplace_back("signed zeros", signed_zero);
  std::vector<GnTriangle> points(70, triangle({1, 2, 3}, {1, 2, 3}, {1, 2, 3}));
  out.emplace_back("seventy points in one place", points);
  return out;
}

// Small triangles in a cube of side 16, and large ones whose corners are on its lattice: many of these lie
// exactly in the planes that halve the cube again and again, along which the best builder divides.
inline std::vector<GnTriangle> corners_in_planes(std::uint32_t small, std::uint32_t large,
                                                 std::uint32_t seed) {
  std::vector<GnTriangle> out = soup(small, seed, 0.1F, 1.0F);
  Random random(seed + 1);
  const auto place = [&] {
    std::array<float, 3> at{};
    for (float& x : at) x = static_cast<float>(2 * random.below(9));
    return at;
  };
  out.push_back(triangle({0, 0, 0}, {16, 16, 16}, {16, 0, 16}));
  for (std::uint32_t i = 0; i < large; ++i) out.push_back(triangle(place(), place(), place()));
  return out;
}

inline GnRay ray(std::array<float, 3> origin, std::array<float, 3> direction, float tmin = 0.0F,
                 float tmax = std::numeric_limits<float>::infinity()) {
  GnRay r{};
  for (std::size_t k = 0; k < 3; ++k) {
    r.origin[k] = origin[k];
    r.direction[k] = direction[k];
  }
  r.tmin = tmin;
  r.tmax = tmax;
  return r;
}

inline GnRay random_ray(Random& random, float low = -2.0F, float high = 12.0F) {
  std::array<float, 3> origin{};
  std::array<float, 3> direction{};
  for (float& x : origin) x = random.between(low, high);
  for (float& x : direction) x = random.between(-1.0F, 1.0F);
  return ray(origin, direction);
}

inline std::vector<GnRay> random_rays(std::uint32_t count, std::uint32_t seed, float low = -2.0F,
                                      float high = 12.0F) {
  Random random(seed);
  std::vector<GnRay> out;
  for (std::uint32_t i = 0; i < count; ++i) out.push_back(random_ray(random, low, high));
  return out;
}

// The float corners of a triangle, by number.
inline const float* corner(const GnTriangle& t, std::size_t i) {
  return i == 0 ? t.v0 : i == 1 ? t.v1 : t.v2;
}

// A ray from `origin` whose direction is exactly target - origin where floats allow it.
inline GnRay aimed(std::array<float, 3> origin, const float* target) {
  return ray(origin, {target[0] - origin[0], target[1] - origin[1], target[2] - origin[2]});
}

}  // namespace gnomon::test
