// The wide tree as a value: a binary tree collapsed to eight children a node and leaves in blocks of up to
// eight triangles, for traversal on CPUs. Not for building the binary tree. Feeds the wide tracer's
// reference, tests, statistics.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/shared/region.h"
#include "gnomon/shared/wide_layout.h"
#include "gnomon/tree/bvh.h"
#include "gnomon/tree/bvh_check.h"

namespace gnomon {

using WideNode = GnWideNode;

// What a step costs, in any unit: the collapse weighs nodes against blocks with these.
struct CollapseOptions {
  float cost_node = 1.0F;   // (0, 1000]
  float cost_block = 1.0F;  // of up to eight triangles; (0, 1000]

  // How the device works, never what it makes: 0 asks the device.
  std::uint32_t triangles_per_task = 0;  // of a subtree that one work-item writes; up to 1048576

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// An empty scene has one node without children. The root is node 0.
struct WideBvh {
  std::vector<WideNode> nodes;
  std::vector<std::uint32_t> leaves;  // places of GN_TRIANGLE_WORDS words (gnomon/shared/wide_layout.h)
  std::uint32_t depth = 0;            // nodes on the longest way from the root to a leaf
  std::optional<BoxFrame> frame{};    // Bvh's
  std::vector<GnRegion> regions{};    // that have trees of their own behind this one (regions.h)
  [[nodiscard]] std::size_t places() const { return leaves.size() / GN_TRIANGLE_WORDS; }
};

// The corners and the number of the triangle in a seat (gn_seat_in), which must be one of the tree's.
[[nodiscard]] GnTriangle triangle_in(const WideBvh& wide, std::uint32_t seat);
[[nodiscard]] inline std::uint32_t number_in(const WideBvh& wide, std::uint32_t seat) {
  return gn_number_at(wide.leaves.data(), seat);
}
void put_triangle(WideBvh& wide, std::uint32_t seat, const GnTriangle& triangle);

// Leaves of the binary tree may hold up to GN_MAX_WIDE_LEAF triangles; others make it throw
// Error{kInvalidArgument}. Collapses with the least expected cost under the surface area heuristic (Ylitie,
// Karras, Laine 2017). Same bytes as the device's.
// A node's slots are in order of how likely what they hold stops rays (gn_slot_key), or of `slot_keys`, one a
// node of `bvh` (gnomon/plan/child_order.h): any hit looks at the last one first. What is expected is by
// areas, or by `weights`, one a node: how likely rays meet its box. Throws Error{kInvalidArgument} also for
// another number of keys or weights, a key that is NaN, a weight that is not finite and >= 0.
[[nodiscard]] WideBvh collapse_reference(const Bvh& bvh, std::span<const GnTriangle> triangles,
                                         const CollapseOptions& options = {},
                                         std::span<const float> slot_keys = {},
                                         std::span<const float> weights = {});

// Throws as collapse_reference for keys of a tree of so many nodes; none are fine.
void check_slot_keys(std::span<const float> slot_keys, std::size_t nodes);
void check_node_weights(std::span<const float> weights, std::size_t nodes);

[[noreturn]] void throw_leaf_too_large(std::uint32_t triangles);

// What a wide tree looks like; expected numbers are those of a ray that meets the root's box, under the
// surface area heuristic.
struct WideStats {
  double expected_nodes = 0.0;
  double expected_blocks = 0.0;
  double mean_children = 0.0;  // of 8
  double mean_block = 0.0;     // triangles in a block, of 8
  std::uint64_t blocks = 0;
  std::uint64_t bytes = 0;  // nodes and leaves
};
[[nodiscard]] WideStats stats_of(const WideBvh& wide);

// The first broken promise, or nothing: links in range and each node and place reached once, boxes that hold
// their triangles and lie inside the parent's, every triangle once with its corners, empty slots inverted and
// last, depth. Any bytes may come in. Not the order of slots, which is free.
// Where triangles may be in several leaves (Builder::kBest), these need only hold all of one between them.
enum class Repeats { kNone, kAllowed };
[[nodiscard]] std::optional<BvhFault> check_wide(const WideBvh& wide, std::span<const GnTriangle> triangles,
                                                 Repeats repeats = Repeats::kNone);

// XXH3-64 of nodes and leaves, 16 hex digits.
[[nodiscard]] std::string tree_hash(const WideBvh& wide);

}  // namespace gnomon
