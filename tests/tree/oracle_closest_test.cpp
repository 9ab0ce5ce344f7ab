// The closest hit against rational arithmetic on small scenes, and the filter of candidates against no filter
// on large ones.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "gnomon/tree/candidates.h"
#include "gnomon/tree/oracle.h"
#include "rational.h"

using gnomon::LineFilter;
using gnomon::OracleHit;
using gnomon::Ray;
using gnomon::Triangle;
using namespace rational;

namespace {

// The definition of the closest hit, in rationals.
OracleHit rational_closest(const Ray& ray, const std::vector<Triangle>& triangles) {
  OracleHit closest{kInf, GN_NONE};
  Rational best;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::optional<RationalHit> hit = rational_intersect(ray, triangles[i]);
    if (!hit || hit->t < Rational(ray.tmin)) continue;
    if (ray.tmax < kInf && hit->t > Rational(ray.tmax)) continue;
    if (closest.primitive != GN_NONE && hit->t >= best) continue;
    best = hit->t;
    closest = {static_cast<double>(best), i};
  }
  return closest;
}

bool require_closest(const Ray& ray, const std::vector<Triangle>& triangles) {
  CAPTURE(ray.origin, ray.direction, ray.tmin, ray.tmax);
  const OracleHit expected = rational_closest(ray, triangles);
  const OracleHit found = gnomon::oracle_closest(ray, triangles);
  REQUIRE(found.primitive == expected.primitive);
  if (expected.primitive == GN_NONE) {
    REQUIRE(found.t == kInf);
    return false;
  }
  REQUIRE(found.t == Approx(expected.t).epsilon(1e-11));
  return true;
}

// Seven triangles around a hub, among others; the hub is such that rays can be aimed at it exactly.
struct Fan {
  Point hub;
  std::vector<Triangle> triangles;

  explicit Fan(Source& source) : hub(source.coarse_point()) {
    std::vector<Point> rim(7);
    for (Point& p : rim) p = source.point(0.3F);
    for (std::size_t i = 0; i < 7; ++i) triangles.push_back(triangle_of(rim[(i + 1) % 7], hub, rim[i]));
    for (int i = 0; i < 8; ++i) triangles.push_back(source.triangle());
  }

  // Meets the hub at t = 1 / steps exactly.
  [[nodiscard]] Ray towards_hub(const Point& start, float steps) const {
    const Point d = difference(hub, start);
    return ray_of(start, {steps * d[0], steps * d[1], steps * d[2]});
  }
};

}  // namespace

TEST_CASE("the closest hit equals rational arithmetic, ties going to the lowest index") {
  Source source(10);
  int met = 0;
  for (int scene = 0; scene < 20; ++scene) {
    Fan fan(source);
    for (int i = 0; i < 4; ++i) {
      const Point start = source.coarse_point();
      for (const float steps : {1.0F, 3.0F, -7.0F}) {
        Ray ray = fan.towards_hub(start, steps);
        ray.tmin = -2.0F;
        met += require_closest(ray, fan.triangles) ? 1 : 0;
      }
      require_closest(source.ray(), fan.triangles);
      std::rotate(fan.triangles.begin(), fan.triangles.begin() + 1, fan.triangles.end());
    }
  }
  REQUIRE(met == 240);
}

TEST_CASE("tmin and tmax are inclusive to the last bit, however t rounds") {
  Source source(11);
  for (int scene = 0; scene < 60; ++scene) {
    const Fan fan(source);
    Ray ray = fan.towards_hub(source.coarse_point(), 1.0F);
    const std::vector<Triangle> hub_only(fan.triangles.begin(), fan.triangles.begin() + 7);
    const float before = std::nextafter(1.0F, 0.0F);
    const float after = std::nextafter(1.0F, 2.0F);
    const auto is_hit = [&](float tmin, float tmax) {
      ray.tmin = tmin;
      ray.tmax = tmax;
      return require_closest(ray, hub_only) &&
             gnomon::oracle_closest(ray, hub_only).t == Approx(1.0).epsilon(1e-12);
    };
    CHECK(is_hit(1.0F, 1.0F));
    CHECK(is_hit(before, 1.0F));
    CHECK(is_hit(1.0F, kInf));
    CHECK_FALSE(is_hit(before, before));
    CHECK_FALSE(is_hit(after, after));
    CHECK_FALSE(is_hit(after, before));
  }
}

