// kernels/shared/hit_math.h on the host: exact decisions, conservative boxes, scale invariance.
#include "gnomon/shared/hit_math.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/tree/oracle.h"
#include "support/thin_triangles.h"

using gnomon::test::Random;

namespace {

bool hits(const GnRay& ray, const GnTriangle& t, GnHit* out = nullptr) {
  const GnRayFrame frame = gn_ray_frame(&ray);
  GnHit hit{};
  const bool met = gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0;
  if (out != nullptr) *out = hit;
  return met;
}

double ulps(float value, double exact) {
  const auto rounded = static_cast<float>(exact);
  const double ulp = static_cast<double>(std::nextafter(std::fabs(rounded), INFINITY)) - std::fabs(rounded);
  return std::fabs(value - exact) / ulp;
}

// Compares with the oracle; returns the error of t in ulp, 0 for a miss.
double agrees_with_oracle(const GnRay& ray, const GnTriangle& t) {
  GnHit hit{};
  const bool met = hits(ray, t, &hit);
  const gnomon::ExactHit exact = gnomon::exact_intersect(ray, t);
  REQUIRE(met == exact.inside);
  return met ? ulps(hit.t, exact.t) : 0.0;
}

}  // namespace

TEST_CASE(
    "random rays and triangles: the float code decides as the exact oracle and t is right within an ulp") {
  Random random(11);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    CAPTURE(i);
    const GnRay ray = gnomon::test::random_ray(random, -1.0F, 1.0F);
    worst = std::max(
        worst, agrees_with_oracle(ray, gnomon::test::soup(1, static_cast<std::uint32_t>(i), 1.0F, -5.0F)[0]));
  }
  REQUIRE(worst <= 1.0);
}

TEST_CASE("rays aimed at corners and edge midpoints are decided as the exact oracle decides") {
  Random random(12);
  int met = 0;
  for (int i = 0; i < 60000; ++i) {
    CAPTURE(i);
    const float offset = i % 3 == 0 ? 0.0F : i % 3 == 1 ? 1.0e3F : 1.0e5F;
    const GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 0.01F, offset)[0];
    const float* a = gnomon::test::corner(t, random.below(3));
    const float* b = gnomon::test::corner(t, random.below(3));
    const float target[3] = {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
    const GnRay ray = gnomon::test::aimed(
        {offset + random.between(0, 10), offset + random.between(0, 10), offset + random.between(0, 10)},
        target);
    REQUIRE(agrees_with_oracle(ray, t) <= 1.0);
    met += hits(ray, t) ? 1 : 0;
  }
  REQUIRE(met > 1000);  // the aim is good enough for the test to say something
}

TEST_CASE("a ray through a shared edge or vertex of a fan hits at least one of its triangles") {
  Random random(13);
  for (int i = 0; i < 20000; ++i) {
    CAPTURE(i);
    const float offset = i % 2 == 0 ? 0.0F : 1.0e5F;
    constexpr int kSpokes = 7;
    std::array<std::array<float, 3>, kSpokes> rim{};
    for (int s = 0; s < kSpokes; ++s) {
      const double angle = 6.283185307179586 * s / kSpokes;
      rim[static_cast<std::size_t>(s)] = {
          offset + static_cast<float>(std::cos(angle)) + random.between(-0.1F, 0.1F),
          offset + static_cast<float>(std::sin(angle)) + random.between(-0.1F, 0.1F),
          offset + random.between(-0.3F, 0.3F)};
    }
    const std::array<float, 3> hub = {offset + random.between(-0.1F, 0.1F),
                                      offset + random.between(-0.1F, 0.1F), offset};
    const std::array<float, 3> origin = {offset + random.between(-0.3F, 0.3F),
                                         offset + random.between(-0.3F, 0.3F), offset + 5.0F};
    const GnRay ray = gnomon::test::aimed(origin, hub.data());
    int met = 0;
    for (std::size_t s = 0; s < kSpokes; ++s) {
      met += hits(ray, gnomon::test::triangle(hub, rim[s], rim[(s + 1) % kSpokes])) ? 1 : 0;
    }
    REQUIRE(met >= 1);
  }
}

