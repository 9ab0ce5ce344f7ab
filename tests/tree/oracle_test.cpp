// Edge signs and intersections against rational arithmetic: signs must be equal, distances within the
// promised error.
#include <catch2/catch.hpp>
#include <cfloat>

#include "gnomon/tree/oracle.h"
#include "rational.h"

using gnomon::ExactHit;
using gnomon::Ray;
using gnomon::Triangle;
using namespace rational;

namespace {

int sign_of(const Edge& e) {
  return gnomon::exact_edge_sign(e.d.data(), e.o.data(), e.a.data(), e.b.data());
}

void require_sign(const Edge& e) {
  CAPTURE(e.d, e.o, e.a, e.b);
  REQUIRE(sign_of(e) == rational_sign(e));
}

// Compares with the rationals; returns whether the line meets the triangle.
bool require_intersection(const Ray& ray, const Triangle& triangle) {
  CAPTURE(ray.origin, ray.direction, triangle.v0, triangle.v1, triangle.v2);
  const std::optional<RationalHit> expected = rational_intersect(ray, triangle);
  const ExactHit hit = gnomon::exact_intersect(ray, triangle);
  REQUIRE(hit.inside == expected.has_value());
  if (!expected) return false;
  REQUIRE(abs(Rational(hit.t) - expected->t) <= Rational(hit.t_error));
  REQUIRE(hit.t_error <= 1e-9 * std::fabs(hit.t));
  REQUIRE(abs(Rational(hit.u) - expected->u) <= Rational(1e-11));
  REQUIRE(abs(Rational(hit.v) - expected->v) <= Rational(1e-11));
  REQUIRE((expected->u == 0 ? hit.u == 0.0 : hit.u >= 0.0));
  REQUIRE((expected->v == 0 ? hit.v == 0.0 : hit.v >= 0.0));
  return true;
}

}  // namespace

TEST_CASE("edge signs equal rational arithmetic for random points") {
  Source source(1);
  for (int i = 0; i < 6000; ++i) {
    require_sign({source.point(), source.point(), source.point(), source.point()});
  }
}

TEST_CASE(
    "edge signs equal rational arithmetic for any finite bits, denormals and the largest floats included") {
  Source source(2);
  const auto point = [&] { return Point{source.any_finite(), source.any_finite(), source.any_finite()}; };
  for (int i = 0; i < 4000; ++i) require_sign({point(), point(), point(), point()});
  const float extremes[] = {0.0F, -0.0F, 0x1p-149F, -0x1p-149F, 0x1p-126F, 1.0F, FLT_MAX, -FLT_MAX};
  const auto extreme = [&] { return extremes[source.integer(0, 7)]; };
  const auto corner = [&] { return Point{extreme(), extreme(), extreme()}; };
  for (int i = 0; i < 4000; ++i) require_sign({corner(), corner(), corner(), corner()});
}

TEST_CASE("edge signs equal rational arithmetic when scales of 2^-100 to 2^100 mix") {
  Source source(3);
  const float scales[] = {0x1p-100F, 0x1p-40F, 1.0F, 0x1p40F, 0x1p100F};
  const auto coordinate = [&] { return source.unit() * scales[source.integer(0, 4)]; };
  const auto point = [&] { return Point{coordinate(), coordinate(), coordinate()}; };
  for (int i = 0; i < 4000; ++i) require_sign({point(), point(), point(), point()});
}

TEST_CASE("edge signs equal rational arithmetic one ulp from the ray, near the origin and 1e5 away") {
  Source source(4);
  for (const float offset : {0.0F, 1e5F}) {
    for (int i = 0; i < 4000; ++i) {
      const Point d = source.point();
      const Point o = source.point(1.0F, offset);
      const double far_a = source.integer(1, 1000) * 0.01;
      const double far_b = source.integer(1, 1000) * 0.01;
      const Point a = nudged(along(o, d, far_a), source);
      const Point b = nudged(along(o, d, far_b), source);
      require_sign({d, o, a, b});
      const Point c = along(a, difference(a, o), source.unit());
      require_sign({d, o, a, nudged(c, source)});
    }
  }
}

