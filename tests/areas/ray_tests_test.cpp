// Rays against boxes, planes and triangles.
#include "gnomon/areas/ray_tests.h"

#include <array>
#include <catch2/catch.hpp>

#include "area_test_tools.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Vec3d at(const Ray3d& ray, double t) {
  return ray.origin + t * ray.direction;
}

Box3d grown(const Box3d& box, double by) {
  const Vec3d d{by, by, by};
  return {box.lo - d, box.hi + d};
}

}  // namespace

TEST_CASE("between entry and exit a ray is in the box, and nowhere else") {
  Source source(1);
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const Box3d box = source.box(-2.0, 2.0);
    const Vec3d origin = source.point(-4.0, 4.0);
    const Vec3d aim =
        i % 2 == 0 ? source.direction() : 0.5 * (box.lo + box.hi) + source.point(-0.5, 0.5) - origin;
    const Ray3d ray{origin, std::exp2(source.between(-8.0, 8.0)) * aim};
    const auto inside = intersect(ray, box);
    CAPTURE(i, box.lo, box.hi, ray.origin, ray.direction);
    const double step = 1.0 / length(ray.direction);
    if (inside) {
      ++met;
      REQUIRE(inside->entry <= inside->exit);
      REQUIRE(inside->exit >= 0.0);
      if (inside->entry < 0.0) REQUIRE(contains(grown(box, 1e-12), ray.origin));
      REQUIRE(contains(grown(box, 1e-12), at(ray, 0.5 * (inside->entry + inside->exit))));
      REQUIRE(contains(grown(box, 1e-12), at(ray, inside->entry)));
      REQUIRE(contains(grown(box, 1e-12), at(ray, inside->exit)));
      REQUIRE_FALSE(contains(grown(box, -1e-9), at(ray, inside->entry - 1e-6 * step)));
      REQUIRE_FALSE(contains(grown(box, -1e-9), at(ray, inside->exit + 1e-6 * step)));
    } else {
      for (int k = 0; k <= 200; ++k) REQUIRE_FALSE(contains(grown(box, -1e-9), at(ray, 0.07 * k * step)));
    }
  }
  REQUIRE(met > 2000);
}

TEST_CASE("a ray that runs in a face meets the box, whichever zero its direction has") {
  const Box3d box{{-1.0, -2.0, -3.0}, {1.5, 2.5, 3.5}};
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool at_hi : {false, true}) {
      for (const double zero : {0.0, -0.0}) {
        for (const double way : {1.0, -1.0}) {
          Ray3d ray{{0.25, 0.25, 0.25}, {zero, zero, zero}};
          ray.direction[(axis + 1) % 3] = way;
          ray.origin[axis] = at_hi ? box.hi[axis] : box.lo[axis];
          ray.origin[(axis + 1) % 3] = -10.0 * way;
          CAPTURE(axis, at_hi, zero, way);
          REQUIRE(intersect(ray, box).has_value());
          ray.origin[axis] = std::nextafter(ray.origin[axis], at_hi ? 100.0 : -100.0);
          REQUIRE_FALSE(intersect(ray, box).has_value());
        }
      }
    }
  }
}

