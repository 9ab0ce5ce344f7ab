// The plain tree taken over as three other programs take foreign trees, each into nodes of that program's
// form, and traced there: the same hits. Forms after
//   tinybvh, tiny_bvh.h, BVH::BVHNode: min, leftFirst, max, triCount, 32 bytes (Wald's); a leaf where
//   triCount > 0,
//     else children at leftFirst and leftFirst + 1; primIdx; verts, three float4 a triangle;
//   Embree 3, rtcBuildBVH(3): nodes made by createNode, linked by setNodeChildren, which hold their
//   children's boxes
//     (setNodeBounds), leaves of primitives by createLeaf: a tree of one's own types;
//   HIPRT 2, hiprt_types.h, hiprtBvhNode: 128 bytes, four slots of child index, child type (0 internal, 1
//   leaf),
//     child's box; all ones for an empty slot; a leaf's index is its one primitive.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "gnomon/tree/trace_reference.h"
#include "gnomon/tree/tree_export.h"
#include "plain_tree.h"
#include "tree_file_tools.h"

using namespace gnomon;
using namespace gnomon::test;
using namespace gnomon::test::plain;

namespace {

// tinybvh: nodes and indices as they are, corners padded to 16 bytes.
class TinyBvh {
 public:
  explicit TinyBvh(const FileBytes& bytes) {
    const Parts parts = parts_of(bytes);
    nodes_.resize(parts.node_count);
    std::memcpy(nodes_.data(), parts.nodes, 32 * nodes_.size());
    prim_idx_ = parts.indices;
    for (std::size_t i = 0; i < parts.corners.size(); ++i) {
      verts_.push_back(parts.corners[i]);
      if (i % 3 == 2) verts_.push_back(0.0F);
    }
  }

  [[nodiscard]] Found trace(const GnRay& ray) const {
    Found found;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
      const Node& node = nodes_.at(open.back());
      open.pop_back();
      if (!meets({node.min, node.max}, ray)) continue;
      for (std::uint32_t i = 0; i < node.tri_count; ++i) {
        const std::uint32_t primitive = prim_idx_.at(node.left_first + i);
        test_triangle(verts_.data() + 12 * std::size_t{primitive}, 4, primitive, ray, found);
      }
      if (node.tri_count == 0) open.insert(open.end(), {node.left_first, node.left_first + 1});
    }
    return found;
  }

 private:
  struct Node {
    std::array<float, 3> min;
    std::uint32_t left_first;
    std::array<float, 3> max;
    std::uint32_t tri_count;
  };
  static_assert(sizeof(Node) == 32);
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> prim_idx_;
  std::vector<float> verts_;
};

// Embree: the callbacks that a builder calls, called by a walk over the file's nodes.
class EmbreeTree {
 public:
  explicit EmbreeTree(const FileBytes& bytes) : parts_(parts_of(bytes)) {
    root_ = walk(0);
    root_box_ = Plain(parts_, 0).box;
  }

  [[nodiscard]] Found trace(const GnRay& ray) const {
    Found found;
    if (meets(root_box_, ray)) visit(*root_, ray, found);
    return found;
  }

 private:
  struct Node {
    std::vector<std::uint32_t> primitives;  // of a leaf
    std::array<std::unique_ptr<Node>, 2> children;
    std::array<Box, 2> bounds;
  };

  [[nodiscard]] std::unique_ptr<Node> walk(std::uint32_t number) const {
    const Plain plain(parts_, number);
    auto node = std::make_unique<Node>();
    for (std::uint32_t i = 0; i < plain.count; ++i)
      node->primitives.push_back(parts_.indices.at(plain.left_first + i));
    if (plain.count > 0) return node;
    for (std::uint32_t k = 0; k < 2; ++k) {
      node->children[k] = walk(plain.left_first + k);
      node->bounds[k] = Plain(parts_, plain.left_first + k).box;
    }
    return node;
  }

  void visit(const Node& node, const GnRay& ray, Found& found) const {
    for (const std::uint32_t primitive : node.primitives)
      test_triangle(parts_.corners.data() + 9 * std::size_t{primitive}, 3, primitive, ray, found);
    for (std::size_t k = 0; k < 2; ++k)
      if (node.children[k] && meets(node.bounds[k], ray)) visit(*node.children[k], ray, found);
  }

  Parts parts_;
  std::unique_ptr<Node> root_;
  Box root_box_{};
};

