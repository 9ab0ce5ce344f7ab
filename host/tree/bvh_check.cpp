#include "gnomon/tree/bvh_check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/cover.h"
#include "gnomon/tree/parts.h"

namespace gnomon {

namespace {

using MaybeFault = std::optional<BvhFault>;

BvhFault fault(std::string what, std::size_t node = GN_NONE) {
  return {std::move(what), static_cast<std::uint32_t>(node)};
}

std::string text(std::uint64_t number) {
  return std::to_string(number);
}

// The tree in the order a left-to-right descent meets it; valid once the links are.
struct Walk {
  std::vector<std::uint32_t> order;  // parents before children, left before right
  std::vector<std::uint32_t> depth;  // by node
};

// Whether triangles may be in several leaves.
bool has_parts(const BuildOptions& options) {
  return options.builder == Builder::kBest;
}

MaybeFault check_sizes(const Bvh& bvh, std::span<const GnTriangle> triangles, const BuildOptions& options) {
  const std::uint64_t most =
      has_parts(options) ? most_parts(triangles.size(), kPartBudget) : triangles.size();
  if (bvh.primitives.size() < triangles.size() || bvh.primitives.size() > most) {
    return fault("sizes: " + text(bvh.primitives.size()) + " primitives for " + text(triangles.size()) +
                 " triangles");
  }
  if (bvh.nodes.empty() != triangles.empty()) {
    return fault("sizes: " + text(bvh.nodes.size()) + " nodes for " + text(triangles.size()) + " triangles");
  }
  if (bvh.nodes.empty()) return std::nullopt;
  const auto is_leaf = [](const Node& node) { return node.count > 0; };
  const auto leaves = static_cast<std::uint64_t>(std::count_if(bvh.nodes.begin(), bvh.nodes.end(), is_leaf));
  if (bvh.nodes.size() + 1 != 2 * leaves) {
    return fault("node count: " + text(bvh.nodes.size()) + " nodes for " + text(leaves) + " leaves");
  }
  return std::nullopt;
}

MaybeFault check_links(const Bvh& bvh, Walk& walk) {
  const std::size_t size = bvh.nodes.size();
  std::vector<char> seen(size, 0);
  std::vector<std::uint32_t> open{0};
  walk.depth.assign(size, 0);
  seen[0] = 1;
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    open.pop_back();
    walk.order.push_back(index);
    const Node& node = bvh.nodes[index];
    if (node.count > 0) continue;
    const std::uint64_t left = node.first;
    if (left + 1 >= size)
      return fault("links: children at " + text(left) + " of " + text(size) + " nodes", index);
    for (const std::uint64_t child : {left + 1, left}) {
      if (seen[child] != 0)
        return fault("links: node " + text(child) + " is referenced twice or is the root", index);
      seen[child] = 1;
      walk.depth[child] = walk.depth[index] + 1;
      open.push_back(static_cast<std::uint32_t>(child));
    }
  }
  if (walk.order.size() != size) {
    const auto lost = std::find(seen.begin(), seen.end(), 0) - seen.begin();
    return fault("links: node never referenced", static_cast<std::size_t>(lost));
  }
  return std::nullopt;
}

MaybeFault check_primitives(const Bvh& bvh, std::size_t triangles, const BuildOptions& options) {
  std::vector<std::uint8_t> seen(triangles, 0);
  for (const std::uint32_t primitive : bvh.primitives) {
    if (primitive >= seen.size()) return fault("primitives: index " + text(primitive) + " is out of range");
    if (seen[primitive] != 0 && !has_parts(options))
      return fault("primitives: triangle " + text(primitive) + " appears twice");
    // Also what keeps check_cover's work within bounds, whoever made the tree.
    if (seen[primitive] == GN_MOST_PARTS)
      return fault("primitives: triangle " + text(primitive) + " appears more than " + text(GN_MOST_PARTS) +
                   " times");
    ++seen[primitive];
  }
  const auto lost = std::find(seen.begin(), seen.end(), 0);
  if (lost == seen.end()) return std::nullopt;
  return fault("primitives: triangle " + text(static_cast<std::uint64_t>(lost - seen.begin())) +
               " is in no leaf");
}

// A triangle once in a leaf. The leaf ranges are known to be a partition.
MaybeFault check_repeats(const Bvh& bvh) {
  for (std::size_t index = 0; index < bvh.nodes.size(); ++index) {
    const Node& node = bvh.nodes[index];
    if (node.count == 0) continue;
    std::vector<std::uint32_t> held(bvh.primitives.begin() + node.first,
                                    bvh.primitives.begin() + node.first + node.count);
    std::sort(held.begin(), held.end());
    const auto twice = std::adjacent_find(held.begin(), held.end());
    if (twice != held.end())
      return fault("primitives: a leaf holds triangle " + text(*twice) + " twice", index);
  }
  return std::nullopt;
}

MaybeFault check_cover(const Bvh& bvh, std::span<const GnTriangle> triangles) {
  TriangleBoxes boxes(triangles.size());
  for (const Node& node : bvh.nodes) {
    for (std::uint32_t i = 0; i < node.count; ++i) boxes.add(bvh.primitives[node.first + i], node);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!boxes_cover(triangles[i], boxes.of(i)))
      return fault("cover: triangle " + text(i) + " is not wholly in the leaves that hold it");
  }
  return std::nullopt;
}

