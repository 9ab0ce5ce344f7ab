// The order in which values go up or down a tree. Not public. Feeds merge_leaves, child orders.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// Nodes' numbers, each before its children's; the tree has nodes.
inline std::vector<std::uint32_t> parents_first(const Bvh& bvh) {
  std::vector<std::uint32_t> order{0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Node& node = bvh.nodes[order[i]];
    if (node.count > 0) continue;
    order.push_back(node.first);
    order.push_back(node.first + 1);
  }
  return order;
}

}  // namespace gnomon
