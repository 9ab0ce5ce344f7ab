// The passes of parallel reinsertion in plain C++ (host/notes/best-builder.md) over whatever says what boxes
// cost: face weights (optimise.cpp) or sampled rays (gnomon/plan/optimise_for_rays.cpp). Not public. Feeds
// both.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "gnomon/shared/reinsert_math.h"
#include "gnomon/tree/optimise.h"

namespace gnomon {

inline bool is_inner_slot(const Node& node) {
  return node.count == 0;
}

// Costs: prepare(slots) is called whenever boxes have changed; of(slots, slot) is then a slot's cost,
// monotone under inclusion; find(slots, above, slot) the best place for that node (gn_find_move says which).
template <typename Costs>
class Optimiser {
 public:
  // All three must outlive it.
  Optimiser(const Bvh& bvh, const OptimiseOptions& options, Costs& costs)
      : bvh_(bvh), options_(options), costs_(costs) {
    load();
    join();
    costs_.prepare(slots_);
    units_ = units_of(costs_.of(slots_, GN_ROOT_SLOT));
    require_depth(depth());
  }

  Bvh run() {
    if (units_ > 0.0F) run_passes(*this, options_);
    return renumber();
  }

  TreeWeight weigh() {
    join();
    costs_.prepare(slots_);
    for (std::uint32_t slot = GN_ROOT_SLOT + 1; slot < slots_.size(); ++slot) {
      if (below_[gn_pair_near(above_.data(), slot)].changed != 0) settled_[slot] = false;
    }
    TreeWeight weight;
    weight.bins.resize(GN_MEASURE_BINS);
    for (std::uint32_t slot = GN_ROOT_SLOT; slot < slots_.size(); ++slot) {
      const float cost = costs_.of(slots_, slot);
      if (slot != GN_ROOT_SLOT) weight.bins[gn_cost_bin(cost)] += 1;
      if (is_inner_slot(slots_[slot])) weight.units += gn_cost_units(cost, units_);
    }
    weight.depth = depth();
    return weight;
  }

  std::uint32_t move(std::uint32_t floor) {
    moves_.clear();
    for (std::uint32_t slot = GN_ROOT_SLOT + 1; slot < slots_.size(); ++slot) {
      if (settled_[slot] || gn_cost_bin(costs_.of(slots_, slot)) < floor) continue;
      const GnMove found = costs_.find(slots_, above_, slot);
      settled_[slot] = options_.leave_settled && found.target == GN_NONE;
      if (found.target != GN_NONE) moves_.push_back(found);
    }
    settle();
    for (const GnMove& m : moves_) {
      const Node sibling = slots_[m.node ^ 1U];
      const Node target = slots_[m.target];
      put(m.parent, sibling);
      put(m.node ^ 1U, target);
      put(m.target, parent_of_pair(m.node));
      for (const std::uint32_t written : {m.parent, m.node, m.target})
        below_[written / 2].changed = GN_RELINKED;
    }
    return static_cast<std::uint32_t>(moves_.size());
  }

  void take_back() {
    for (const GnMove& m : moves_) {
      const Node sibling = slots_[m.parent];
      const Node target = slots_[m.node ^ 1U];
      put(m.target, target);
      put(m.node ^ 1U, sibling);
      put(m.parent, parent_of_pair(m.node));
    }
    join();
  }

 private:
  void load() {
    slots_.resize(bvh_.nodes.size() + 1);
    above_.resize(slots_.size() / 2 + 1);
    below_.resize(above_.size());
    settled_.resize(slots_.size());
    for (std::uint32_t i = 0; i < bvh_.nodes.size(); ++i) {
      Node node = bvh_.nodes[i];
      if (is_inner_slot(node)) {
        node.first += 1;
        above_[node.first / 2] = i + 1;
      } else {
        node.count = static_cast<std::uint32_t>(triangles_of(node).size());
      }
      slots_[i + 1] = node;
    }
  }

