// The binary tree as a value: nodes and leaf order, nothing of the device. Feeds checks, file, wide layouts,
// tracers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/shared/box_frame.h"
#include "gnomon/shared/layout.h"
#include "gnomon/tree/build_options.h"

namespace gnomon {

using Node = GnNode;
using BoxFrame = GnBoxFrame;

// A bounding volume hierarchy over n triangles. Empty input gives no nodes at all.
// Inner nodes are numbered by the place in leaf order where they split, so a subtree's nodes are neighbours
// and the numbering depends on nothing but the tree's shape.
struct Bvh {
  std::vector<Node> nodes;                // root first; siblings adjacent
  std::vector<std::uint32_t> primitives;  // leaf order -> index in the caller's triangles
  std::optional<BoxFrame> frame{};        // boxes stand in this (box_frame.h); none: where triangles do
};

// What a tree looks like. Costs follow the surface area heuristic with the options' constants, relative to
// the root.
struct BvhStats {
  double sah_cost = 0.0;
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint32_t max_depth = 0;  // root alone is 0
  std::uint32_t largest_leaf = 0;
  double mean_leaf = 0.0;
};
[[nodiscard]] BvhStats stats_of(const Bvh& bvh, const BuildOptions& options);

// XXH3-64 of nodes and order, 16 lower-case hex digits: equal trees, equal bytes, equal hash.
[[nodiscard]] std::string tree_hash(const Bvh& bvh);

}  // namespace gnomon