TEST_CASE("edge signs are zero exactly where the ray meets the edge's line") {
  Source source(5);
  int zeros = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point d = source.lattice(9);
    const Point o = source.lattice(1000);
    const Point a = source.lattice(1000);
    const int p = source.integer(-99, 99);
    const int q = source.integer(-9, 9);
    Point b{};
    for (std::size_t k = 0; k < 3; ++k)
      b[k] = o[k] + static_cast<float>(p) * d[k] + static_cast<float>(q) * (a[k] - o[k]);
    REQUIRE(sign_of({d, o, a, b}) == 0);
    require_sign({d, o, a, nudged(b, source)});
    const auto third = [](const Point& x) { return Point{x[0] / 3.0F, x[1] / 3.0F, x[2] / 3.0F}; };
    const Edge thirds{third(d), third(o), third(a), third(b)};
    require_sign(thirds);
    zeros += rational_sign(thirds) == 0 ? 1 : 0;
  }
  REQUIRE(zeros < 4000);  // thirds are rounded: both answers occur
}

TEST_CASE("two triangles on an edge see opposite signs of it") {
  Source source(6);
  for (int i = 0; i < 4000; ++i) {
    const Point d = source.point();
    const Point o = source.point();
    const Point a = nudged(along(o, d, 0.7), source);
    const Point b = along(o, d, 1.9);
    CAPTURE(d, o, a, b);
    REQUIRE(sign_of({d, o, a, b}) == -sign_of({d, o, b, a}));
  }
}

TEST_CASE("intersections equal rational arithmetic for random triangles of all scales") {
  Source source(7);
  for (const float scale : {0x1p-100F, 0x1p-40F, 1.0F, 0x1p40F, 0x1p100F}) {
    int met = 0;
    for (int i = 0; i < 600; ++i) {
      const Ray ray = source.ray(scale);
      const Triangle triangle = source.triangle(scale);
      met += require_intersection(ray, triangle) ? 1 : 0;
    }
    REQUIRE(met > 10);
  }
}

TEST_CASE(
    "intersections equal rational arithmetic for slivers and grazing rays, near the origin and 1e5 away") {
  Source source(8);
  for (const float offset : {0.0F, 1e5F}) {
    int met = 0;
    for (int i = 0; i < 1500; ++i) {
      const Point a = source.point(1.0F, offset);
      const Point b = source.point(1.0F, offset);
      const Point between = along(a, difference(b, a), source.unit());
      const Point sliver = nudged(between, source);
      const Point o = source.point(1.0F, offset);
      const Point target = along(a, difference(b, a), 0.5 + 0.5 * source.unit());
      met += require_intersection(ray_of(o, difference(target, o)), triangle_of(a, b, sliver)) ? 1 : 0;
      const Point c = source.point(1.0F, offset);  // a ray in the triangle's plane but for one ulp
      const Point start = nudged(along(target, difference(c, b), 3.0), source);
      met += require_intersection(ray_of(start, difference(target, start)), triangle_of(a, b, c)) ? 1 : 0;
    }
    REQUIRE(met > 10);
  }
}

TEST_CASE("a ray that starts within a sliver meets it at zero, with u and v as exact as elsewhere") {
  Source source(15);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<Point, 2> ends{source.point(), source.point()};
    ends[0][2] = ends[1][2] = 0.0F;  // all in the plane z = 0
    const std::array<double, 2> places{0.5 + 0.5 * source.unit(), 0.5 + 0.5 * source.unit()};
    const Point start = along(ends[0], difference(ends[1], ends[0]), places[0]);
    Point third = along(ends[0], difference(ends[1], ends[0]), places[1]);
    third[0] = std::nextafter(third[0], source.unit() > 0.0F ? kInf : -kInf);
    const Ray ray = ray_of(start, source.point());
    const Triangle sliver = triangle_of(ends[0], ends[1], third);
    if (!require_intersection(ray, sliver)) continue;
    REQUIRE(gnomon::exact_intersect(ray, sliver).t == 0.0);
    ++met;
  }
  REQUIRE(met > 500);
}

