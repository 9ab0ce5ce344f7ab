#include "gnomon/areas/convex_polygon.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace gnomon {
namespace {

constexpr double kOnSide = 0x1p-48;

double distance_1(const Vec2d& a, const Vec2d& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]);
}

// What is left of the line from `from` to `to`, or on it. Cut corners lie between their neighbours whatever
// the rounding.
Polygon2d keep_left_of(const Vec2d& from, const Vec2d& to, const Polygon2d& polygon) {
  const auto side_of = [&](const Vec2d& p) { return cross(to - from, p - from); };
  Polygon2d kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d& p = polygon[i];
    const Vec2d& q = polygon[(i + 1) % polygon.size()];
    const double p_side = side_of(p);
    const double q_side = side_of(q);
    if (p_side >= 0.0) kept.push_back(p);
    if ((p_side > 0.0 && q_side < 0.0) || (p_side < 0.0 && q_side > 0.0)) {
      const double s = p_side / (p_side - q_side);
      kept.push_back({p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])});
    }
  }
  return kept;
}

}  // namespace

double signed_area_of(std::span<const Vec2d> polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * twice;
}

double area_of(std::span<const Vec2d> polygon) {
  return std::abs(signed_area_of(polygon));
}

bool contains(std::span<const Vec2d> polygon, const Vec2d& point) {
  if (polygon.empty()) return false;
  double extent = 0.0;
  for (const Vec2d& corner : polygon) {
    extent = larger(extent, larger(distance_1(corner, polygon[0]), distance_1(corner, point)));
  }
  bool left = true;
  bool right = true;
  Vec2d lo = polygon[0];
  Vec2d hi = polygon[0];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double slack = kOnSide * extent * (std::abs(side[0]) + std::abs(side[1]));
    const double turn = cross(side, point - polygon[i]);
    left &= turn >= -slack;
    right &= turn <= slack;
    for (std::size_t k = 0; k < 2; ++k) {
      lo[k] = smaller(lo[k], polygon[i][k]);
      hi[k] = larger(hi[k], polygon[i][k]);
    }
  }
  // A polygon without area has every point of its line on both sides; its bounds tell where it ends.
  const double slack = kOnSide * extent;
  const bool bounded = point[0] >= lo[0] - slack && point[0] <= hi[0] + slack && point[1] >= lo[1] - slack &&
                       point[1] <= hi[1] + slack;
  return bounded && (left || right);
}

Polygon2d intersection_of(std::span<const Vec2d> a, std::span<const Vec2d> b) {
  if (a.empty() || b.empty()) return {};
  // The smaller one is cut: its corners stay exact, where those of a sliver's sides cut from a large polygon
  // would be as uncertain as nearly parallel lines' crossings are.
  if (area_of(b) < area_of(a)) std::swap(a, b);
  Polygon2d shared(a.begin(), a.end());
  if (signed_area_of(a) < 0.0) std::reverse(shared.begin(), shared.end());
  const bool clockwise = signed_area_of(b) < 0.0;
  for (std::size_t i = 0; i < b.size() && !shared.empty(); ++i) {
    const Vec2d& from = b[i];
    const Vec2d& to = b[(i + 1) % b.size()];
    if (from == to) continue;  // a repeated corner has no side
    shared = clockwise ? keep_left_of(to, from, shared) : keep_left_of(from, to, shared);
  }
  return shared;
}

Polygon2d in_counter_clockwise_order(std::span<const Vec2d> points) {
  Vec2d mean{0.0, 0.0};
  for (const Vec2d& p : points) {
    for (std::size_t k = 0; k < 2; ++k) mean[k] += p[k] / static_cast<double>(points.size());
  }
  // Angles are computed once and compared as numbers: comparing by cross products is not transitive when they
  // round.
  std::vector<std::tuple<double, double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2d d = points[i] - mean;
    order.emplace_back(std::atan2(d[1], d[0]), distance_1(points[i], mean), i);
  }
  std::sort(order.begin(), order.end());
  Polygon2d sorted;
  for (const auto& [angle, distance, place] : order) sorted.push_back(points[place]);
  return sorted;
}

Polygon2d convex_hull_of(std::span<const Vec2d> points) {
  Polygon2d sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  if (sorted.size() < 3) return sorted;
  Polygon2d hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0.0)
        hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the next chain begins with it
  };
  add_chain(sorted.begin(), sorted.end());
  add_chain(sorted.rbegin(), sorted.rend());
  return hull;
}

}  // namespace gnomon
