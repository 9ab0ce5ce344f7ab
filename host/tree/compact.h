// The compact tree as a value: the wide tree with quantised boxes and packed triangles, for traversal on
// devices where memory traffic decides. Not for building or collapsing. Feeds the device conversion's tests,
// statistics.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/shared/compact_layout.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/wide.h"

namespace gnomon {

using CompactNode = GnCompactNode;

// The root is node 0; an empty scene has it without children.
struct CompactBvh {
  std::vector<CompactNode> nodes;
  // The triangles (gnomon/shared/packed_leaves.h), in order of nodes, and a word of 0 behind.
  std::vector<std::uint32_t> leaves;
  std::uint32_t depth = 0;  // nodes on the longest way from the root to a leaf
  // Of all that traversal reads.
  [[nodiscard]] std::uint64_t bytes() const {
    return nodes.size() * sizeof(CompactNode) + leaves.size() * sizeof(std::uint32_t);
  }
};

// Throws Error{kInvalidArgument} for a leaf of more than GN_MAX_COMPACT_LEAF triangles. Same bytes as the
// device's.
[[nodiscard]] CompactBvh compact_reference(const WideBvh& wide);

[[noreturn]] void throw_compact_leaf_too_large(std::uint32_t triangles);

// The first broken promise, or nothing: nodes in range and each reached once; leaves that follow each other
// in order of nodes and take the fewest words they can; boxes, as traversal computes them, that hold every
// triangle below; every triangle once with its corners; depth. Any bytes may come in.
[[nodiscard]] std::optional<BvhFault> check_compact(const CompactBvh& compact,
                                                    std::span<const GnTriangle> triangles);

// XXH3-64 of nodes and leaves, 16 hex digits.
[[nodiscard]] std::string tree_hash(const CompactBvh& compact);

}  // namespace gnomon
