// Solid angles of triangles, polygons and boxes.
#include "gnomon/areas/solid_angle.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/ray_tests.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// Of the rectangle [u0, u1] x [v0, v1] at distance d: four signed corner terms, the textbook form that
// cancels for far and small ones and so is not what the library does.
double rectangle_by_corners(double u0, double u1, double v0, double v1, double d) {
  const auto term = [d](double u, double v) {
    return std::atan2(u * v, d * std::sqrt(u * u + v * v + d * d));
  };
  return term(u1, v1) - term(u0, v1) - term(u1, v0) + term(u0, v0);
}

double box_by_corners(const Vec3d& eye, const Box3d& box) {
  double sum = 0.0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned u = (axis + 1) % 3;
    const unsigned v = (axis + 2) % 3;
    const double d = std::max(box.lo[axis] - eye[axis], eye[axis] - box.hi[axis]);
    if (d > 0.0) {
      sum += rectangle_by_corners(box.lo[u] - eye[u], box.hi[u] - eye[u], box.lo[v] - eye[v],
                                  box.hi[v] - eye[v], d);
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("known solid angles") {
  REQUIRE(solid_angle_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}) == Approx(kPiD / 2.0));
  REQUIRE(solid_angle_of({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}) == Approx(kPiD / 2.0));
  const Box3d cube{{-1, -1, -1}, {1, 1, 1}};
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (const bool at_hi : {false, true}) {
      CAPTURE(axis, at_hi);
      REQUIRE(solid_angle_of({0, 0, 0}, face_of(cube, axis, at_hi)) == Approx(4.0 * kPiD / 6.0));
    }
  }
  // In the plane of a triangle: everything on one side from within, nothing from beside.
  REQUIRE(solid_angle_of({0.2, 0.2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == Approx(2.0 * kPiD));
  REQUIRE(solid_angle_of({1, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == 0.0);
  REQUIRE(solid_angle_of({0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == 0.0);
}

TEST_CASE("from inside a box, its faces, edges and corners") {
  const Box3d box{{-1, -2, -3}, {1, 2, 3}};
  REQUIRE(solid_angle_of({0.5, 1.5, -2.5}, box) == Approx(4.0 * kPiD));
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-2.0, 2.0}) {
      for (const double z : {-3.0, 3.0}) {
        CAPTURE(x, y, z);
        REQUIRE(solid_angle_of({x, 0.1, 0.2}, box) == Approx(2.0 * kPiD));
        REQUIRE(solid_angle_of({0.1, y, 0.2}, box) == Approx(2.0 * kPiD));
        REQUIRE(solid_angle_of({0.1, 0.2, z}, box) == Approx(2.0 * kPiD));
        REQUIRE(solid_angle_of({x, y, 0.2}, box) == Approx(kPiD));
        REQUIRE(solid_angle_of({x, 0.2, z}, box) == Approx(kPiD));
        REQUIRE(solid_angle_of({x, y, z}, box) == Approx(0.5 * kPiD));
        // Just outside a face it is nearly half of all directions.
        REQUIRE(solid_angle_of({x * (1.0 + 1e-9), 0.1, 0.2}, box) == Approx(2.0 * kPiD).epsilon(1e-6));
      }
    }
  }
  REQUIRE(solid_angle_of({0, 0, 0}, Box3d{{-1, -1, 0}, {1, 1, 0}}) == Approx(2.0 * kPiD));  // flat
  REQUIRE(solid_angle_of({5, 0, 0}, Box3d{{-1, -1, 0}, {1, 1, 0}}) == 0.0);                 // flat, edge-on
  REQUIRE(solid_angle_of({0, 0, 0}, Box3d{}) == 0.0);
}

TEST_CASE("a box's solid angle is the sum of its faces' corner terms") {
  Source source(21);
  int outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Box3d box = source.box(-3.0, 3.0);
    const Vec3d eye = source.point(-6.0, 6.0);
    if (contains(box, eye)) continue;
    CAPTURE(i, box.lo, box.hi, eye);
    const double expected = box_by_corners(eye, box);
    REQUIRE(solid_angle_of(eye, box) == Approx(expected).epsilon(1e-9).margin(1e-13));
    ++outside;
  }
  REQUIRE(outside > 10000);
}

TEST_CASE("a box's solid angle is the share of directions that meet it") {
  Source source(22);
  for (int i = 0; i < 60; ++i) {
    const Box3d box = source.box(-2.0, 2.0);
    const Vec3d eye = source.point(-4.0, 4.0);
    CAPTURE(i, box.lo, box.hi, eye);
    std::uint64_t hits = 0;
    constexpr std::uint64_t kRays = 20000;
    for (std::uint64_t k = 0; k < kRays; ++k) hits += intersect({eye, source.direction()}, box) ? 1 : 0;
    require_share(hits, kRays, solid_angle_of(eye, box) / (4.0 * kPiD));
  }
}

TEST_CASE("far away, the solid angle is projected area over distance squared to the last digits") {
  const Box3d box{{-0.5, -0.25, -1.0}, {0.5, 0.25, 1.0}};
  const Vec3d n = unit_of({1.0, -2.0, 3.0});
  const double area = std::abs(n[0]) * 0.5 * 2.0 + std::abs(n[1]) * 1.0 * 2.0 + std::abs(n[2]) * 1.0 * 0.5;
  for (const double distance : {1e3, 1e6, 1e9}) {
    CAPTURE(distance);
    REQUIRE(solid_angle_of(distance * n, box) * distance * distance ==
            Approx(area).epsilon(10.0 / distance + 1e-8));
  }
}

TEST_CASE("a polygon's solid angle does not depend on where its fan begins") {
  Source source(23);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d u = source.direction();
    const Vec3d v = unit_of(cross(u, source.direction()));
    const Vec3d centre = source.point(-2.0, 2.0);
    Polygon3d polygon;
    for (int k = 0; k < 7; ++k) polygon.push_back(centre + std::cos(0.9 * k) * u + std::sin(0.9 * k) * v);
    const Vec3d eye = centre + source.point(-3.0, 3.0);
    CAPTURE(i, polygon, eye);
    const double first = solid_angle_of(eye, polygon);
    for (std::size_t turn = 1; turn < 7; ++turn) {
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
      REQUIRE(solid_angle_of(eye, polygon) == Approx(first).epsilon(1e-9).margin(1e-12));
    }
  }
}