  // Of a leaf, each once. count may be that of all or of the different ones.
  [[nodiscard]] std::vector<std::uint32_t> triangles_of(const Node& leaf) const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t at = leaf.first, seen = 0; seen < leaf.count; ++at) {
      const std::uint32_t primitive = bvh_.primitives[at];
      const bool known = std::find(out.begin(), out.end(), primitive) != out.end();
      if (!known) out.push_back(primitive);
      seen += known && loaded_ ? 0 : 1;
    }
    return out;
  }

  // Slots of inner nodes, parents before children, the left one's subtree first.
  [[nodiscard]] std::vector<std::uint32_t> inner_from_the_root() const {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> open{GN_ROOT_SLOT};
    while (!open.empty()) {
      const std::uint32_t slot = open.back();
      open.pop_back();
      if (!is_inner_slot(slots_[slot])) continue;
      order.push_back(slot);
      open.push_back(slots_[slot].first + 1);
      open.push_back(slots_[slot].first);
    }
    return order;
  }

  void join() {
    loaded_ = true;
    const std::vector<std::uint32_t> order = inner_from_the_root();
    for (auto slot = order.rbegin(); slot != order.rend(); ++slot) {
      Node& node = slots_[*slot];
      const Node& left = slots_[node.first];
      const Node& right = slots_[node.first + 1];
      for (int k = 0; k < 3; ++k) {
        node.lo[k] = gn_min(left.lo[k], right.lo[k]);
        node.hi[k] = gn_max(left.hi[k], right.hi[k]);
      }
      const GnBelow l = below_of(left);
      const GnBelow r = below_of(right);
      GnBelow& own = below_[node.first / 2];
      const bool changed = own.changed == GN_RELINKED || l.changed != 0 || r.changed != 0;
      own = {l.inner + r.inner + 1, l.triangles + r.triangles, std::max(l.height, r.height) + 1,
             std::uint32_t{changed}};
    }
  }

  [[nodiscard]] GnBelow below_of(const Node& node) const {
    return is_inner_slot(node) ? below_[node.first / 2] : GnBelow{0, node.count, 0, 0};
  }

  [[nodiscard]] std::uint32_t depth() const { return below_of(slots_[GN_ROOT_SLOT]).height; }

  // Leaves the moves that are made.
  void settle() {
    std::vector<std::uint32_t> gains(slots_.size());
    std::vector<std::uint32_t> owners(slots_.size());
    std::vector<float> moving(slots_.size());
    const auto holds = [](const std::vector<std::uint32_t>& claims, const GnMove& m, std::uint32_t value) {
      bool all = true;
      for (std::uint32_t k = 0; k < 4; ++k) all = all && claims[gn_claimed_slot(&m, k)] == value;
      return all;
    };
    const auto bid = [](std::vector<std::uint32_t>& claims, const GnMove& m, std::uint32_t value) {
      for (std::uint32_t k = 0; k < 4; ++k) {
        std::uint32_t& claim = claims[gn_claimed_slot(&m, k)];
        claim = std::max(claim, value);
      }
    };
    for (const GnMove& m : moves_) bid(gains, m, gn_bits_of(m.gain));
    std::erase_if(moves_, [&](const GnMove& m) { return !holds(gains, m, gn_bits_of(m.gain)); });
    for (const GnMove& m : moves_) bid(owners, m, m.node);
    std::erase_if(moves_, [&](const GnMove& m) { return !holds(owners, m, m.node); });
    for (const GnMove& m : moves_) moving[m.node] = m.gain;
    std::erase_if(moves_, [&](const GnMove& m) {
      bool gives_way = false;
      for (std::uint32_t slot = above_[m.target / 2]; slot != m.pivot; slot = above_[slot / 2])
        gives_way = gives_way || (moving[slot] > 0.0F && gn_gives_way(&m, slot, moving[slot]) != 0);
      return gives_way;
    });
  }

  void put(std::uint32_t slot, const Node& node) {
    slots_[slot] = node;
    if (is_inner_slot(node)) above_[node.first / 2] = slot;
  }

  // Its box is worked out later.
  static Node parent_of_pair(std::uint32_t slot) {
    Node node{};
    node.first = slot & ~1U;
    return node;
  }

  [[nodiscard]] Bvh renumber() const {
    Bvh out;
    out.nodes.resize(bvh_.nodes.size());
    out.frame = bvh_.frame;
    write(out, GN_ROOT_SLOT, 0, 0);
    return out;
  }

  // splits: inner nodes to the left of the subtree. Depth is bounded: recursion is shallow.
  void write(Bvh& out, std::uint32_t slot, std::uint32_t number, std::uint32_t splits) const {
    Node node = slots_[slot];
    if (is_inner_slot(node)) {
      const std::uint32_t left = node.first;
      splits += below_of(slots_[left]).inner;
      node.first = 1 + 2 * splits;
      out.nodes[number] = node;
      write(out, left, node.first, splits - below_of(slots_[left]).inner);
      write(out, left + 1, node.first + 1, splits + 1);
    } else {
      const std::vector<std::uint32_t> triangles = triangles_of(node);
      node.first = static_cast<std::uint32_t>(out.primitives.size());
      out.nodes[number] = node;
      out.primitives.insert(out.primitives.end(), triangles.begin(), triangles.end());
    }
  }

  const Bvh& bvh_;
  const OptimiseOptions& options_;
  Costs& costs_;
  float units_ = 0.0F;
  bool loaded_ = false;  // leaves' counts are of different triangles
  std::vector<Node> slots_;
  std::vector<std::uint32_t> above_;
  std::vector<GnBelow> below_;
  std::vector<bool> settled_;  // one a slot
  std::vector<GnMove> moves_;
};

}  // namespace gnomon