MaybeFault check_leaves(const Bvh& bvh, const Walk& walk, const BuildOptions& options) {
  std::uint64_t next = 0;
  for (const std::uint32_t index : walk.order) {
    const Node& node = bvh.nodes[index];
    if (node.count == 0) continue;
    if (node.first != next) {
      return fault("leaf ranges: starts at " + text(node.first) + " instead of " + text(next), index);
    }
    next += node.count;
    if (next > bvh.primitives.size()) {
      return fault("leaf ranges: ends at " + text(next) + " of " + text(bvh.primitives.size()), index);
    }
    // The published rule makes leaves of nodes it cannot divide, however large.
    if (!options.published_leaves.on && node.count > options.max_leaf_size) {
      return fault("leaf size: " + text(node.count) + " above " + text(options.max_leaf_size), index);
    }
  }
  if (next != bvh.primitives.size()) {
    return fault("leaf ranges: cover " + text(next) + " of " + text(bvh.primitives.size()) + " triangles");
  }
  return std::nullopt;
}

struct Box {
  float lo[3];
  float hi[3];
};

void extend(Box& box, const float lo[3], const float hi[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], hi[axis]);
  }
}

// The smallest box around what a node holds: its triangles, or its two children's boxes.
Box union_of(const Bvh& bvh, const Node& node, std::span<const GnTriangle> triangles) {
  Box box{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  if (node.count == 0) {
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      extend(box, bvh.nodes[child].lo, bvh.nodes[child].hi);
    }
  }
  for (std::uint32_t i = 0; i < node.count; ++i) {
    const GnTriangle& triangle = triangles[bvh.primitives[node.first + i]];
    for (const float* corner : {triangle.v0, triangle.v1, triangle.v2}) extend(box, corner, corner);
  }
  return box;
}

bool contains(const Node& outer, const Node& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.lo[axis] < outer.lo[axis] || inner.hi[axis] > outer.hi[axis]) return false;
  }
  return true;
}

