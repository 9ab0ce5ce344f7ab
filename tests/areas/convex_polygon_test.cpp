// Convex polygons in the plane.
#include "gnomon/areas/convex_polygon.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "area_test_tools.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Polygon2d square(double x, double y, double side = 1.0) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

Polygon2d reversed(Polygon2d polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

Polygon2d random_hull(Source& source, int points) {
  Polygon2d cloud;
  const Vec2d centre = source.point2(-1.0, 1.0);
  const double size = std::exp2(source.between(-4.0, 1.0));
  for (int i = 0; i < points; ++i) {
    const Vec2d d = source.point2(-size, size);
    cloud.push_back({centre[0] + d[0], centre[1] + d[1]});
  }
  return convex_hull_of(cloud);
}

// Crossings of a ray to the right with the sides: inside for an odd count. Says nothing about the boundary.
bool inside_by_crossings(const Polygon2d& polygon, const Vec2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d& a = polygon[i];
    const Vec2d& b = polygon[(i + 1) % polygon.size()];
    if ((a[1] > p[1]) == (b[1] > p[1])) continue;
    if (p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
  }
  return inside;
}

}  // namespace

TEST_CASE("areas of known polygons, wherever they lie and whichever way round") {
  for (const double offset : {0.0, 1e6, -1e9}) {
    CAPTURE(offset);
    REQUIRE(signed_area_of(square(offset, offset, 2.0)) == 4.0);
    REQUIRE(signed_area_of(reversed(square(offset, offset, 2.0))) == -4.0);
    REQUIRE(area_of(reversed(square(offset, offset, 2.0))) == 4.0);
  }
  REQUIRE(area_of(Polygon2d{{0, 0}, {3, 0}, {0, 2}}) == 3.0);
  REQUIRE(area_of(Polygon2d{{0, 0}, {3, 1}}) == 0.0);
  REQUIRE(area_of(Polygon2d{}) == 0.0);
  Polygon2d circle;
  for (int i = 0; i < 1000; ++i) circle.push_back({std::cos(2e-3 * kPiD * i), std::sin(2e-3 * kPiD * i)});
  REQUIRE(area_of(circle) == Approx(500.0 * std::sin(2e-3 * kPiD)));
}

TEST_CASE("a point is in a polygon when an odd number of sides lies to its right, for both orientations") {
  Source source(11);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Polygon2d hull = random_hull(source, 3 + i % 8);
    const Vec2d p = source.point2(-2.0, 2.0);
    CAPTURE(i, hull, p);
    const bool expected = inside_by_crossings(hull, p);
    REQUIRE(contains(hull, p) == expected);
    REQUIRE(contains(reversed(hull), p) == expected);
    inside += expected ? 1 : 0;
  }
  REQUIRE(inside > 500);
}

TEST_CASE("sides and corners are in a polygon, what is beside them is not") {
  Source source(12);
  for (int i = 0; i < 5000; ++i) {
    const Polygon2d hull = random_hull(source, 3 + i % 6);
    if (area_of(hull) < 1e-3) continue;
    const std::size_t k = static_cast<std::size_t>(i) % hull.size();
    const Vec2d& a = hull[k];
    const Vec2d& b = hull[(k + 1) % hull.size()];
    const double s = source.between(0.0, 1.0);
    const Vec2d on{a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])};
    const Vec2d outward{b[1] - a[1], a[0] - b[0]};
    CAPTURE(i, hull, on);
    for (const Polygon2d& polygon : {hull, reversed(hull)}) {
      REQUIRE(contains(polygon, a));
      REQUIRE(contains(polygon, on));
      REQUIRE_FALSE(contains(polygon, Vec2d{on[0] + 1e-9 * outward[0], on[1] + 1e-9 * outward[1]}));
    }
  }
  // Degenerate polygons: a repeated corner, a corner on a side, a segment, a point, nothing.
  REQUIRE(contains(Polygon2d{{0, 0}, {0, 0}, {2, 0}, {2, 0}, {1, 1}}, Vec2d{1, 0.5}));
  REQUIRE(contains(Polygon2d{{0, 0}, {1, 0}, {2, 0}, {2, 2}}, Vec2d{1, 0}));
  REQUIRE(contains(Polygon2d{{0, 0}, {2, 2}}, Vec2d{1, 1}));
  REQUIRE_FALSE(contains(Polygon2d{{0, 0}, {2, 2}}, Vec2d{3, 3}));
  REQUIRE_FALSE(contains(Polygon2d{{0, 0}, {2, 2}}, Vec2d{1, 1.001}));
  REQUIRE(contains(Polygon2d{{1, 1}}, Vec2d{1, 1}));
  REQUIRE_FALSE(contains(Polygon2d{{1, 1}}, Vec2d{1, 2}));
  REQUIRE_FALSE(contains(Polygon2d{}, Vec2d{0, 0}));
}

