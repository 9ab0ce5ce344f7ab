// Joining the leaves of a finished tree where one leaf costs less than the nodes that part it. Builders end
// by cost as they go; a tree that was split to single triangles and then optimised is ended here, at the
// least expected cost. Not for wide trees (wide.h), whose collapse joins leaves itself. Feeds gnomon/plan.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

struct MergeOptions {
  std::uint32_t max_leaf_size = 4;  // triangles of a joined leaf, 1..255; larger leaves stay as they are
  float cost_inner = 2.0F;          // of visiting an inner node: two boxes; (0, 1000]
  float cost_triangle = 1.2F;       // (0, 1000]

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// Of each node w . (dy dz, dx dz, dx dy).
[[nodiscard]] std::vector<float> face_measures(const Bvh& bvh, const std::array<float, 3>& face_weights);

// The tree of least cost that comes of `bvh` by making leaves of inner nodes, where a node is visited as
// often as `measures` says (one a node, any unit). Leaf order stays, nodes are numbered as builders number. A
// triangle whose parts (parts.h) meet in a joined leaf is held there once.
// kept: receives the measures of the nodes that stay, unless null. Throws Error{kInvalidArgument}: options,
// another number of measures than nodes.
[[nodiscard]] Bvh merge_leaves(const Bvh& bvh, std::span<const float> measures,
                               const MergeOptions& options = {}, std::vector<float>* kept = nullptr);

}  // namespace gnomon