TEST_CASE("a range is infinite, empty or behind the origin as its ends say") {
  const std::vector<Triangle> wall{triangle_of({-9, -9, 2}, {9, -9, 2}, {0, 9, 2})};
  const auto t = [&](float z, float tmin, float tmax) {
    return gnomon::oracle_closest(ray_of({0, 0, z}, {0, 0, 1}, tmin, tmax), wall).t;
  };
  CHECK(t(0, 0, kInf) == 2.0);
  CHECK(t(0, -kInf, kInf) == 2.0);
  CHECK(t(2, 0, 0) == 0.0);
  CHECK(t(3, 0, kInf) == kInf);
  CHECK(t(3, -kInf, 0) == -1.0);
  CHECK(t(0, kInf, kInf) == kInf);
  CHECK(t(0, -kInf, -kInf) == kInf);
  CHECK(t(0, 3, 1) == kInf);
}

TEST_CASE("rays with NaN, infinite or zero parts and scenes without triangles give a miss") {
  const std::vector<Triangle> wall{triangle_of({-9, -9, 2}, {9, -9, 2}, {0, 9, 2})};
  const Ray good = ray_of({0, 0, 0}, {0, 0, 1});
  CHECK(gnomon::oracle_closest(good, wall).primitive == 0);
  CHECK(gnomon::oracle_closest(good, {}).primitive == GN_NONE);
  const auto misses = [&](const Ray& ray) {
    const OracleHit hit = gnomon::oracle_closest(ray, wall);
    return hit.primitive == GN_NONE && hit.t == kInf;
  };
  CHECK(misses(ray_of({0, 0, 0}, {0, 0, 0})));
  const auto length = [&](float z) {
    return gnomon::oracle_closest(ray_of({0, 0, 0}, {0, 1e-40F, z}), wall).t;
  };
  CHECK(misses(ray_of({0, 0, 0}, {0, 0, 0x1.fffffep-101F})));
  CHECK(misses(ray_of({0, 0, 0}, {0, 0, 0x1.000002p100F})));
  CHECK(length(0x1p-100F) == 0x1p101);
  CHECK(length(0x1p100F) == 0x1p-99);
  for (const float bad : {kNan, kInf, -kInf}) {
    for (int axis = 0; axis < 3; ++axis) {
      Ray ray = good;
      ray.origin[axis] = bad;
      CHECK(misses(ray));
      ray = good;
      ray.direction[axis] = bad;
      CHECK(misses(ray));
    }
  }
  CHECK(misses(ray_of({0, 0, 0}, {0, 0, 1}, kNan, kInf)));
  CHECK(misses(ray_of({0, 0, 0}, {0, 0, 1}, 0, kNan)));
}

namespace {

// A plane so little tilted that a ray along z at x meets it at t = 1 + slope * x * 2^-43, less than doubles
// resolve.
Triangle tilted(float slope, bool flipped) {
  const float far = 0x1p20F;
  const Point a{-far, -far, 1.0F - slope * 0x1p-23F};
  const Point b{far, -far, 1.0F + slope * 0x1p-23F};
  const Point c{0, far, 1};
  return flipped ? triangle_of(b, a, c) : triangle_of(a, b, c);
}

}  // namespace

