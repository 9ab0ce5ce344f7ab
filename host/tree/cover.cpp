#include "gnomon/tree/cover.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {

namespace {

using Point = std::array<double, 3>;
using Polygon = std::vector<Point>;

// Strips thinner than this share of the largest coordinate are what clipping in double leaves.
constexpr double kRoundingLeaves = 1e-12;

Point point_of(const float* v) {
  return {double{v[0]}, double{v[1]}, double{v[2]}};
}

bool holds(const Node& box, const float* point) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) inside = inside && box.lo[k] <= point[k] && point[k] <= box.hi[k];
  return inside;
}

// The part of a convex polygon where side * (x[axis] - plane) >= 0.
Polygon clipped(const Polygon& polygon, std::size_t axis, double plane, double side) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const double da = side * (a[axis] - plane);
    const double db = side * (b[axis] - plane);
    if (da >= 0.0) out.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      Point at{};
      for (std::size_t k = 0; k < 3; ++k) at[k] = a[k] + (b[k] - a[k]) * (da / (da - db));
      at[axis] = plane;
      out.push_back(at);
    }
  }
  return out;
}

double length_of(const Point& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Point between(const Point& a, const Point& b) {
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

// Twice the area over the longest edge from the first corner.
double width_of(const Polygon& polygon) {
  double area = 0.0;
  double longest = 0.0;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const Point a = between(polygon[0], polygon[i]);
    longest = std::max(longest, length_of(a));
    if (i + 1 == polygon.size()) break;
    const Point b = between(polygon[0], polygon[i + 1]);
    area += length_of({a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]});
  }
  return longest > 0.0 ? area / longest : 0.0;
}

// What is left of a polygon outside a box: convex pieces.
void subtract(const Polygon& polygon, const Node& box, std::vector<Polygon>& pieces) {
  Polygon rest = polygon;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const double plane = side > 0.0 ? double{box.lo[axis]} : double{box.hi[axis]};
      Polygon outside = clipped(rest, axis, plane, -side);
      // A piece that only touches the plane is none.
      const bool some = std::any_of(outside.begin(), outside.end(),
                                    [&](const Point& p) { return side * (p[axis] - plane) < 0.0; });
      if (some) pieces.push_back(std::move(outside));
      rest = clipped(rest, axis, plane, side);
      if (rest.empty()) return;
    }
  }
}

}  // namespace

bool boxes_cover(const GnTriangle& triangle, std::span<const Node> boxes) {
  double largest = 0.0;
  for (const float* corner : {triangle.v0, triangle.v1, triangle.v2}) {
    if (std::none_of(boxes.begin(), boxes.end(), [&](const Node& box) { return holds(box, corner); }))
      return false;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(double{corner[k]}));
  }
  const auto holds_all = [&](const Node& box) {
    return holds(box, triangle.v0) && holds(box, triangle.v1) && holds(box, triangle.v2);
  };
  if (std::any_of(boxes.begin(), boxes.end(), holds_all)) return true;
  std::vector<Polygon> pieces{{point_of(triangle.v0), point_of(triangle.v1), point_of(triangle.v2)}};
  for (const Node& box : boxes) {
    std::vector<Polygon> left;
    for (const Polygon& piece : pieces) subtract(piece, box, left);
    std::erase_if(left, [&](const Polygon& piece) { return width_of(piece) <= kRoundingLeaves * largest; });
    pieces = std::move(left);
  }
  return pieces.empty();
}

}  // namespace gnomon
