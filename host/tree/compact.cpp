#include "gnomon/tree/compact.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>

#include "gnomon/base/error.h"
#include "gnomon/shared/compact_math.h"
#include "gnomon/tree/box_frame.h"

namespace gnomon {
namespace {

class Compaction {
 public:
  explicit Compaction(const WideBvh& wide) : wide_(wide), first_in_block_(wide.blocks.size() + 1) {
    for (std::size_t block = 0; block < wide.blocks.size(); ++block) {
      const auto& primitives = wide.blocks[block].primitives;
      const auto filled =
          std::count_if(primitives, primitives + GN_WIDTH, [](auto p) { return p != GN_NONE; });
      first_in_block_[block + 1] = first_in_block_[block] + static_cast<std::uint32_t>(filled);
    }
    compact_.nodes.resize(wide.nodes.size());
    compact_.plain.resize(first_in_block_.back());
    compact_.depth = wide.depth;
  }

  CompactBvh run() {
    write(0, 0);
    share_corners();
    return std::move(compact_);
  }

 private:
  // Recursion as deep as the tree, which is shallow.
  void write(std::uint32_t from, std::uint32_t to) {
    const WideNode& node = wide_.nodes[from];
    std::uint32_t child_of[GN_WIDTH];
    gn_assign_slots(&node, child_of);
    CompactNode out;
    gn_fill_compact_node(&node, child_of, &out);
    const std::uint32_t block = gn_first_block(&node);
    if (block != GN_NONE) out.first_triangle = first_in_block_[block];
    std::uint32_t next_triangle = out.first_triangle;
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
    const std::uint32_t count = gn_link_triangles(link);
    if (count > GN_MAX_COMPACT_LEAF) throw_compact_leaf_too_large(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const TriangleBlock& block = wide_.blocks[gn_link_block(link) + i / GN_WIDTH];
      GnPlainTriangle& out = compact_.plain[place + i];
      for (int k = 0; k < 9; ++k) out.corners[k] = block.corners[k][i % GN_WIDTH];
      out.primitive = block.primitives[i % GN_WIDTH];
    }
    return place + count;
  }

  void share_corners() {
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> places;
    std::vector<GnIndexedTriangle> triangles(compact_.plain.size());
    std::vector<GnVertex> vertices;
    for (std::size_t i = 0; i < compact_.plain.size(); ++i) {
      triangles[i].primitive = compact_.plain[i].primitive;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        GnVertex vertex{};
        std::memcpy(&vertex, compact_.plain[i].corners + 3 * corner, sizeof vertex);
        std::array<std::uint32_t, 3> bits{};
        std::memcpy(bits.data(), &vertex, sizeof vertex);
        const auto [found, is_new] = places.try_emplace(bits, static_cast<std::uint32_t>(vertices.size()));
        if (is_new) vertices.push_back(vertex);
        triangles[i].corners[corner] = found->second;
      }
    }
    if (gn_sharing_pays(static_cast<std::uint32_t>(triangles.size()),
                        static_cast<std::uint32_t>(vertices.size())) == 0)
      return;
    compact_.triangles = std::move(triangles);
    compact_.vertices = std::move(vertices);
    compact_.plain.clear();
  }

  const WideBvh& wide_;
  std::vector<std::uint32_t> first_in_block_;
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
  return Compaction(wide).run();
}

std::string tree_hash(const CompactBvh& compact) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  const auto add = [&](const auto& values) {
    if (!values.empty()) XXH3_64bits_update(&state, values.data(), values.size() * sizeof values[0]);
  };
  add(compact.nodes);
  add(compact.triangles);
  add(compact.vertices);
  add(compact.plain);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(XXH3_64bits_digest(&state)));
  return text;
}

}  // namespace gnomon