// HIPRT: the trees it takes have one primitive a leaf, so the file must, too.
class HiprtTree {
 public:
  explicit HiprtTree(const FileBytes& bytes) : parts_(parts_of(bytes)) {
    static_assert(sizeof(Node) == 128);
    const Plain root(parts_, 0);
    if (root.count == 0) {
      static_cast<void>(convert(root));
      return;
    }
    nodes_.push_back(empty());
    put(nodes_[0], 0, root);
  }

  [[nodiscard]] Found trace(const GnRay& ray) const {
    Found found;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
      const Node& node = nodes_.at(open.back());
      open.pop_back();
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t child = node.child_indices[k];
        if (child == kInvalid || !meets({node.child_min[k], node.child_max[k]}, ray)) continue;
        if (node.child_types[k] == kInternal) {
          open.push_back(child);
        } else {
          test_triangle(parts_.corners.data() + 9 * std::size_t{child}, 3, child, ray, found);
        }
      }
    }
    return found;
  }

 private:
  static constexpr std::uint32_t kInvalid = 0xffffffffU;
  static constexpr std::uint32_t kInternal = 0;
  static constexpr std::uint32_t kLeaf = 1;
  struct alignas(64) Node {
    std::array<std::uint32_t, 4> child_indices;
    std::array<std::uint32_t, 4> child_types;
    std::array<std::array<float, 3>, 4> child_min;
    std::array<std::array<float, 3>, 4> child_max;
  };

  static Node empty() {
    Node node{};
    node.child_indices.fill(kInvalid);
    return node;
  }

  void put(Node& node, std::size_t slot, const Plain& child) {
    node.child_min[slot] = child.box.lo;
    node.child_max[slot] = child.box.hi;
    node.child_types[slot] = child.count > 0 ? kLeaf : kInternal;
    REQUIRE(child.count <= 1);
    if (child.count == 1) node.child_indices[slot] = parts_.indices.at(child.left_first);
  }

  std::uint32_t convert(const Plain& plain) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(empty());
    for (std::uint32_t k = 0; k < 2; ++k) {
      const Plain child(parts_, plain.left_first + k);
      put(nodes_[number], k, child);
      if (child.count == 0) {
        const std::uint32_t below = convert(child);
        nodes_[number].child_indices[k] = below;
      }
    }
    return number;
  }

  Parts parts_;
  std::vector<Node> nodes_;
};

// The tree in that program's form finds what the library's reference finds. Where two triangles are as near
// as double precision tells, either will do.
template <typename Tree>
std::size_t check_hits(const KeptShape& shape) {
  CAPTURE(shape.name);
  const Bvh bvh = build_reference(shape.triangles, shape.options);
  const Tree tree(bvh2_bytes(bvh, shape.triangles));
  const auto rays = random_rays(4000, 71);
  const auto traced = trace_reference(bvh, shape.triangles, rays, false);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const GnHit& hit = traced.hits[i];
    const Found found = tree.trace(rays[i]);
    REQUIRE((found.primitive == GN_NONE) == (hit.primitive == GN_NONE));
    if (hit.primitive == GN_NONE) continue;
    ++hits;
    const double t = static_cast<double>(hit.t);
    REQUIRE(std::fabs(found.t - t) <= 1e-6 * std::max(1.0, std::fabs(t)));
    if (found.primitive != hit.primitive) {
      Found other;
      test_triangle(reinterpret_cast<const float*>(&shape.triangles[hit.primitive]), 3, hit.primitive,
                    rays[i], other);
      REQUIRE(std::fabs(found.t - other.t) <= 1e-12 * std::max(1.0, std::fabs(t)));
    }
  }
  return hits;
}

}  // namespace

TEST_CASE("taken over as tinybvh takes nodes, a plain tree gives the same hits") {
  std::size_t hits = 0;
  for (const KeptShape& shape : kept_shapes())
    if (!shape.triangles.empty()) hits += check_hits<TinyBvh>(shape);
  CHECK(hits > 1000);
}

TEST_CASE("taken over through the callbacks of Embree's builder, a plain tree gives the same hits") {
  std::size_t hits = 0;
  for (const KeptShape& shape : kept_shapes())
    if (!shape.triangles.empty()) hits += check_hits<EmbreeTree>(shape);
  CHECK(hits > 1000);
}

TEST_CASE("taken over as HIPRT takes trees of one triangle a leaf, a plain tree gives the same hits") {
  std::size_t hits = 0;
  for (KeptShape shape : kept_shapes()) {
    // The best builder's parts and published leaves hold more.
    if (shape.triangles.empty() || shape.options.builder == Builder::kBest ||
        shape.options.published_leaves.on)
      continue;
    shape.options.max_leaf_size = 1;
    hits += check_hits<HiprtTree>(shape);
  }
  CHECK(hits > 200);
}
