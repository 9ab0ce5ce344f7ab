// The part of a tree that sampled segments meet, as a small tree of its own: reinsertion by sampled rays has
// nothing to do elsewhere. Not public. Feeds optimise_for_rays.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/plan/segment_set.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

[[nodiscard]] inline GnBox box_of(const Node& node) {
  GnBox box;
  gn_load_box(&node, &box);
  return box;
}

// Leaves of `top` stand for subtrees of the whole: `primitives` has, for each, its place in `subtrees`.
struct MetPart {
  Bvh top;
  std::vector<std::uint32_t> subtrees;  // nodes of the whole tree
  std::vector<std::uint32_t> counts;    // of segments that meet them
  std::vector<SegmentMask> met;         // what meets each node of `top`
  std::vector<std::uint32_t> met_counts;
};

// Nodes that `least` segments or more meet, and their children. The tree has nodes.
[[nodiscard]] MetPart met_part(const Bvh& bvh, SegmentSet& segments, std::uint32_t least);

// The whole tree again, with `top` (whose leaves are the part's) in the place of the part's.
struct Grafted {
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t last = 0;  // one past
  };
  Bvh bvh;
  std::vector<std::uint32_t> numbers;  // of top's nodes
  std::vector<Range> below;            // numbers of the nodes below each of the part's subtrees
};
[[nodiscard]] Grafted graft(const Bvh& bvh, const MetPart& part, const Bvh& top);

}  // namespace gnomon
