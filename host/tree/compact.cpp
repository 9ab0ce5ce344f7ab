#include "gnomon/tree/compact.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <numeric>

#include "gnomon/base/error.h"
#include "gnomon/shared/compact_math.h"
#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/regions.h"

namespace gnomon {
namespace {

class Compaction {
 public:
  explicit Compaction(const WideBvh& wide) : wide_(wide), counts_before_(wide.places() + 1) {
    std::size_t triangles = 0;
    for (const WideNode& node : wide.nodes) {
      for (const std::uint32_t link : node.links) {
        if (link == GN_NONE || !gn_is_leaf_link(link)) continue;
        const GnLeaf leaf = gn_leaf_at(wide.leaves.data(), link);
        triangles += leaf.count;
        if (leaf.first != gn_link_place(link)) counts_before_[leaf.first] = 1;
      }
    }
    std::partial_sum(counts_before_.begin(), counts_before_.end(), counts_before_.begin());
    compact_.nodes.resize(wide.nodes.size());
    first_of_.resize(wide.nodes.size());
    plain_.resize(triangles);
    compact_.depth = wide.depth;
  }

  CompactBvh run() {
    write(0, 0);
    pack_leaves();
    return std::move(compact_);
  }

 private:
  // Recursion as deep as the tree, which is shallow.
  void write(std::uint32_t from, std::uint32_t to) {
    const WideNode& node = wide_.nodes[from];
    std::uint32_t child_of[GN_WIDTH];
    gn_assign_slots(&node, child_of);
    CompactNode out;
    gn_fill_compact_node(&node, wide_.leaves.data(), child_of, &out);
    const std::uint32_t first = gn_first_place(&node);
    if (first != GN_NONE) first_of_[to] = first - counts_before_[first];
    std::uint32_t next_triangle = first_of_[to];
    std::uint32_t next_node = out.first_node;
    for (const std::uint32_t child : child_of) {
      if (child == GN_NONE) continue;
      const std::uint32_t link = node.links[child];
      if (gn_is_leaf_link(link)) {
        next_triangle = write_leaf(link, next_triangle);
      } else {
        write(link, next_node);
        next_node += 1;
      }
    }
    compact_.nodes[to] = out;
  }

  std::uint32_t write_leaf(std::uint32_t link, std::uint32_t place) {
    const GnLeaf leaf = gn_leaf_at(wide_.leaves.data(), link);
    if (leaf.count > GN_MAX_COMPACT_LEAF) throw_compact_leaf_too_large(leaf.count);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t seat = gn_seat_in(leaf, i);
      const GnTriangle triangle = triangle_in(wide_, seat);
      std::memcpy(plain_[place + i].corners, &triangle, sizeof triangle);
      plain_[place + i].number = number_in(wide_, seat);
    }
    return place + leaf.count;
  }

  void pack_leaves() {
    for (std::size_t index = 0; index < compact_.nodes.size(); ++index) {
      CompactNode& node = compact_.nodes[index];
      const std::uint32_t count = gn_leaf_triangles(node.counts);
      if (count == 0) continue;
      const GnPlainTriangle* triangles = plain_.data() + first_of_[index];
      std::vector<std::uint32_t> places = equal_corners(triangles, count);
      GnPackHead head;
      const std::uint32_t words = gn_measure_leaves(triangles, places.data(), count, &head);
      node.leaves = static_cast<std::uint32_t>(compact_.leaves.size());
      compact_.leaves.resize(compact_.leaves.size() + words);
      gn_write_leaves(triangles, places.data(), count, &head, compact_.leaves.data() + node.leaves);
    }
    compact_.leaves.push_back(0);
  }

  // For each corner the first that equals it.
  static std::vector<std::uint32_t> equal_corners(const GnPlainTriangle* triangles, std::uint32_t count) {
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> first_with;
    std::vector<std::uint32_t> first(std::size_t{3} * count);
    for (std::uint32_t corner = 0; corner < first.size(); ++corner) {
      std::array<std::uint32_t, 3> bits{};
      std::memcpy(bits.data(), triangles[corner / 3].corners + std::size_t{3} * (corner % 3), sizeof bits);
      first[corner] = first_with.try_emplace(bits, corner).first->second;
    }
    return first;
  }

  const WideBvh& wide_;
  std::vector<std::uint32_t> counts_before_;  // places before each that hold a long leaf's count instead
  std::vector<std::uint32_t> first_of_;       // the first triangle of each compact node
  std::vector<GnPlainTriangle> plain_;
  CompactBvh compact_;
};

}  // namespace

void throw_compact_leaf_too_large(std::uint32_t triangles) {
  throw Error(ErrorCode::kInvalidArgument, "a leaf of " + std::to_string(triangles) +
                                               " triangles is too large for a compact tree, which takes " +
                                               std::to_string(GN_MAX_COMPACT_LEAF) +
                                               "; build with smaller leaves or trace another flavour");
}

CompactBvh compact_reference(const WideBvh& wide) {
  refuse_frame(wide.frame, "the compact layout");
  refuse_regions(wide.regions, "the compact layout");
  return Compaction(wide).run();
}

std::string tree_hash(const CompactBvh& compact) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  const auto add = [&](const auto& values) {
    if (!values.empty()) XXH3_64bits_update(&state, values.data(), values.size() * sizeof values[0]);
  };
  add(compact.nodes);
  add(compact.leaves);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(XXH3_64bits_digest(&state)));
  return text;
}

}  // namespace gnomon