TEST_CASE("flat boxes are met at their plane, points in one place and empty boxes never") {
  for (unsigned axis = 0; axis < 3; ++axis) {
    Box3d flat{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
    flat.lo[axis] = flat.hi[axis] = 0.375;
    for (const double way : {1.0, -1.0}) {
      Ray3d ray{{0.1, 0.2, 0.3}, {0.0, 0.0, 0.0}};
      ray.origin[axis] = -2.0 * way;
      ray.direction[axis] = 0.5 * way;
      CAPTURE(axis, way);
      const auto inside = intersect(ray, flat);
      REQUIRE(inside.has_value());
      REQUIRE(inside->entry == inside->exit);
      REQUIRE(inside->entry == (0.375 + 2.0 * way) * way / 0.5);
      REQUIRE_FALSE(intersect({ray.origin, -ray.direction}, flat).has_value());
      REQUIRE_FALSE(intersect(ray, Box3d{}).has_value());
      REQUIRE_FALSE(intersect(ray, Box3d{flat.hi + Vec3d{1, 1, 1}, flat.lo}).has_value());
    }
  }
  const Box3d point{{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}};
  REQUIRE(intersect({{0, 0, 0}, {1, 2, 3}}, point)->entry == 1.0);
  REQUIRE_FALSE(intersect({{0, 0, 0}, {1, 2, 3.001}}, point).has_value());
}

TEST_CASE("boxes overlap when they share a point") {
  const Box3d a{{0, 0, 0}, {1, 2, 3}};
  for (unsigned axis = 0; axis < 3; ++axis) {
    Box3d b = a;
    b.lo[axis] = a.hi[axis];
    b.hi[axis] = a.hi[axis] + 1.0;
    CAPTURE(axis);
    REQUIRE((overlap(a, b) && overlap(b, a)));
    b.lo[axis] = std::nextafter(a.hi[axis], 10.0);
    REQUIRE_FALSE((overlap(a, b) || overlap(b, a)));
  }
  REQUIRE_FALSE(overlap(a, Box3d{}));
  REQUIRE(contains(a, {1, 2, 3}));
  REQUIRE_FALSE(contains(a, {1, 2, 3.0000001}));
}

TEST_CASE("a ray meets a plane where the plane is, at any scale and on both sides of the start") {
  Source source(2);
  for (int i = 0; i < 5000; ++i) {
    const double scale = std::exp2(source.between(-30.0, 30.0));
    const Vec3d on_plane = source.point(-scale, scale);
    const Plane plane = plane_through(on_plane, std::exp2(source.between(-20.0, 20.0)) * source.direction());
    const Ray3d ray{source.point(-scale, scale), source.direction()};
    CAPTURE(i, plane.normal, plane.offset, ray.origin, ray.direction);
    const auto t = intersect(ray, plane);
    REQUIRE(t.has_value());
    const double size = (scale + std::abs(*t)) * length(plane.normal);
    REQUIRE(std::abs(signed_distance(plane, at(ray, *t))) <= 1e-14 * size);
    const double start_side = dot(plane.normal, ray.origin - on_plane);
    const bool away = start_side * dot(plane.normal, ray.direction) > 0.0;
    if (std::abs(start_side) > 1e-12 * size) REQUIRE(away == (*t < 0.0));
  }
  REQUIRE(*intersect({{0, 0, 0}, {0, 0, 2}}, plane_through({5, 5, 3}, {0, 0, 7})) == 1.5);
}

TEST_CASE("only a ray along the plane is parallel to it: the tolerance is relative") {
  const Plane floor = plane_through({0, 0, 0}, {0, 1, 0});
  REQUIRE_FALSE(intersect({{0, 1, 0}, {1, 0, 0.5}}, floor).has_value());
  REQUIRE(*intersect({{0, 1, 0}, {1, -1e-9, 0}}, floor) == Approx(1e9));
  REQUIRE(*intersect({{0, 1, 0}, {0, -1e-200, 0}}, floor) == Approx(1e200));
  // (1, 2, -3) is at right angles to (1, 1, 1) times anything.
  for (const double scale : {1e-100, 0.1, 1.0 / 3.0, 1e100}) {
    CAPTURE(scale);
    REQUIRE_FALSE(intersect({{0, 1, 0}, scale * Vec3d{1, 2, -3}}, plane_through({5, 0, 0}, {1, 1, 1})));
  }
}

TEST_CASE("a ray aimed into a triangle meets it there, one aimed past it does not") {
  Source source(3);
  int past = 0;
  for (int i = 0; i < 10000; ++i) {
    const double offset = i % 2 == 0 ? 0.0 : 1e5;
    const Vec3d shift{offset, -offset, offset};
    const Vec3d a = shift + source.point(-1.0, 1.0);
    const Vec3d b = shift + source.point(-1.0, 1.0);
    const Vec3d c = shift + source.point(-1.0, 1.0);
    const double u = source.between(-0.5, 1.5);
    const double v = source.between(-0.5, 1.5);
    const Vec3d target = a + u * (b - a) + v * (c - a);
    const Ray3d ray{shift + source.point(-3.0, 3.0), {}};
    const Ray3d aimed{ray.origin, 0.25 * (target - ray.origin)};
    const double margin = std::min(std::min(u, v), 1.0 - u - v);
    if (std::abs(margin) < 1e-6) continue;
    const Vec3d normal = cross(b - a, c - a);
    if (std::abs(dot(unit_of(normal), unit_of(aimed.direction))) < 1e-3 || length(normal) < 1e-2) continue;
    CAPTURE(i, a, b, c, u, v, ray.origin);
    const auto t = intersect(aimed, a, b, c);
    REQUIRE(t.has_value() == (margin > 0.0));
    if (t) REQUIRE(*t == Approx(4.0).epsilon(1e-6));
    REQUIRE_FALSE(intersect({aimed.origin, -aimed.direction}, a, b, c).has_value());
    past += margin < 0.0 ? 1 : 0;
  }
  REQUIRE(past > 3000);
}

TEST_CASE("no ray slips between two triangles of a common edge, or misses a corner") {
  Source source(4);
  for (int i = 0; i < 20000; ++i) {
    const Vec3d a = source.point(-1.0, 1.0);
    const Vec3d b = source.point(-1.0, 1.0);
    const Vec3d c = source.point(-1.0, 1.0);
    const Vec3d d = source.point(-1.0, 1.0);
    const double s = i % 10 == 0 ? 0.0 : source.between(0.0, 1.0);
    const Vec3d origin = source.point(-3.0, 3.0);
    const Ray3d ray{origin, a + s * (b - a) - origin};
    // Both on the edge's two sides as the ray sees it, so the edge is no outline.
    const Vec3d edge_normal = cross(b - a, ray.direction);
    if (!(dot(edge_normal, c - a) * dot(edge_normal, d - a) < -1e-6)) continue;
    CAPTURE(i, a, b, c, d, origin, s);
    REQUIRE((intersect(ray, a, b, c).has_value() || intersect(ray, b, a, d).has_value()));
  }
  REQUIRE_FALSE(intersect({{0, 0, -1}, {0, 0, 1}}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}).has_value());
  REQUIRE_FALSE(intersect({{0, 0, -1}, {0, 0, 1}}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}).has_value());
}
