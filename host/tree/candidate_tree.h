// Which triangles a ray may meet in its range, by boxes: how the judge gets through large scenes and many
// rays. Built by halving, its boxes tested in double and widened by more than that rounds: it shares nothing
// with the builders and traversals it helps to judge, and is itself tested against looking at every triangle.
// Feeds the judge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "gnomon/shared/layout.h"

namespace gnomon {

class CandidateTree {
 public:
  // Triangles with a coordinate that is not finite are left out: nothing meets them.
  explicit CandidateTree(std::span<const GnTriangle> triangles);

  // For a ray with finite origin and direction that is not zero: calls visit(triangle index), near ones first
  // as far as boxes tell, for every triangle that the ray meets at some t with tmin <= t <= tmax, and for
  // others. visit returns how far it still wants to look: a tmax, which only counts when it is less.
  template <typename Visit>
  void visit(const GnRay& ray, double tmin, double tmax, Visit&& visit) const;

 private:
  struct Node {
    std::array<float, 3> lo;
    std::array<float, 3> hi;
    std::uint32_t first;  // of its triangles; inner nodes: the left child, the right one next to it
    std::uint32_t count;  // 0: an inner node
  };
  struct Line {
    std::array<double, 3> origin;
    std::array<double, 3> direction;
    std::array<double, 3> inverse;
  };
  struct Waiting {
    std::uint32_t node;
    double entry;
  };
  struct Item;
  static constexpr std::size_t kStack = 64;  // halving 2^32 triangles takes 32 levels

  static Line line_of(const GnRay& ray);
  // Where the line enters the box, or +inf where it misses it between tmin and tmax. Difference, reciprocal
  // and product are off by 3 * 2^-53 of the distance together: 2^-50 covers it.
  static double entry_of(const Line& line, const Node& node, double tmin, double tmax);
  void fill(std::uint32_t node, std::span<Item> items, std::uint32_t first);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

inline double CandidateTree::entry_of(const Line& line, const Node& node, double tmin, double tmax) {
  double near = tmin;
  double far = tmax;
  for (std::size_t k = 0; k < 3; ++k) {
    const double lo = static_cast<double>(node.lo[k]) - line.origin[k];
    const double hi = static_cast<double>(node.hi[k]) - line.origin[k];
    if (line.direction[k] == 0.0) {
      if (lo > 0.0 || hi < 0.0) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double a = (line.direction[k] > 0.0 ? lo : hi) * line.inverse[k];
    const double b = (line.direction[k] > 0.0 ? hi : lo) * line.inverse[k];
    near = std::max(near, a - 0x1p-50 * std::fabs(a));
    far = std::min(far, b + 0x1p-50 * std::fabs(b));
  }
  return near <= far ? near : std::numeric_limits<double>::infinity();
}

template <typename Visit>
void CandidateTree::visit(const GnRay& ray, double tmin, double tmax, Visit&& visit) const {
  if (nodes_.empty()) return;
  const Line line = line_of(ray);
  constexpr double kMissed = std::numeric_limits<double>::infinity();
  std::array<Waiting, kStack> waiting;
  std::size_t height = 0;
  const double entry = entry_of(line, nodes_[0], tmin, tmax);
  if (entry < kMissed) waiting[height++] = {0, entry};
  while (height > 0) {
    const Waiting next = waiting[--height];
    if (next.entry > tmax) continue;
    const Node& node = nodes_[next.node];
    for (std::uint32_t i = 0; i < node.count; ++i) tmax = std::min(tmax, visit(order_[node.first + i]));
    if (node.count > 0) continue;
    Waiting near{node.first, entry_of(line, nodes_[node.first], tmin, tmax)};
    Waiting far{node.first + 1, entry_of(line, nodes_[node.first + 1], tmin, tmax)};
    if (far.entry < near.entry) std::swap(near, far);
    if (far.entry < kMissed) waiting[height++] = far;
    if (near.entry < kMissed) waiting[height++] = near;
  }
}

}  // namespace gnomon