TEST_CASE("the area that two polygons share is the share of points in both") {
  Source source(13);
  int shared = 0;
  for (int i = 0; i < 300; ++i) {
    const Polygon2d a = random_hull(source, 3 + i % 6);
    const Polygon2d b = random_hull(source, 3 + i % 5);
    const Polygon2d both = intersection_of(a, i % 2 == 0 ? b : reversed(b));
    CAPTURE(i, a, b, both);
    const double area = signed_area_of(both);
    REQUIRE(area >= -1e-12);
    REQUIRE(area <= std::min(area_of(a), area_of(b)) + 1e-12);
    REQUIRE(area == Approx(area_of(intersection_of(b, a))).margin(1e-12));
    for (const Vec2d& corner : both) REQUIRE((contains(a, corner) && contains(b, corner)));
    Vec2d lo = a[0];
    Vec2d hi = a[0];
    for (const Vec2d& p : a) {
      for (std::size_t k = 0; k < 2; ++k) {
        lo[k] = std::min(lo[k], p[k]);
        hi[k] = std::max(hi[k], p[k]);
      }
    }
    std::uint64_t hits = 0;
    constexpr std::uint64_t kSamples = 4000;
    for (std::uint64_t s = 0; s < kSamples; ++s) {
      const Vec2d p{source.between(lo[0], hi[0]), source.between(lo[1], hi[1])};
      hits += inside_by_crossings(a, p) && inside_by_crossings(b, p) ? 1 : 0;
    }
    require_share(hits, kSamples, std::min(1.0, area_of(both) / ((hi[0] - lo[0]) * (hi[1] - lo[1]))));
    shared += area > 1e-3 ? 1 : 0;
  }
  REQUIRE(shared > 30);
}