TEST_CASE("hits that doubles cannot tell apart, or from tmin and tmax, are told apart") {
  for (const float x : {-0x1p-12F, 0x1p-12F}) {
    for (const bool first_flipped : {false, true}) {
      const std::vector<Triangle> one{tilted(1, first_flipped)};
      const auto hit = [&](float tmin, float tmax) {
        return gnomon::oracle_closest(ray_of({x, 0, 0}, {0, 0, 1}, tmin, tmax), one).primitive == 0;
      };
      CAPTURE(x, first_flipped);
      CHECK(gnomon::oracle_closest(ray_of({x, 0, 0}, {0, 0, 1}), one).t == 1.0);
      CHECK(hit(1, kInf) == (x > 0));
      CHECK(hit(0, 1) == (x < 0));
      for (const bool second_flipped : {false, true}) {
        const std::vector<Triangle> two{one[0], tilted(-1, second_flipped)};
        CHECK(gnomon::oracle_closest(ray_of({x, 0, 0}, {0, 0, 1}), two).primitive == (x < 0 ? 0U : 1U));
        CHECK(gnomon::oracle_closest(ray_of({x, 0, 2}, {0, 0, -1}), two).primitive == (x < 0 ? 1U : 0U));
      }
    }
  }
}

namespace {

// Requires that the filter keeps every triangle that the ray's line meets; returns how many it meets.
int require_all_kept(const Ray& ray, const std::vector<Triangle>& triangles) {
  std::vector<char> kept(triangles.size(), 0);
  const std::vector<LineFilter> filter{LineFilter(ray)};
  gnomon::visit_candidates(filter, triangles, [&](std::size_t, std::uint32_t i) { kept[i] = 1; });
  int met = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!gnomon::exact_intersect(ray, triangles[i]).inside) continue;
    CAPTURE(ray.origin, ray.direction, triangles[i].v0, triangles[i].v1, triangles[i].v2);
    REQUIRE(kept[i] == 1);
    ++met;
  }
  return met;
}

}  // namespace

TEST_CASE("the filter keeps every triangle that the ray meets, at any scale and distance") {
  Source source(12);
  for (const float scale : {0x1p-145F, 0x1p-61F, 0x1p-20F, 1.0F, 0x1p20F, 0x1p61F, 0x1p100F, 0x1.fp127F}) {
    for (const float offset : {0.0F, 1e5F}) {
      if (std::isinf(scale * offset)) continue;
      std::vector<Triangle> triangles;
      for (int i = 0; i < 700; ++i) triangles.push_back(source.triangle(scale, scale * offset));
      int met = 0;
      for (int i = 0; i < 40; ++i) met += require_all_kept(source.ray(scale, scale * offset), triangles);
      CAPTURE(scale, offset);
      REQUIRE(met > 40);
    }
  }
}

TEST_CASE("the filter keeps every triangle that the ray meets only at a corner or an edge") {
  Source source(13);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::array<Point, 3> p{source.lattice(100), source.lattice(100), source.lattice(100)};
    const Point d = source.lattice(50);
    const float t = static_cast<float>(source.integer(1, 20));
    const float share = source.integer(0, 1) == 0 ? 1.0F : 0.5F;  // a corner, or the middle of an edge
    Point start{};
    for (std::size_t k = 0; k < 3; ++k) start[k] = share * p[0][k] + (1.0F - share) * p[1][k] - t * d[k];
    met += require_all_kept(ray_of(start, d), {triangle_of(p[0], p[1], p[2])});
  }
  REQUIRE(met > 19000);
}

TEST_CASE("the filter drops almost all triangles that the ray does not meet") {
  Source source(14);
  for (const float offset : {0.0F, 1e5F}) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 5000; ++i) {
      const Point at = source.point(1.0F, offset);
      const std::array<Point, 2> by{source.point(0.02F), source.point(0.02F)};
      triangles.push_back(triangle_of(at, along(at, by[0], 1.0), along(at, by[1], 1.0)));
    }
    for (int i = 0; i < 20; ++i) {
      const std::vector<LineFilter> filter{LineFilter(source.ray(1.0F, offset))};
      int kept = 0;
      gnomon::visit_candidates(filter, triangles, [&](std::size_t, std::uint32_t) { ++kept; });
      REQUIRE(kept < 100);
    }
  }
}
