#include "gnomon/plan/met_part.h"

#include <algorithm>

namespace gnomon {

namespace {

MetPart met_part_plain(const Bvh& bvh, SegmentSet& segments, std::uint32_t least) {
  struct Open {
    std::uint32_t node;    // of the whole tree
    std::uint32_t number;  // in `top`
    SegmentMask met;
  };
  MetPart part;
  part.top.nodes.resize(1);
  part.met.resize(1);
  part.met_counts.resize(1);
  std::vector<Open> open{{0, 0, {}}};
  segments.meet(box_of(bvh.nodes[0]), segments.all(), open.back().met);
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const std::uint32_t count = next.met.count();
    part.met[next.number] = next.met;
    part.met_counts[next.number] = count;
    Node node = bvh.nodes[next.node];
    if (node.count > 0 || count < least) {
      node.first = static_cast<std::uint32_t>(part.subtrees.size());
      node.count = 1;
      part.top.primitives.push_back(node.first);
      part.subtrees.push_back(next.node);
      part.counts.push_back(count);
      part.top.nodes[next.number] = node;
      continue;
    }
    const std::uint32_t below = node.first;
    node.first = static_cast<std::uint32_t>(part.top.nodes.size());
    part.top.nodes[next.number] = node;
    part.top.nodes.resize(part.top.nodes.size() + 2);
    part.met.resize(part.top.nodes.size());
    part.met_counts.resize(part.top.nodes.size());
    for (const std::uint32_t side : {1U, 0U}) {
      open.push_back({below + side, node.first + side, {}});
      segments.meet(box_of(bvh.nodes[below + side]), next.met, open.back().met);
    }
  }
  return part;
}

// The same code for machines that count bits and have wide vectors.
#if defined(__x86_64__)
[[gnu::target("avx2,popcnt"), gnu::flatten]] MetPart met_part_wide(const Bvh& bvh, SegmentSet& segments,
                                                                   std::uint32_t least) {
  return met_part_plain(bvh, segments, least);
}
#endif

}  // namespace

MetPart met_part(const Bvh& bvh, SegmentSet& segments, std::uint32_t least) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("popcnt") != 0;
  if (wide) return met_part_wide(bvh, segments, least);
#endif
  return met_part_plain(bvh, segments, least);
}

namespace {

// A subtree's pairs of nodes and its places in leaf order are neighbours (bvh.h): the range of both.
struct Extent {
  std::uint32_t first_node = 0;
  std::uint32_t last_node = 0;  // one past
  std::uint32_t first_place = 0;
  std::uint32_t last_place = 0;
};

Extent extent_of(const Bvh& bvh, std::uint32_t index) {
  Extent out;
  const Node* left = &bvh.nodes[index];
  const Node* right = left;
  if (left->count == 0) {
    out.first_node = left->first;
    out.last_node = right->first + 2;
  }
  while (left->count == 0) {
    out.first_node = left->first;
    left = &bvh.nodes[left->first];
  }
  while (right->count == 0) {
    out.last_node = right->first + 2;
    right = &bvh.nodes[right->first + 1];
  }
  out.first_place = left->first;
  out.last_place = right->first + right->count;
  return out;
}

class Grafter {
 public:
  Grafter(const Bvh& bvh, const MetPart& part, const Bvh& top)
      : bvh_(bvh), part_(part), top_(top), inner_(top.nodes.size()) {
    out_.bvh.nodes.resize(bvh.nodes.size());
    out_.bvh.primitives.resize(bvh.primitives.size());
    out_.numbers.resize(top.nodes.size());
    out_.below.resize(part.subtrees.size());
    for (const std::uint32_t subtree : part.subtrees) extents_.push_back(extent_of(bvh, subtree));
    count(0);
  }

  Grafted run() {
    write(0, 0, 0);
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t part_of(const Node& leaf) const { return top_.primitives[leaf.first]; }

  // As deep as the top.
  std::uint32_t count(std::uint32_t index) {
    const Node& node = top_.nodes[index];
    if (node.count > 0) {
      const Extent& extent = extents_[part_of(node)];
      return inner_[index] = (extent.last_node - extent.first_node) / 2;
    }
    return inner_[index] = count(node.first) + count(node.first + 1) + 1;
  }

  // splits: inner nodes to the left of the subtree.
  void write(std::uint32_t index, std::uint32_t number, std::uint32_t splits) {
    Node node = top_.nodes[index];
    out_.numbers[index] = number;
    if (node.count > 0) {
      copy(part_of(node), number, splits);
      return;
    }
    const std::uint32_t left = node.first;
    splits += inner_[left];
    node.first = 1 + 2 * splits;
    out_.bvh.nodes[number] = node;
    write(left, node.first, splits - inner_[left]);
    write(left + 1, node.first + 1, splits + 1);
  }

  void copy(std::uint32_t subtree, std::uint32_t number, std::uint32_t splits) {
    const Extent& extent = extents_[subtree];
    const std::uint32_t nodes = 1 + 2 * splits - extent.first_node;  // modulo 2^32: shifts go both ways
    const std::uint32_t places = place_ - extent.first_place;
    const auto moved = [&](Node node) {
      node.first += node.count > 0 ? places : nodes;
      return node;
    };
    out_.bvh.nodes[number] = moved(bvh_.nodes[part_.subtrees[subtree]]);
    for (std::uint32_t i = extent.first_node; i < extent.last_node; ++i)
      out_.bvh.nodes[i + nodes] = moved(bvh_.nodes[i]);
    std::copy(bvh_.primitives.begin() + extent.first_place, bvh_.primitives.begin() + extent.last_place,
              out_.bvh.primitives.begin() + place_);
    if (extent.first_node < extent.last_node)
      out_.below[subtree] = {extent.first_node + nodes, extent.last_node + nodes};
    place_ += extent.last_place - extent.first_place;
  }

  const Bvh& bvh_;
  const MetPart& part_;
  const Bvh& top_;
  std::vector<std::uint32_t> inner_;  // inner nodes below each of top's, itself counted
  std::vector<Extent> extents_;
  std::uint32_t place_ = 0;  // in leaf order, where the next leaf goes
  Grafted out_;
};

}  // namespace

Grafted graft(const Bvh& bvh, const MetPart& part, const Bvh& top) {
  return Grafter(bvh, part, top).run();
}

}  // namespace gnomon