TEST_CASE("a ray through a corner or an edge meets the triangle") {
  Source source(9);
  int met = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::array<Point, 3> p{source.lattice(50), source.lattice(50), source.lattice(50)};
    const Triangle triangle = triangle_of(p[0], p[1], p[2]);
    const Point d = source.lattice(9);
    const float* const corner = source.unit() > 0.0F ? triangle.v1 : triangle.v2;
    const float t = static_cast<float>(source.integer(-20, 20));
    const Point edge{triangle.v0[0] + corner[0], triangle.v0[1] + corner[1], triangle.v0[2] + corner[2]};
    const Ray to_corner = ray_of({corner[0] - t * d[0], corner[1] - t * d[1], corner[2] - t * d[2]}, d);
    const Ray to_edge = ray_of({edge[0] / 2 - t * d[0], edge[1] / 2 - t * d[1], edge[2] / 2 - t * d[2]}, d);
    for (const Ray& ray : {to_corner, to_edge}) {
      const bool hit = require_intersection(ray, triangle);
      if (hit) REQUIRE(gnomon::exact_intersect(ray, triangle).t == Approx(t).margin(1e-12));
      met += hit ? 1 : 0;
    }
  }
  REQUIRE(met > 2900);  // all but lines in the plane and triangles without area
}

TEST_CASE("u and v are exactly zero where the ray meets the opposite edge, however the doubles round") {
  Source source(16);
  for (int i = 0; i < 1500; ++i) {
    const std::array<Point, 3> p{source.coarse_point(), source.coarse_point(), source.coarse_point()};
    const Triangle triangle = triangle_of(p[0], p[1], p[2]);
    const Point start = source.coarse_point();
    const Point d = difference(p[static_cast<std::size_t>(source.integer(0, 2))], start);
    require_intersection(ray_of(start, {3 * d[0], 3 * d[1], 3 * d[2]}), triangle);
  }
}

TEST_CASE("a line in the triangle's plane and a triangle without area are never met") {
  const Triangle flat = triangle_of({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const Triangle segment = triangle_of({0, 0, 0}, {1, 1, 0}, {3, 3, 0});
  const Triangle point = triangle_of({1, 1, 0}, {1, 1, 0}, {1, 1, 0});
  CHECK_FALSE(gnomon::exact_intersect(ray_of({-1, 1, 0}, {1, 0, 0}), flat).inside);
  CHECK_FALSE(gnomon::exact_intersect(ray_of({-1, 0, 0}, {1, 0, 0}), flat).inside);
  CHECK_FALSE(gnomon::exact_intersect(ray_of({1, 1, -1}, {0, 0, 1}), segment).inside);
  CHECK_FALSE(gnomon::exact_intersect(ray_of({1, 1, -1}, {0, 0, 1}), point).inside);
  CHECK(gnomon::exact_intersect(ray_of({1, 1, -1}, {0, 0, 1}), flat).inside);
}

TEST_CASE("coordinates that are not finite are never met") {
  const Ray ray = ray_of({1, 1, -1}, {0.125F, -0.25F, 1});
  const Triangle triangle = triangle_of({0, 0, 0}, {4, 0, 1}, {0, 4, 2});
  const Triangle back = triangle_of({0, 0, 0}, {0, 4, 2}, {4, 0, 1});
  REQUIRE(gnomon::exact_intersect(ray, triangle).inside);
  REQUIRE(gnomon::exact_intersect(ray, back).inside);
  for (const float bad : {kInf, -kInf, kNan}) {
    for (int axis = 0; axis < 3; ++axis) {
      CAPTURE(bad, axis);
      std::array<Triangle, 4> poisoned{triangle, triangle, triangle, back};
      poisoned[3].v0[axis] = bad;
      poisoned[0].v0[axis] = bad;
      poisoned[1].v1[axis] = bad;
      poisoned[2].v2[axis] = bad;
      for (const Triangle& sick : poisoned) CHECK_FALSE(gnomon::exact_intersect(ray, sick).inside);
      std::array<Ray, 2> lost{ray, ray};
      lost[0].origin[axis] = bad;
      lost[1].direction[axis] = bad;
      for (const Ray& sick : lost) CHECK_FALSE(gnomon::exact_intersect(sick, triangle).inside);
    }
  }
}
