#include "gnomon/tree/bvh.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace gnomon {

namespace {

double half_area(const Node& node) {
  const double dx = static_cast<double>(node.hi[0]) - node.lo[0];
  const double dy = static_cast<double>(node.hi[1]) - node.lo[1];
  const double dz = static_cast<double>(node.hi[2]) - node.lo[2];
  return dx * dy + dy * dz + dz * dx;
}

}  // namespace

BvhStats stats_of(const Bvh& bvh, const BuildOptions& options) {
  BvhStats stats;
  if (bvh.nodes.empty()) return stats;
  stats.nodes = bvh.nodes.size();
  const double root_area = half_area(bvh.nodes[0]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0U, 0U}};
  while (!open.empty()) {
    const auto [index, depth] = open.back();
    open.pop_back();
    const Node& node = bvh.nodes[index];
    // A flat or single-point scene has no area: every ray that meets the root meets every node.
    const double probability = root_area > 0.0 ? half_area(node) / root_area : 1.0;
    stats.max_depth = std::max(stats.max_depth, depth);
    if (node.count > 0) {
      stats.leaves += 1;
      stats.largest_leaf = std::max(stats.largest_leaf, node.count);
      stats.mean_leaf += node.count;
      stats.sah_cost += probability * static_cast<double>(options.cost_triangle) * node.count;
    } else {
      stats.sah_cost += probability * static_cast<double>(options.cost_traversal);
      open.emplace_back(node.first, depth + 1);
      open.emplace_back(node.first + 1, depth + 1);
    }
  }
  stats.mean_leaf /= static_cast<double>(stats.leaves);
  return stats;
}

std::string tree_hash(const Bvh& bvh) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  XXH3_64bits_reset(state.get());
  XXH3_64bits_update(state.get(), bvh.nodes.data(), bvh.nodes.size() * sizeof(Node));
  XXH3_64bits_update(state.get(), bvh.primitives.data(), bvh.primitives.size() * sizeof(std::uint32_t));
  if (bvh.frame) XXH3_64bits_update(state.get(), &*bvh.frame, sizeof(BoxFrame));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(XXH3_64bits_digest(state.get())));
  return text;
}

}  // namespace gnomon