TEST_CASE("a ray in the triangle's plane and a triangle without area are never hit") {
  const GnTriangle flat = gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  REQUIRE_FALSE(hits(gnomon::test::ray({-1, 0.25F, 0}, {1, 0, 0}), flat));
  REQUIRE_FALSE(hits(gnomon::test::ray({-1, 0, 0}, {1, 0, 0}), flat));
  const GnTriangle needle = gnomon::test::triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  REQUIRE_FALSE(hits(gnomon::test::ray({1, 1, -5}, {0, 0, 1}), needle));
  const GnTriangle point = gnomon::test::triangle({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  REQUIRE_FALSE(hits(gnomon::test::ray({1, 1, -5}, {0, 0, 1}), point));
}

TEST_CASE("both sides of a triangle give the same t and mirrored decisions") {
  Random random(14);
  for (int i = 0; i < 20000; ++i) {
    const GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 1.0F, -5.0F)[0];
    const GnTriangle turned = gnomon::test::triangle({t.v0[0], t.v0[1], t.v0[2]}, {t.v2[0], t.v2[1], t.v2[2]},
                                                     {t.v1[0], t.v1[1], t.v1[2]});
    const GnRay ray = gnomon::test::random_ray(random, -1.0F, 1.0F);
    GnHit a{};
    GnHit b{};
    CAPTURE(i);
    REQUIRE(hits(ray, t, &a) == hits(ray, turned, &b));
    REQUIRE(std::fabs(a.t - b.t) <= 1.2e-7F * std::fabs(a.t));
  }
}

TEST_CASE("scaling by powers of two scales t exactly and changes no decision") {
  Random random(15);
  for (int i = 0; i < 20000; ++i) {
    const GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 1.0F, -5.0F)[0];
    const GnRay ray = gnomon::test::random_ray(random, -1.0F, 1.0F);
    for (const int exponent : {-40, -10, 10, 40}) {
      CAPTURE(i, exponent);
      const float s = std::ldexp(1.0F, exponent);
      GnTriangle scaled = t;
      GnRay scaled_ray = ray;
      for (std::size_t k = 0; k < 3; ++k) {
        scaled.v0[k] *= s;
        scaled.v1[k] *= s;
        scaled.v2[k] *= s;
        scaled_ray.origin[k] *= s;
      }
      GnHit a{};
      GnHit b{};
      REQUIRE(hits(ray, t, &a) == hits(scaled_ray, scaled, &b));
      REQUIRE(b.t == a.t * s);
      REQUIRE(b.u == a.u);
    }
  }
}

TEST_CASE("the box test accepts every box that holds a point of the ray") {
  Random random(16);
  for (int i = 0; i < 300000; ++i) {
    CAPTURE(i);
    GnRay ray = gnomon::test::random_ray(random, -10.0F, 10.0F);
    for (std::size_t k = 0; k < 3; ++k) {
      if (random.below(6) == 0) ray.direction[k] = random.below(2) == 0 ? 0.0F : -0.0F;
      if (random.below(6) == 0) ray.direction[k] *= 1e-20F;
    }
    if (gn_ray_is_valid(&ray) == 0) continue;
    // The smallest box of floats certain to hold the ray's point at t.
    const double t = random.between(0.0F, 20.0F);
    float lo[3];
    float hi[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = static_cast<double>(ray.origin[k]) + t * static_cast<double>(ray.direction[k]);
      const bool still = ray.direction[k] == 0.0F;
      lo[k] = still ? ray.origin[k] : std::nextafter(static_cast<float>(x), -INFINITY);
      hi[k] = still ? ray.origin[k] : std::nextafter(static_cast<float>(x), INFINITY);
      if (random.below(2) == 0) (random.below(2) == 0 ? lo[k] -= 1.0F : hi[k] += 1.0F);
    }
    const GnRayFrame frame = gn_ray_frame(&ray);
    REQUIRE(gn_box_entry(&frame, lo, hi, 0.0F, gn_slab_limit(INFINITY)) < GN_INFINITY);
    REQUIRE(gn_box_entry(&frame, lo, hi, 0.0F, gn_slab_limit(static_cast<float>(t))) < GN_INFINITY);
  }
}

