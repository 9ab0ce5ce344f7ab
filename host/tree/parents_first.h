// The order in which values go up or down a tree. Not public. Feeds merge_leaves, child orders.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// Nodes' numbers, each before its children's; the tree has nodes. Depth first: what is near in the order is
// near in memory too, which in large trees is most of the time.
inline std::vector<std::uint32_t> parents_first(const Bvh& bvh) {
  std::vector<std::uint32_t> order;
  order.reserve(bvh.nodes.size());
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    open.pop_back();
    order.push_back(index);
    const Node& node = bvh.nodes[index];
    if (node.count > 0) continue;
    open.push_back(node.first + 1);
    open.push_back(node.first);
  }
  return order;
}

}  // namespace gnomon
