#include "gnomon/tree/wide.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/shared/collapse_math.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kMostTrianglesPerTask = 1U << 20U;

void check_cost(const char* name, float value) {
  if (!(value > 0.0F && value <= 1000.0F)) {
    throw Error(ErrorCode::kInvalidArgument, std::string("collapse option ") + name + " is " +
                                                 std::to_string(value) + "; it must lie in (0, 1000]");
  }
}

WideNode empty_node() {
  WideNode node{};
  for (int k = 0; k < 3; ++k) {
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      node.planes[2 * k][slot] = std::numeric_limits<float>::infinity();
      node.planes[2 * k + 1][slot] = -std::numeric_limits<float>::infinity();
    }
  }
  for (unsigned& link : node.links) link = GN_NONE;
  return node;
}

class Collapse {
 public:
  Collapse(const Bvh& bvh, std::span<const GnTriangle> triangles, const CollapseOptions& options,
           std::span<const float> slot_keys, std::span<const float> weights)
      : bvh_(bvh),
        triangles_(triangles),
        costs_{options.cost_node, options.cost_block},
        weights_{weights.data(), weights.empty() ? 0U : 1U},
        keys_(slot_keys.begin(), slot_keys.end()) {
    forests_.resize(bvh.nodes.size() / 2);
    weigh();
    if (slot_keys.empty()) find_keys();
  }

  WideBvh run() {
    wide_.nodes.push_back(empty_node());
    wide_.frame = bvh_.frame;
    emit(0, 0, 1);
    return std::move(wide_);
  }

 private:
  // Children before parents: the reverse of a walk that meets parents first.
  void weigh() {
    std::vector<std::uint32_t> inner;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      const Node& node = bvh_.nodes[index];
      if (node.count > GN_MAX_WIDE_LEAF) throw_leaf_too_large(node.count);
      if (node.count > 0) continue;
      inner.push_back(index);
      open.push_back(node.first);
      open.push_back(node.first + 1);
    }
    children_first_.assign(inner.rbegin(), inner.rend());
    for (const std::uint32_t index : children_first_) {
      const Node& node = bvh_.nodes[index];
      const GnForest left = forest_of(node.first);
      const GnForest right = forest_of(node.first + 1);
      forests_[(node.first - 1) / 2] =
          gn_inner_forest(gn_node_value(bvh_.nodes.data(), index, &weights_), &left, &right, costs_);
    }
  }

  // From what shows below each node.
  void find_keys() {
    keys_.resize(bvh_.nodes.size());
    std::vector<float> shown(bvh_.nodes.size());
    for (std::size_t i = 0; i < bvh_.nodes.size(); ++i) {
      const Node& node = bvh_.nodes[i];
      for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
        const GnTriangle& triangle = triangles_[bvh_.primitives[at]];
        shown[i] += gn_shown_area(triangle.v0, triangle.v1, triangle.v2);
      }
    }
    for (const std::uint32_t index : children_first_)
      shown[index] = shown[bvh_.nodes[index].first] + shown[bvh_.nodes[index].first + 1];
    for (std::size_t i = 0; i < keys_.size(); ++i)
      keys_[i] = gn_slot_key(gn_half_area(&bvh_.nodes[i]), shown[i]);
  }

  [[nodiscard]] GnForest forest_of(std::uint32_t node) const {
    return gn_forest_of(bvh_.nodes.data(), forests_.data(), node, &weights_, costs_.block);
  }

  // Writes the wide node at `place`; its inner children get neighbouring places, then each is written with
  // all that is below it. Depth is that of the tree: recursion is shallow.
  void emit(std::uint32_t root, std::uint32_t place, std::uint32_t depth) {
    GnSlots slots;
    gn_open_wide_node(bvh_.nodes.data(), forests_.data(), root, costs_, &weights_, keys_.data(), &slots);
    wide_.depth = std::max(wide_.depth, depth);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> inner;
    for (std::uint32_t slot = 0; slot < slots.count; ++slot) {
      const Node& node = bvh_.nodes[slots.node[slot]];
      std::uint32_t link = 0;
      if (slots.triangles[slot] == 0) {
        link = static_cast<std::uint32_t>(wide_.nodes.size());
        inner.emplace_back(slots.node[slot], link);
        wide_.nodes.push_back(empty_node());
      } else {
        link = add_leaf(slots.node[slot], slots.triangles[slot]);
      }
      WideNode& out = wide_.nodes[place];
      for (int k = 0; k < 3; ++k) {
        out.planes[2 * k][slot] = node.lo[k];
        out.planes[2 * k + 1][slot] = node.hi[k];
      }
      out.links[slot] = link;
    }
    for (const auto& [child, child_place] : inner) emit(child, child_place, depth + 1);
  }

  std::uint32_t add_leaf(std::uint32_t node, std::uint32_t count) {
    const auto place = static_cast<std::uint32_t>(wide_.places());
    const std::uint32_t first = gn_first_triangle(bvh_.nodes.data(), node);
    const std::uint32_t link = gn_leaf_link(place, count);
    wide_.leaves.resize(wide_.leaves.size() + std::size_t{gn_leaf_places(count)} * GN_TRIANGLE_WORDS);
    if (count >= GN_LONG_LEAF) wide_.leaves[std::size_t{place} * GN_TRIANGLE_WORDS] = count;
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t seat = gn_seat_in(leaf, i);
      const std::uint32_t number = bvh_.primitives[first + i];
      put_triangle(wide_, seat, triangles_[number]);
      wide_.leaves[gn_seat_word(seat) + 9 * gn_seat_stride(seat)] = number + GN_NUMBER;
    }
    return link;
  }

  const Bvh& bvh_;
  std::span<const GnTriangle> triangles_;
  GnCollapseCosts costs_;
  GnNodeValues weights_;
  std::vector<float> keys_;
  std::vector<std::uint32_t> children_first_;  // inner nodes
  std::vector<GnForest> forests_;
  WideBvh wide_;
};