TEST_CASE("rays lying in a box's faces, with either zero, meet the box") {
  const float lo[3] = {0, 0, 0};
  const float hi[3] = {1, 1, 1};
  for (const float zero : {0.0F, -0.0F}) {
    for (const float y : {0.0F, 1.0F}) {
      for (const float z : {0.0F, 0.5F, 1.0F}) {
        for (const float direction : {1.0F, -1.0F}) {
          CAPTURE(zero, y, z, direction);
          const GnRay ray = gnomon::test::ray({direction > 0 ? -2.0F : 3.0F, y, z}, {direction, zero, zero});
          const GnRayFrame frame = gn_ray_frame(&ray);
          REQUIRE(gn_box_entry(&frame, lo, hi, 0.0F, gn_slab_limit(INFINITY)) == 2.0F);
        }
      }
    }
  }
}

TEST_CASE("boxes beside, behind and beyond the range are rejected") {
  const float lo[3] = {0, 0, 0};
  const float hi[3] = {1, 1, 1};
  const auto entry = [&](const GnRay& ray) {
    const GnRayFrame frame = gn_ray_frame(&ray);
    return gn_box_entry(&frame, lo, hi, ray.tmin, gn_slab_limit(ray.tmax));
  };
  REQUIRE(entry(gnomon::test::ray({-2, 1.5F, 0.5F}, {1, 0, 0})) == INFINITY);
  REQUIRE(entry(gnomon::test::ray({-2, 0.5F, 0.5F}, {-1, 0, 0})) == INFINITY);
  REQUIRE(entry(gnomon::test::ray({-2, 0.5F, 0.5F}, {1, 0, 0}, 0.0F, 1.9F)) == INFINITY);
  REQUIRE(entry(gnomon::test::ray({-2, 0.5F, 0.5F}, {1, 0, 0}, 3.1F)) == INFINITY);
}

// A triangle for gn_met_at: random, thin, grazing, far from the origin, tiny or huge, in turn.
GnTriangle triangle_to_meet(int i, Random& random) {
  const float offset = i % 5 == 3 ? 1.0e4F : 0.0F;
  GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), i % 7 == 0 ? 0.05F : 2.0F, -5.0F)[0];
  for (std::size_t k = 0; k < 3; ++k) {
    if (i % 5 == 1) t.v2[k] = t.v1[k] + 1e-3F * (t.v2[k] - t.v1[k]);  // thin
    for (float* v : {t.v0, t.v1, t.v2}) v[k] += offset;
  }
  if (i % 5 == 4) {  // almost a line seen from the target's side
    const float along = random.between(20.0F, 200.0F);
    t.v1[0] += along;
    t.v2[0] += 2.0F * along;
  }
  return t;
}

// A ray to a point inside the triangle, from near or far.
GnRay ray_to_meet(const GnTriangle& t, int i, Random& random) {
  const float a = random.between(0.05F, 0.9F);
  const float b = random.between(0.05F, 0.95F - a);
  const float away = i % 3 == 0 ? 2.0F : i % 3 == 1 ? 30.0F : 2000.0F;
  float target[3];
  std::array<float, 3> origin{};
  for (std::size_t k = 0; k < 3; ++k) {
    target[k] = a * t.v0[k] + b * t.v1[k] + (1.0F - a - b) * t.v2[k];
    origin[k] = target[k] + random.between(-away, away);
    if (i % 5 == 2) origin[k] += 1.0F * (t.v1[k] - t.v0[k]) * random.between(5, 50);  // grazing
  }
  GnRay ray = gnomon::test::aimed(origin, target);
  const float stretch = std::ldexp(1.0F, static_cast<int>(random.below(41)) - 20);
  for (float& x : ray.direction) x *= stretch;
  return ray;
}

TEST_CASE("where floats meet a triangle that is met for certain is as far off as they say, at most") {
  Random random(17);
  std::uint64_t certain = 0;
  double widest = 0.0;
  for (int i = 0; i < 1'500'000; ++i) {
    const GnTriangle t = triangle_to_meet(i, random);
    const GnRay ray = ray_to_meet(t, i, random);
    const GnRayFrame frame = gn_ray_frame(&ray);
    const GnEdges e = gn_triangle_edges(&frame, t.v0, t.v1, t.v2);
    if (gn_edges_verdict(&e) != 1) continue;
    certain += 1;
    float error = 0.0F;
    const float at =
        gn_met_at(e.az, e.bz, e.cz, e.u, e.v, e.w, e.bound, e.z, frame.inverse[frame.kz], &error);
    const gnomon::ExactHit exact = gnomon::exact_intersect(ray, t);
    const bool holds = exact.inside && static_cast<double>(at - error) <= exact.t - exact.t_error &&
                       exact.t + exact.t_error <= static_cast<double>(at + error);
    if (!holds) {
      CAPTURE(i, at, error, exact.inside, exact.t, exact.t_error);
      REQUIRE(holds);
    }
    widest = std::max(widest, std::fabs(at - exact.t) / static_cast<double>(error));
  }
  CAPTURE(widest);
  REQUIRE(certain >= 1'000'000);
  REQUIRE(widest > 0.01);  // the bound is within reach: a hundredth of it would be seen to fail
}

