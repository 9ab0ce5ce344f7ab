// Polygons into triangles.
#include "gnomon/scene/polygon.h"

#include <catch2/catch.hpp>
#include <cmath>

using gnomon::split_polygon;
using gnomon::Vec3;

namespace {

constexpr double kPi = 3.14159265358979323846;

// A star: every second corner at the inner radius.
std::vector<Vec3> star(unsigned corners, double inner, double x, double y) {
  std::vector<Vec3> outline;
  for (unsigned i = 0; i < corners; ++i) {
    const double radius = i % 2 == 0 ? 1.0 : inner;
    const double angle = 2.0 * kPi * i / corners;
    outline.push_back({static_cast<float>(x + radius * std::cos(angle)),
                       static_cast<float>(y + radius * std::sin(angle)), 0.0F});
  }
  return outline;
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * ((static_cast<double>(b[0]) - a[0]) * (static_cast<double>(c[1]) - a[1]) -
                (static_cast<double>(b[1]) - a[1]) * (static_cast<double>(c[0]) - a[0]));
}

double outline_area(const std::vector<Vec3>& outline) {
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) area += turn(outline[0], outline[i], outline[i + 1]);
  return area;
}

// Every triangle turns as the outline does, and together they have its area: so none overlap.
void check_covers(const std::vector<Vec3>& outline) {
  const auto triangles = split_polygon(outline);
  CHECK(triangles.size() == outline.size() - 2);
  double area = 0.0;
  for (const auto& [a, b, c] : triangles) {
    CHECK(turn(outline[a], outline[b], outline[c]) > 0.0);
    area += turn(outline[a], outline[b], outline[c]);
  }
  CHECK(area == Approx(outline_area(outline)));
}

}  // namespace

TEST_CASE("triangles of a concave polygon cover it exactly once, wherever it lies") {
  for (const double x : {-50.0, 0.0, 50.0}) {
    for (const double y : {-50.0, 0.0, 50.0}) {
      INFO("at " << x << ", " << y);
      check_covers(star(7, 0.4, x, y));
      check_covers(star(64, 0.7, x, y));
    }
  }
}

TEST_CASE("an arrowhead is split along the diagonal inside it, whichever corner comes first") {
  std::vector<Vec3> arrow{{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}};
  for (unsigned first = 0; first < 4; ++first) {
    check_covers(arrow);
    arrow.push_back(arrow.front());
    arrow.erase(arrow.begin());
  }
}

TEST_CASE("corners in the middle of straight edges make no triangles without area") {
  check_covers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}});
}

TEST_CASE("a circle of 5000 corners is split in time") {
  const auto circle = star(5000, 1.0, 10.0, 3.0);
  const auto triangles = split_polygon(circle);
  CHECK(triangles.size() == 4998);
  double area = 0.0;
  for (const auto& [a, b, c] : triangles) area += turn(circle[a], circle[b], circle[c]);
  CHECK(area == Approx(outline_area(circle)));
}

TEST_CASE("a polygon that faces another way, crosses itself or is flat still gives n - 2 triangles") {
  const std::vector<Vec3> upright{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {0, -1, 0.5F}};
  CHECK(split_polygon(upright).size() == 3);
  std::vector<Vec3> pentagram;
  for (unsigned i = 0; i < 5; ++i) {
    const double angle = 4.0 * kPi * i / 5.0;
    pentagram.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0F});
  }
  CHECK(split_polygon(pentagram).size() == 3);
  CHECK(split_polygon(std::vector<Vec3>(6, Vec3{1, 1, 1})).size() == 4);
  CHECK(split_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).size() == 2);
  const float nan = std::nanf("");
  CHECK(
      split_polygon(std::vector<Vec3>{{0, 0, 0}, {nan, 0, 0}, {1, 1, 0}, {0, 1, nan}, {0, nan, 1}}).size() ==
      3);
}