double slot_area(const WideNode& node, std::uint32_t slot) {
  const auto extent = [&](int k) {
    return static_cast<double>(node.planes[2 * k + 1][slot]) - node.planes[2 * k][slot];
  };
  return extent(0) * (extent(1) + extent(2)) + extent(1) * extent(2);
}

double node_area(const WideNode& node) {
  WideNode whole = empty_node();
  for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
    for (int k = 0; k < 3; ++k) {
      whole.planes[2 * k][0] = std::min(whole.planes[2 * k][0], node.planes[2 * k][slot]);
      whole.planes[2 * k + 1][0] = std::max(whole.planes[2 * k + 1][0], node.planes[2 * k + 1][slot]);
    }
  }
  return slot_area(whole, 0);
}

}  // namespace

GnTriangle triangle_in(const WideBvh& wide, std::uint32_t seat) {
  float corners[9];
  for (std::uint32_t k = 0; k < 9; ++k)
    corners[k] = std::bit_cast<float>(wide.leaves[gn_seat_word(seat) + k * gn_seat_stride(seat)]);
  GnTriangle triangle;
  static_assert(sizeof triangle == sizeof corners);
  std::memcpy(&triangle, corners, sizeof corners);
  return triangle;
}

void put_triangle(WideBvh& wide, std::uint32_t seat, const GnTriangle& triangle) {
  float corners[9];
  std::memcpy(corners, &triangle, sizeof corners);
  for (std::uint32_t k = 0; k < 9; ++k)
    wide.leaves[gn_seat_word(seat) + k * gn_seat_stride(seat)] = std::bit_cast<std::uint32_t>(corners[k]);
}

void throw_leaf_too_large(std::uint32_t triangles) {
  throw Error(ErrorCode::kInvalidArgument, "a leaf of " + std::to_string(triangles) +
                                               " triangles is too large for a wide tree, which takes " +
                                               std::to_string(GN_MAX_WIDE_LEAF) +
                                               "; build with smaller leaves or trace the binary tree");
}

