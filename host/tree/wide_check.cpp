#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/cover.h"
#include "gnomon/tree/wide.h"

namespace gnomon {
namespace {

using MaybeFault = std::optional<BvhFault>;

BvhFault fault(std::string what, std::size_t node = GN_NONE) {
  return {std::move(what), static_cast<std::uint32_t>(node)};
}

std::string text(std::uint64_t number) {
  return std::to_string(number);
}

bool is_leaf(std::uint32_t link) {
  return (link & GN_LEAF_LINK) != 0;
}

// A slot's box, as the collapse knew it.
Node box_of(const WideNode& node, std::uint32_t slot) {
  Node box{};
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = node.planes[2 * k][slot];
    box.hi[k] = node.planes[2 * k + 1][slot];
  }
  return box;
}

bool is_inverted(const Node& box) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return std::all_of(box.lo, box.lo + 3, [](float x) { return x == kInfinity; }) &&
         std::all_of(box.hi, box.hi + 3, [](float x) { return x == -kInfinity; });
}

// False also where a bound or the point is NaN.
bool holds(const Node& box, const float point[3]) {
  for (int k = 0; k < 3; ++k) {
    if (!(box.lo[k] <= point[k] && point[k] <= box.hi[k])) return false;
  }
  return true;
}

class Check {
 public:
  Check(const WideBvh& wide, std::span<const GnTriangle> triangles, Repeats repeats)
      : wide_(wide), triangles_(triangles), repeats_(repeats), boxes_(triangles.size()) {
    if (wide.frame) turned_ = turned(triangles, *wide.frame);
    boxed_ = wide.frame ? std::span<const GnTriangle>(turned_) : triangles;
  }

  MaybeFault run() {
    if (wide_.frame) {
      if (const auto wrong = fault_of(*wide_.frame, triangles_)) return fault("frame: " + *wrong);
    }
    if (MaybeFault found = check_sizes()) return found;
    if (MaybeFault found = check_links()) return found;
    for (const std::uint32_t node : order_) {
      if (MaybeFault found = check_slots(node)) return found;
    }
    for (const std::uint32_t node : order_) {
      if (MaybeFault found = check_children(node)) return found;
    }
    const auto lost = std::find(triangle_seen_.begin(), triangle_seen_.end(), 0);
    if (lost != triangle_seen_.end())
      return fault("triangles: " + text(index_in(triangle_seen_, lost)) + " is in no leaf");
    if (wide_.depth != deepest_)
      return fault("depth: " + text(wide_.depth) + " instead of " + text(deepest_));
    for (std::size_t i = 0; i < triangles_.size() && repeats_ == Repeats::kAllowed; ++i) {
      if (!boxes_cover(boxed_[i], boxes_.of(i)))
        return fault("cover: triangle " + text(i) + " is not wholly in the leaves that hold it");
    }
    return std::nullopt;
  }

 private:
  static std::size_t index_in(const std::vector<char>& all, std::vector<char>::const_iterator at) {
    return static_cast<std::size_t>(at - all.begin());
  }

  MaybeFault check_sizes() {
    if (wide_.nodes.empty()) return fault("sizes: no root");
    if (wide_.nodes.size() > GN_LEAF_LINK || wide_.places() > GN_MAX_PLACES)
      return fault("sizes: more nodes or leaves than links can name");
    if (wide_.leaves.size() % GN_TRIANGLE_WORDS != 0) return fault("sizes: part of a place");
    node_seen_.assign(wide_.nodes.size(), 0);
    place_seen_.assign(wide_.places(), 0);
    triangle_seen_.assign(triangles_.size(), 0);
    return std::nullopt;
  }