MaybeFault check_boxes(const Bvh& bvh, const Walk& walk, std::span<const GnTriangle> triangles,
                       const BuildOptions& options) {
  for (const std::uint32_t index : walk.order) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isnan(bvh.nodes[index].lo[axis]) || std::isnan(bvh.nodes[index].hi[axis])) {
        return fault("box: NaN", index);
      }
    }
  }
  for (const std::uint32_t index : walk.order) {
    const Node& node = bvh.nodes[index];
    if (node.count > 0) continue;
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      if (!contains(node, bvh.nodes[child])) return fault("box: reaches beyond its parent's", child);
    }
  }
  for (const std::uint32_t index : walk.order) {
    const Node& node = bvh.nodes[index];
    const Box box = union_of(bvh, node, triangles);
    const bool within = has_parts(options) && node.count > 0;
    for (int axis = 0; axis < 3; ++axis) {
      const bool exact = node.lo[axis] == box.lo[axis] && node.hi[axis] == box.hi[axis];
      if (!(exact || (within && node.lo[axis] >= box.lo[axis] && node.hi[axis] <= box.hi[axis]))) {
        return fault("box: not the union of what it holds, axis " + text(static_cast<unsigned>(axis)), index);
      }
    }
  }
  return std::nullopt;
}

// An inner node splits at the first triangle of its right child. The leaf ranges are known to be a partition.
MaybeFault check_numbering(const Bvh& bvh, const Walk& walk) {
  std::vector<std::uint32_t> start(bvh.nodes.size());  // first place in leaf order under each node
  std::vector<std::pair<std::uint32_t, std::uint32_t>> splits;
  for (auto index = walk.order.rbegin(); index != walk.order.rend(); ++index) {
    const Node& node = bvh.nodes[*index];
    start[*index] = node.count > 0 ? node.first : start[node.first];
    if (node.count == 0) splits.emplace_back(start[node.first + 1], *index);
  }
  std::sort(splits.begin(), splits.end());
  for (std::size_t k = 0; k < splits.size(); ++k) {
    const std::uint32_t index = splits[k].second;
    if (bvh.nodes[index].first != 1 + 2 * k) {
      return fault(
          "numbering: children at " + text(bvh.nodes[index].first) + " instead of " + text(1 + 2 * k), index);
    }
  }
  return std::nullopt;
}

MaybeFault check_depth(const Bvh& bvh, const Walk& walk, std::size_t triangles, const BuildOptions& options) {
  const auto halvings =
      static_cast<std::uint32_t>(std::bit_width(bvh.primitives.size() - 1));  // ceil(log2(n))
  const std::uint32_t limit = has_parts(options)            ? most_depth_of_best(options, triangles)
                              : options.published_leaves.on ? options.published_leaves.max_depth + 1
                                                            : options.median_depth + halvings + 1;
  const auto deepest = std::max_element(walk.depth.begin(), walk.depth.end());
  if (*deepest <= limit) return std::nullopt;
  return fault("depth: " + text(*deepest) + " above " + text(limit),
               static_cast<std::size_t>(deepest - walk.depth.begin()));
}

}  // namespace

std::optional<BvhFault> check_bvh(const Bvh& bvh, std::span<const GnTriangle> triangles,
                                  const BuildOptions& options) {
  if (bvh.frame) {
    if (const auto wrong = fault_of(*bvh.frame, triangles)) return fault("frame: " + *wrong);
    return check_bvh({bvh.nodes, bvh.primitives}, turned(triangles, *bvh.frame), options);
  }
  if (MaybeFault found = check_sizes(bvh, triangles, options)) return found;
  if (triangles.empty()) return std::nullopt;
  Walk walk;
  if (MaybeFault found = check_links(bvh, walk)) return found;
  if (MaybeFault found = check_primitives(bvh, triangles.size(), options)) return found;
  if (MaybeFault found = check_leaves(bvh, walk, options)) return found;
  if (MaybeFault found = check_boxes(bvh, walk, triangles, options)) return found;
  if (MaybeFault found = check_numbering(bvh, walk)) return found;
  if (MaybeFault found = check_depth(bvh, walk, triangles.size(), options)) return found;
  if (!has_parts(options)) return std::nullopt;
  if (MaybeFault found = check_repeats(bvh)) return found;
  return check_cover(bvh, triangles);
}

}  // namespace gnomon
