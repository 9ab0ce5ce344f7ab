// What the tests of areas share: random boxes and areas, error bars, and answers found the slow way.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/areas/box.h"
#include "gnomon/areas/influence_area.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon::test {

constexpr double kPiD = std::numbers::pi;
constexpr double kDegree = kPiD / 180.0;

class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return random_.between(low, high); }
  Vec3d point(double low, double high) {
    const double x = between(low, high);
    const double y = between(low, high);
    return {x, y, between(low, high)};
  }
  Vec2d point2(double low, double high) {
    const double x = between(low, high);
    return {x, between(low, high)};
  }
  // Uniform on the unit sphere, by rejection.
  Vec3d direction() {
    for (;;) {
      const Vec3d v = point(-1.0, 1.0);
      const double squared = dot(v, v);
      if (squared > 0.01 && squared <= 1.0) return 1.0 / std::sqrt(squared) * v;
    }
  }
  // Sides from 2^-5 to 2^3, each axis on its own: cubes, plates and needles.
  Box3d box(double low, double high) {
    const Vec3d centre = point(low, high);
    Vec3d half{};
    for (double& h : half) h = std::exp2(between(-6.0, 2.0));
    return {centre - half, centre + half};
  }
  SteadyRandom& raw() { return random_; }

 private:
  SteadyRandom random_;
};

// Whether `hits` of `count` is what a probability gives, within five standard deviations (and one count).
inline void require_share(std::uint64_t hits, std::uint64_t count, double probability) {
  const double n = static_cast<double>(count);
  const double p = probability;
  const double sigma = std::sqrt(n * std::max(p * (1.0 - p), 0.0));
  const double off = static_cast<double>(hits) - n * p;
  CAPTURE(hits, count, probability, sigma, off);
  REQUIRE(p >= 0.0);
  REQUIRE(p <= 1.0 + 1e-9);
  REQUIRE(std::abs(off) <= 5.0 * sigma + 1.0);
}

// All 26 directions with components -1, 0 and 1, made uneven so that no symmetry hides a mistake.
inline std::vector<Vec3d> direction_classes() {
  std::vector<Vec3d> classes;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) classes.push_back({0.9 * x, 0.5 * y, 0.7 * z});
      }
    }
  }
  return classes;
}

// Point areas of all shapes: narrow, wide, one-sided, turned, looking straight up and along (1, 1, 1).
inline std::vector<std::pair<std::string, PointView>> point_views() {
  const auto view = [](Vec3d eye, Vec3d direction, double x, double y, double near, double far) {
    PointView v;
    v.eye = eye;
    v.direction = direction;
    v.fov_x = x * kDegree;
    v.fov_y = y * kDegree;
    v.near_distance = near;
    v.far_distance = far;
    return v;
  };
  std::vector<std::pair<std::string, PointView>> views{
      {"along z", view({0.3, 0.2, -4.0}, {0, 0, 1}, 60, 40, 1, 20)},
      {"oblique", view({5, 6, -3}, {-0.55, -0.9, 1}, 90, 60, 1, 20)},
      {"along (1, 1, 1)", view({-3, -3, -3}, {1, 1, 1}, 60, 60, 0.5, 12)},
      {"straight up", view({0.1, -5, 0.2}, {0, 1, 0}, 50, 80, 1, 15)},
      {"straight down", view({0.1, 5, 0.2}, {0, -1, 0}, 130, 45, 1, 15)},
      {"1 by 1 degree", view({0, 0, -6}, {0.1, 0.05, 1}, 1, 1, 1, 20)},
      {"179 by 179 degrees", view({0.2, 0.1, 0.3}, {0.3, 0.2, 1}, 179, 179, 0.1, 10)},
      {"179 by 1 degree", view({0.2, 0.1, 0.3}, {1, -0.2, 0.1}, 179, 1, 0.1, 10)},
      {"back along -x", view({6, 0.5, 0.25}, {-1, 0, 0}, 130, 45, 1, 30)},
  };
  PointView turned = views[1].second;
  turned.up = {1.0, 0.5, 0.25};
  views.emplace_back("turned", turned);
  return views;
}

inline std::vector<std::pair<std::string, PlaneWindow>> plane_windows() {
  const auto window = [](Vec3d point, Vec3d direction, double w, double h, double depth) {
    PlaneWindow p;
    p.point = point;
    p.direction = direction;
    p.half_width = w;
    p.half_height = h;
    p.depth = depth;
    return p;
  };
  std::vector<std::pair<std::string, PlaneWindow>> windows;
  for (const Vec3d& d : direction_classes())
    windows.emplace_back("class", window({0.2, -0.3, 0.4}, d, 2.5, 1.5, 6.0));
  windows.emplace_back("along (1, 1, 1)", window({-3, -3, -3}, {1, 1, 1}, 3, 2, 12));
  windows.emplace_back("narrow", window({0, 0, -5}, {0.1, 0.2, 1}, 0.05, 4, 12));
  return windows;
}

// Whether body and box meet, by cutting the box's faces with the body's planes, moved outwards by `slack`;
// the one case without a cut face is a body inside the box.
template <typename Planes, typename Corners>
bool meet_by_cutting(const Planes& planes, const Corners& corners, const Box3d& box, double slack) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool at_hi : {false, true}) {
      const unsigned u = 1U << (axis + 1) % 3;
      const unsigned v = 1U << (axis + 2) % 3;
      const unsigned base = at_hi ? 1U << axis : 0U;
      std::vector<Vec3d> face{corner_of(box, base), corner_of(box, base | u), corner_of(box, base | u | v),
                              corner_of(box, base | v)};
      for (const Plane& plane : planes) {
        std::vector<Vec3d> kept;
        for (std::size_t i = 0; i < face.size(); ++i) {
          const Vec3d& p = face[i];
          const Vec3d& q = face[(i + 1) % face.size()];
          const double p_side = dot(plane.normal, p) + plane.offset + slack;
          const double q_side = dot(plane.normal, q) + plane.offset + slack;
          if (p_side >= 0.0) kept.push_back(p);
          if ((p_side < 0.0) != (q_side < 0.0)) kept.push_back(p + p_side / (p_side - q_side) * (q - p));
        }
        face = kept;
      }
      if (!face.empty()) return true;
    }
  }
  for (const Vec3d& corner : corners) {
    if (contains(box, corner)) return true;
  }
  return false;
}

}  // namespace gnomon::test