TEST_CASE("collinear, parallel, containing and touching polygons share exactly what they should") {
  const Polygon2d unit = square(0, 0);
  const auto shared = [](const Polygon2d& a, const Polygon2d& b) {
    const double ab = area_of(intersection_of(a, b));
    REQUIRE(area_of(intersection_of(b, a)) == ab);
    REQUIRE(area_of(intersection_of(reversed(a), b)) == ab);
    REQUIRE(area_of(intersection_of(a, reversed(b))) == ab);
    return ab;
  };
  REQUIRE(shared(unit, unit) == 1.0);                      // all sides common
  REQUIRE(shared(unit, square(0.5, 0)) == 0.5);            // collinear overlapping sides
  REQUIRE(shared(unit, square(0.25, 0.25, 0.5)) == 0.25);  // contained
  REQUIRE(shared(unit, square(0, 0.25, 0.5)) == 0.25);     // contained, a side on a side
  REQUIRE(shared(unit, square(-1, -1, 4)) == 1.0);         // containing
  REQUIRE(shared(unit, square(1, 0)) == 0.0);              // touching along a side
  REQUIRE(shared(unit, square(1, 1)) == 0.0);              // touching in a corner
  REQUIRE(shared(unit, square(1.5, 0)) == 0.0);            // disjoint
  REQUIRE(shared(unit, Polygon2d{{-1, 0.25}, {2, 0.25}, {2, 0.75}, {-1, 0.75}}) == 0.5);  // crossing
  REQUIRE(shared(unit, Polygon2d{{0.5, -0.5}, {1.5, 0.5}, {0.5, 1.5}, {-0.5, 0.5}}) ==
          1.0);  // corners on sides
  REQUIRE(shared(unit, Polygon2d{{0.5, 0.5}, {2, 0.5}, {2, 2}}) == 0.125);
  REQUIRE(shared(unit, Polygon2d{{0, 0}, {1, 1}}) == 0.0);  // a segment
  // Corners that repeat, or lie on a side.
  REQUIRE(shared(unit, Polygon2d{{0, 0}, {0, 0}, {0.5, 0}, {0.5, 0.5}, {0.5, 0.5}, {0, 0.5}, {0, 0}}) ==
          0.25);
  REQUIRE(shared(unit, Polygon2d{{-1, -1}, {0, -1}, {2, -1}, {2, -1}, {2, 2}, {-1, 2}, {-1, 2}}) == 1.0);
  REQUIRE(intersection_of(unit, Polygon2d{}).empty());
  // One tenth of a side apart is apart: the thesis' tolerance of 0.01 made area out of such pairs.
  for (const double side : {1.0, 0.05, 0.005, 1e-9}) {
    CAPTURE(side);
    REQUIRE(area_of(intersection_of(square(0, 0, side), square(1.1 * side, 0, side))) == 0.0);
  }
}

TEST_CASE("shuffled corners of a convex polygon come back in counter-clockwise order") {
  Source source(14);
  for (int i = 0; i < 2000; ++i) {
    const Polygon2d hull = random_hull(source, 3 + i % 12);
    Polygon2d shuffled = hull;
    for (std::size_t k = shuffled.size(); k > 1; --k)
      std::swap(shuffled[k - 1], shuffled[source.raw().below(static_cast<unsigned>(k))]);
    Polygon2d sorted = in_counter_clockwise_order(shuffled);
    CAPTURE(i, hull, shuffled, sorted);
    std::rotate(sorted.begin(), std::find(sorted.begin(), sorted.end(), hull[0]), sorted.end());
    REQUIRE(sorted == hull);
  }
}

TEST_CASE("sorting equal and collinear corners is safe and keeps them all") {
  const Polygon2d same(40, Vec2d{1.0, 2.0});
  REQUIRE(in_counter_clockwise_order(same) == same);
  Polygon2d line;
  for (int i = 0; i < 40; ++i) line.push_back({static_cast<double>(i % 7), 0.0});
  const Polygon2d sorted = in_counter_clockwise_order(line);
  REQUIRE(std::is_permutation(sorted.begin(), sorted.end(), line.begin(), line.end()));
  REQUIRE(in_counter_clockwise_order(Polygon2d{}).empty());
}

TEST_CASE("a convex hull holds all its points and turns left at every corner") {
  Source source(15);
  for (int i = 0; i < 1000; ++i) {
    Polygon2d cloud;
    for (int k = 0; k < 4 + i % 30; ++k) {
      // A coarse lattice, so that many points coincide or lie on a side.
      const Vec2d p = source.point2(-3.0, 3.0);
      cloud.push_back({std::floor(p[0]), std::floor(p[1])});
    }
    const Polygon2d hull = convex_hull_of(cloud);
    CAPTURE(i, cloud, hull);
    for (const Vec2d& p : cloud) REQUIRE(contains(hull, p));
    if (hull.size() < 3) continue;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Vec2d& b = hull[(k + 1) % hull.size()];
      REQUIRE(cross(b - hull[k], hull[(k + 2) % hull.size()] - b) > 0.0);
    }
  }
}
