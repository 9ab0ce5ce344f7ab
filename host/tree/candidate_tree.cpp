#include "gnomon/tree/candidate_tree.h"

namespace gnomon {

namespace {

constexpr std::size_t kLeaf = 4;

}  // namespace

// A triangle's box while the tree is built.
struct CandidateTree::Item {
  std::array<float, 3> lo;
  std::array<float, 3> hi;
  std::uint32_t triangle;
  [[nodiscard]] double middle(std::size_t axis) const {
    return static_cast<double>(lo[axis]) + static_cast<double>(hi[axis]);
  }
};

CandidateTree::Line CandidateTree::line_of(const GnRay& ray) {
  Line line{};
  for (std::size_t k = 0; k < 3; ++k) {
    line.origin[k] = ray.origin[k];
    line.direction[k] = ray.direction[k];
    line.inverse[k] = 1.0 / line.direction[k];  // not used for zero
  }
  return line;
}

CandidateTree::CandidateTree(std::span<const GnTriangle> triangles) {
  std::vector<Item> items;
  items.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const GnTriangle& t = triangles[i];
    Item item{{}, {}, i};
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      item.lo[k] = std::min({t.v0[k], t.v1[k], t.v2[k]});
      item.hi[k] = std::max({t.v0[k], t.v1[k], t.v2[k]});
      finite = finite && std::isfinite(t.v0[k]) && std::isfinite(t.v1[k]) && std::isfinite(t.v2[k]);
    }
    if (finite) items.push_back(item);
  }
  if (items.empty()) return;
  nodes_.reserve(items.size());
  order_.resize(items.size());
  nodes_.emplace_back();
  fill(0, items, 0);
}

// Halves by count along the axis in which the middles spread most.
void CandidateTree::fill(std::uint32_t node, std::span<Item> items, std::uint32_t first) {
  Node box{items[0].lo, items[0].hi, first, static_cast<std::uint32_t>(items.size())};
  std::array<double, 3> least{};
  std::array<double, 3> most{};
  for (std::size_t k = 0; k < 3; ++k) least[k] = most[k] = items[0].middle(k);
  for (const Item& item : items) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = std::min(box.lo[k], item.lo[k]);
      box.hi[k] = std::max(box.hi[k], item.hi[k]);
      least[k] = std::min(least[k], item.middle(k));
      most[k] = std::max(most[k], item.middle(k));
    }
  }
  if (items.size() <= kLeaf) {
    for (std::size_t i = 0; i < items.size(); ++i) order_[first + i] = items[i].triangle;
    nodes_[node] = box;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
  }
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const Item& a, const Item& b) { return a.middle(axis) < b.middle(axis); });
  box.first = static_cast<std::uint32_t>(nodes_.size());
  box.count = 0;
  nodes_[node] = box;
  nodes_.resize(nodes_.size() + 2);
  fill(box.first, items.first(half), first);
  fill(box.first + 1, items.subspan(half), first + static_cast<std::uint32_t>(half));
}

}  // namespace gnomon