// Needles, rays that start in a triangle's plane or a last bit off it, and others, up to 1e6 from the origin.
TEST_CASE(
    "t is within 9/16 ulp of the exact one, however thin the triangle and however near the ray starts") {
  gnomon::test::Random random(301);
  int met = 0;
  double worst = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const auto [t, r] = gnomon::test::thin_case(random, i);
    const GnRayFrame frame = gn_ray_frame(&r);
    GnHit hit{};
    const gnomon::ExactHit exact = gnomon::exact_intersect(r, t);
    REQUIRE((gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0) == exact.inside);
    if (!exact.inside) continue;
    ++met;
    const double ulp = gnomon::test::ulp_at(exact.t);
    worst = std::max(worst, std::fabs(static_cast<double>(hit.t) - exact.t) / ulp);
  }
  REQUIRE(met > 20'000);
  REQUIRE(worst > 0.49);
  REQUIRE(worst <= 0.5625);
}

TEST_CASE("rays with NaN, infinite origins, no direction or one too short or too long are not valid") {
  const float nan = std::nanf("");
  REQUIRE(gn_ray_is_valid(std::data({gnomon::test::ray({0, 0, 0}, {0, 0, 1})})) != 0);
  for (const GnRay& bad :
       {gnomon::test::ray({nan, 0, 0}, {0, 0, 1}), gnomon::test::ray({0, INFINITY, 0}, {0, 0, 1}),
        gnomon::test::ray({0, 0, 0}, {0, nan, 1}), gnomon::test::ray({0, 0, 0}, {0, 0, 0}),
        gnomon::test::ray({0, 0, 0}, {0, -0.0F, 0}), gnomon::test::ray({0, 0, 0}, {INFINITY, 0, 1}),
        gnomon::test::ray({0, 0, 0}, {0, 0, 1}, nan), gnomon::test::ray({0, 0, 0}, {0, 0, 1}, 0, nan),
        gnomon::test::ray({0, 0, 0}, {1e-40F, 0, -1e-39F}),
        gnomon::test::ray({0, 0, 0}, {0, -0x1.fffffep-101F, 0}),
        gnomon::test::ray({0, 0, 0}, {0x1.000002p100F, 1, 1})}) {
    REQUIRE(gn_ray_is_valid(&bad) == 0);
  }
  for (const float length : {0x1p-100F, 0x1p100F}) {
    for (const float other : {0.0F, 1e-45F, -length}) {
      const GnRay good = gnomon::test::ray({0, 0, 0}, {other, length, other});
      REQUIRE(gn_ray_is_valid(&good) != 0);
    }
  }
}

// What a device makes of denormals: it may flush them, and 1 / 0 is infinite.
TEST_CASE("a denormal component of a direction loses no box") {
  for (const float component : {1e-45F, 1e-39F, 1.1e-38F}) {
    for (const float sense : {1.0F, -1.0F}) {
      const GnRay r = gnomon::test::ray({0, 0, 0}, {sense * component, 1, 0});
      const GnRayFrame frame = gn_ray_frame(&r);
      CAPTURE(component, sense);
      // Reached at t = 1e30: x from 1e30 * component on.
      const float near_x = sense * 1e30F * component * 0.5F;
      const float lo[3] = {gn_min(near_x, 4 * near_x), 0.99e30F, -1};
      const float hi[3] = {gn_max(near_x, 4 * near_x), 1.01e30F, 1};
      REQUIRE(gn_box_entry(&frame, lo, hi, 0.0F, gn_slab_limit(GN_FLOAT_MAX)) <= 1e30F);
    }
  }
}
