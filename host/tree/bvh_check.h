// Whether a tree is what the builders promise: shape, numbering, leaf order and boxes. Not for its quality
// (stats_of). Feeds `validate`, file loading in doubt, and the builders' tests.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// A broken promise: which, in words with the numbers concerned, and the node it was found at (GN_NONE: no
// single one).
struct BvhFault {
  std::string what;
  std::uint32_t node = GN_NONE;
};

// The first promise that a tree over `triangles` (finite coordinates) breaks, or nothing. Any bytes may come
// in. In order: sizes (2 * leaves - 1 nodes, none without triangles); links (in range, every node reached
// once); primitives (each once); leaf ranges (a partition of the leaf order, left to right, none above
// max_leaf_size); boxes (no NaN, inside the parent's, exactly the union of what they hold, -0 equal to 0);
// numbering (the k-th inner node, by the place in leaf order where it splits, has its children at 1 + 2k and
// 2 + 2k); depth (at most median_depth + ceil(log2 n) + 1).
// Where options.builder is kBest triangles are in one leaf or more, at most GN_MOST_PARTS, in each once, up
// to kPartBudget more than there are; leaves' boxes lie within the union of what they hold, and a triangle's
// leaves hold all of it between them.
[[nodiscard]] std::optional<BvhFault> check_bvh(const Bvh& bvh, std::span<const GnTriangle> triangles,
                                                const BuildOptions& options);

}  // namespace gnomon