  // Parents come before children in order_.
  MaybeFault check_links() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 1}};
    node_seen_[0] = 1;
    while (!open.empty()) {
      const auto [index, depth] = open.back();
      open.pop_back();
      order_.push_back(index);
      deepest_ = std::max(deepest_, depth);
      for (const std::uint32_t link : wide_.nodes[index].links) {
        if (link == GN_NONE) continue;
        if (is_leaf(link)) {
          if (MaybeFault found = take_places(index, link)) return found;
          continue;
        }
        if (link >= wide_.nodes.size())
          return fault("links: node " + text(link) + " of " + text(wide_.nodes.size()), index);
        if (node_seen_[link] != 0)
          return fault("links: node " + text(link) + " is referenced twice or is the root", index);
        node_seen_[link] = 1;
        open.emplace_back(link, depth + 1);
      }
    }
    const auto lost_node = std::find(node_seen_.begin(), node_seen_.end(), 0);
    if (lost_node != node_seen_.end())
      return fault("links: node never referenced", index_in(node_seen_, lost_node));
    const auto lost_place = std::find(place_seen_.begin(), place_seen_.end(), 0);
    if (lost_place == place_seen_.end()) return std::nullopt;
    return fault("links: place " + text(index_in(place_seen_, lost_place)) + " is in no leaf");
  }

  MaybeFault take_places(std::uint32_t index, std::uint32_t link) {
    const std::uint64_t first = gn_link_place(link);
    if (first >= wide_.places()) {
      return fault("links: a leaf begins at place " + text(first) + " of " + text(wide_.places()), index);
    }
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    const bool is_long = leaf.first != first;
    if (is_long && (leaf.count < GN_LONG_LEAF || leaf.count > GN_MAX_WIDE_LEAF))
      return fault("leaves: a long one of " + text(leaf.count) + " triangles", index);
    const std::uint64_t end = std::uint64_t{leaf.first} + leaf.count;
    if (end > wide_.places()) {
      return fault("links: a leaf's places end at " + text(end) + " of " + text(wide_.places()), index);
    }
    const auto count = wide_.leaves.begin() + static_cast<std::ptrdiff_t>(first * GN_TRIANGLE_WORDS);
    if (is_long && std::any_of(count + 1, count + GN_TRIANGLE_WORDS, [](auto word) { return word != 0; }))
      return fault("leaves: something behind a long one's count", index);
    for (std::uint64_t place = first; place < end; ++place) {
      if (place_seen_[place] != 0) return fault("links: place " + text(place) + " is in two leaves", index);
      place_seen_[place] = 1;
    }
    return std::nullopt;
  }

  static const float* corner_of(const GnTriangle& triangle, int k) {
    return k == 0 ? triangle.v0 : k == 1 ? triangle.v1 : triangle.v2;
  }

  // What a node's slots are by themselves.
  [[nodiscard]] MaybeFault check_slots(std::uint32_t index) const {
    const WideNode& node = wide_.nodes[index];
    std::uint32_t filled = 0;
    while (filled < GN_WIDTH && node.links[filled] != GN_NONE) ++filled;
    if (filled == 0 && (index != 0 || !triangles_.empty())) return fault("slots: no child", index);
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      const Node box = box_of(node, slot);
      if (slot >= filled) {
        if (node.links[slot] != GN_NONE) return fault("slots: an empty one before slot " + text(slot), index);
        if (!is_inverted(box)) return fault("slots: the box of empty slot " + text(slot), index);
        continue;
      }
      if (!holds(box, box.lo)) return fault("box: NaN or inverted, slot " + text(slot), index);
    }
    return std::nullopt;
  }

  MaybeFault check_children(std::uint32_t index) {
    const WideNode& node = wide_.nodes[index];
    for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
      const Node box = box_of(node, slot);
      const std::uint32_t link = node.links[slot];
      if (is_leaf(link)) {
        if (MaybeFault found = check_leaf(index, box, link)) return found;
        continue;
      }
      const WideNode& child = wide_.nodes[link];
      for (std::uint32_t below = 0; below < GN_WIDTH && child.links[below] != GN_NONE; ++below) {
        const Node inner = box_of(child, below);
        if (!holds(box, inner.lo) || !holds(box, inner.hi))
          return fault("box: slot " + text(below) + " reaches beyond its parent's", link);
      }
    }
    return std::nullopt;
  }

  MaybeFault check_leaf(std::uint32_t index, const Node& box, std::uint32_t link) {
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t primitive = number_in(wide_, gn_seat_in(leaf, i));
      const GnTriangle held = triangle_in(wide_, gn_seat_in(leaf, i));
      if (primitive >= triangles_.size())
        return fault("triangles: number " + text(primitive) + " of " + text(triangles_.size()), index);
      if (triangle_seen_[primitive] != 0 && repeats_ == Repeats::kNone)
        return fault("triangles: " + text(primitive) + " appears twice", index);
      triangle_seen_[primitive] = 1;
      if (repeats_ == Repeats::kAllowed) boxes_.add(primitive, box);
      for (int k = 0; k < 3; ++k) {
        const float* corner = corner_of(triangles_[primitive], k);
        if (!std::equal(corner, corner + 3, corner_of(held, k)))
          return fault("triangles: corner " + text(static_cast<unsigned>(k)) + " of " + text(primitive) +
                           " is another",
                       index);
        if (!holds(box, corner_of(boxed_[primitive], k)) && repeats_ == Repeats::kNone)
          return fault("box: triangle " + text(primitive) + " reaches beyond its leaf's", index);
      }
    }
    return std::nullopt;
  }

  const WideBvh& wide_;
  std::span<const GnTriangle> triangles_;
  std::vector<GnTriangle> turned_;
  std::span<const GnTriangle> boxed_;  // as boxes stand
  Repeats repeats_;
  TriangleBoxes boxes_;
  std::vector<char> node_seen_, place_seen_, triangle_seen_;
  std::vector<std::uint32_t> order_;
  std::uint32_t deepest_ = 0;
};

}  // namespace

std::optional<BvhFault> check_wide(const WideBvh& wide, std::span<const GnTriangle> triangles,
                                   Repeats repeats) {
  return Check(wide, triangles, repeats).run();
}

}  // namespace gnomon