void check_slot_keys(std::span<const float> slot_keys, std::size_t nodes) {
  if (!slot_keys.empty() && slot_keys.size() != nodes) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(slot_keys.size()) + " slot keys for a tree of " +
                                                 std::to_string(nodes) + " nodes; give one a node or none");
  }
  const auto bad =
      std::find_if(slot_keys.begin(), slot_keys.end(), [](float key) { return std::isnan(key); });
  if (bad == slot_keys.end()) return;
  throw Error(ErrorCode::kInvalidArgument,
              "slot key " + std::to_string(bad - slot_keys.begin()) + " is NaN; keys must have an order");
}

void check_node_weights(std::span<const float> weights, std::size_t nodes) {
  if (!weights.empty() && weights.size() != nodes) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(weights.size()) + " weights for a tree of " +
                                                 std::to_string(nodes) + " nodes; give one a node or none");
  }
  const auto bad = std::find_if(weights.begin(), weights.end(),
                                [](float weight) { return !(weight >= 0.0F) || std::isinf(weight); });
  if (bad == weights.end()) return;
  throw Error(ErrorCode::kInvalidArgument, "weight " + std::to_string(bad - weights.begin()) +
                                               " of a node is " + std::to_string(*bad) +
                                               "; weights are finite and >= 0");
}

void CollapseOptions::check() const {
  check_cost("cost_node", cost_node);
  check_cost("cost_block", cost_block);
  if (triangles_per_task > kMostTrianglesPerTask) {
    throw Error(ErrorCode::kInvalidArgument, "collapse option triangles_per_task is " +
                                                 std::to_string(triangles_per_task) + "; it must lie in 0.." +
                                                 std::to_string(kMostTrianglesPerTask));
  }
}

WideBvh collapse_reference(const Bvh& bvh, std::span<const GnTriangle> triangles,
                           const CollapseOptions& options, std::span<const float> slot_keys,
                           std::span<const float> weights) {
  options.check();
  check_slot_keys(slot_keys, bvh.nodes.size());
  check_node_weights(weights, bvh.nodes.size());
  if (bvh.nodes.empty()) return {{empty_node()}, {}, 1};
  return Collapse(bvh, triangles, options, slot_keys, weights).run();
}

WideStats stats_of(const WideBvh& wide) {
  WideStats stats;
  const double root_area = node_area(wide.nodes[0]);
  const auto probability = [&](double area) { return root_area > 0.0 ? area / root_area : 1.0; };
  stats.expected_nodes = 1.0;
  std::uint64_t children = 0;
  std::uint64_t triangles = 0;
  for (const WideNode& node : wide.nodes) {
    for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
      const std::uint32_t link = node.links[slot];
      if (link == GN_NONE) continue;
      children += 1;
      if ((link & GN_LEAF_LINK) == 0) {
        stats.expected_nodes += probability(slot_area(node, slot));
      } else {
        const std::uint32_t count = gn_leaf_at(wide.leaves.data(), link).count;
        triangles += count;
        stats.blocks += gn_blocks_of(count);
        stats.expected_blocks += probability(slot_area(node, slot)) * gn_blocks_of(count);
      }
    }
  }
  stats.mean_children = static_cast<double>(children) / static_cast<double>(wide.nodes.size());
  if (stats.blocks > 0) stats.mean_block = static_cast<double>(triangles) / static_cast<double>(stats.blocks);
  stats.bytes = wide.nodes.size() * sizeof(WideNode) + wide.leaves.size() * sizeof(std::uint32_t);
  return stats;
}

std::string tree_hash(const WideBvh& wide) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  XXH3_64bits_update(&state, wide.nodes.data(), wide.nodes.size() * sizeof(WideNode));
  XXH3_64bits_update(&state, wide.leaves.data(), wide.leaves.size() * sizeof(std::uint32_t));
  if (wide.frame) XXH3_64bits_update(&state, &*wide.frame, sizeof(BoxFrame));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(XXH3_64bits_digest(&state)));
  return text;
}

}  // namespace gnomon
