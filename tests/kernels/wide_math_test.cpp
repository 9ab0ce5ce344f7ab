// The arithmetic of devices without double (pairs of floats), compiled for the host: it must decide and
// measure as double does. A program of its own, because GN_WITHOUT_FP64 changes what the shared headers
// define.
#define GN_WITHOUT_FP64
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/pair_bound.h"
#include "support/thin_triangles.h"

using gnomon::test::Random;

namespace {

// The decision is the oracle's, and t right within an ulp. 1: a hit.
int require_as_exact(const GnRay& ray, const GnTriangle& t) {
  const GnRayFrame frame = gn_ray_frame(&ray);
  GnHit hit{};
  const gnomon::ExactHit exact = gnomon::exact_intersect(ray, t);
  REQUIRE((gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0) == exact.inside);
  if (!exact.inside) return 0;
  REQUIRE(std::fabs(hit.t - exact.t) <= 1.2e-7 * std::fabs(exact.t));
  return 1;
}

}  // namespace

TEST_CASE("a pair's product and sum carry what one float drops") {
  Random random(21);
  for (int i = 0; i < 100000; ++i) {
    const float a = random.between(-1000.0F, 1000.0F);
    const float b = random.between(-1.0F, 1.0F);
    const GnWide product = gn_two_product(a, b);
    const GnWide sum = gn_two_sum(a, b);
    CAPTURE(a, b);
    REQUIRE(static_cast<double>(product.high) + product.low == static_cast<double>(a) * b);
    REQUIRE(static_cast<double>(sum.high) + sum.low == static_cast<double>(a) + b);
  }
}

TEST_CASE(
    "without double, random rays are decided as the exact oracle decides and t is right within an ulp") {
  Random random(22);
  int met = 0;
  for (int i = 0; i < 200000; ++i) {
    CAPTURE(i);
    const GnRay ray = gnomon::test::random_ray(random, -1.0F, 1.0F);
    const GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 4.0F, -5.0F)[0];
    met += require_as_exact(ray, t);
  }
  REQUIRE(met > 1000);
}

TEST_CASE("without double, no ray aimed at a corner is lost that the oracle says hits") {
  Random random(23);
  int met = 0;
  for (int i = 0; i < 50000; ++i) {
    CAPTURE(i);
    const GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 0.01F, 1000.0F)[0];
    const GnRay ray =
        gnomon::test::aimed({random.between(0, 10), random.between(0, 10), random.between(0, 10)},
                            gnomon::test::corner(t, random.below(3)));
    if (!gnomon::exact_intersect(ray, t).inside) continue;
    const GnRayFrame frame = gn_ray_frame(&ray);
    GnHit hit{};
    REQUIRE(gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0);
    met += 1;
  }
  REQUIRE(met > 1000);
}

TEST_CASE(
    "without double, sizes and directions from tiny to huge change neither decision nor t's precision") {
  Random random(24);
  int met = 0;
  for (const int size : {-44, -20, 0, 20, 44}) {
    for (const int length : {-60, 0, 60}) {
      for (int i = 0; i < 3000; ++i) {
        CAPTURE(size, length, i);
        GnRay ray = gnomon::test::random_ray(random, -1.0F, 1.0F);
        GnTriangle t = gnomon::test::soup(1, static_cast<std::uint32_t>(i), 4.0F, -5.0F)[0];
        for (std::size_t k = 0; k < 3; ++k) {
          ray.origin[k] = std::ldexp(ray.origin[k], size);
          ray.direction[k] = std::ldexp(ray.direction[k], length);
          for (float* v : {t.v0, t.v1, t.v2}) v[k] = std::ldexp(v[k], size);
        }
        met += require_as_exact(ray, t);
      }
    }
  }
  REQUIRE(met > 1000);
}

// As for double (hit_math_test): needles, starts in or next to the plane, far from the origin.
TEST_CASE("without double, t is within the derived bound of the exact one, for any triangle that is met") {
  Random random(301);
  int met = 0;
  double worst = 0.0;
  double most_ulp = 0.0;
  for (int i = 0; i < 300'000; ++i) {
    const auto [t, ray] = gnomon::test::thin_case(random, i);
    const gnomon::ExactHit exact = gnomon::exact_intersect(ray, t);
    if (!exact.inside) continue;
    const GnRayFrame frame = gn_ray_frame(&ray);
    GnHit hit{};
    CAPTURE(i, exact.t);
    REQUIRE(gn_triangle_hit(&frame, t.v0, t.v1, t.v2, &hit) != 0);
    const double ulp = gnomon::test::ulp_at(exact.t);
    const double error = std::fabs(static_cast<double>(hit.t) - exact.t) - exact.t_error;
    const double bound = 0.51 * ulp + gnomon::pair_error_bound(ray, t);
    CAPTURE(hit.t, error, bound);
    REQUIRE(error <= bound);
    worst = std::max(worst, error / bound);
    most_ulp = std::max(most_ulp, error / ulp);
    ++met;
  }
  REQUIRE(met > 20'000);
  REQUIRE(worst > 0.5);
  REQUIRE(most_ulp > 100.0);  // a bound in ulp alone would not hold
}
