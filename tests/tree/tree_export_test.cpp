// The plain tree for other programs, read back by its documented layout alone.
#include "gnomon/tree/tree_export.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "gnomon/tree/trace_reference.h"
#include "tree_file_tools.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

struct PlainNode {
  float lo[3];
  std::uint32_t left_first;
  float hi[3];
  std::uint32_t count;
};

struct PlainTree {
  std::uint32_t repeats = 0;
  std::vector<PlainNode> nodes;
  std::vector<std::uint32_t> indices;
  std::vector<GnTriangle> triangles;
};

template <typename T>
std::vector<T> values(const FileBytes& bytes, std::size_t& at, std::size_t count) {
  std::vector<T> out(count);
  REQUIRE(at + count * sizeof(T) <= bytes.size());
  if (count > 0) std::memcpy(out.data(), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
  return out;
}

PlainTree parsed(const FileBytes& bytes) {
  REQUIRE(bytes.size() >= 32);
  REQUIRE(std::memcmp(bytes.data(), "gnombvh2", 8) == 0);
  REQUIRE(value_at<std::uint32_t>(bytes, 8) == 1);
  PlainTree tree;
  tree.repeats = value_at<std::uint32_t>(bytes, 24);
  REQUIRE(value_at<std::uint32_t>(bytes, 28) == 0);
  std::size_t at = 32;
  tree.nodes = values<PlainNode>(bytes, at, value_at<std::uint32_t>(bytes, 12));
  tree.indices = values<std::uint32_t>(bytes, at, value_at<std::uint32_t>(bytes, 16));
  tree.triangles = values<GnTriangle>(bytes, at, value_at<std::uint32_t>(bytes, 20));
  REQUIRE(at == bytes.size());
  return tree;
}

bool meets(const PlainNode& node, const GnRay& ray) {
  double enter = static_cast<double>(ray.tmin);
  double leave = static_cast<double>(ray.tmax);
  for (std::size_t k = 0; k < 3; ++k) {
    const double inverse = 1.0 / static_cast<double>(ray.direction[k]);
    const double a = (static_cast<double>(node.lo[k]) - static_cast<double>(ray.origin[k])) * inverse;
    const double b = (static_cast<double>(node.hi[k]) - static_cast<double>(ray.origin[k])) * inverse;
    enter = std::max(enter, std::min(a, b) - 1e-6);
    leave = std::min(leave, std::max(a, b) + 1e-6);
  }
  return enter <= leave;
}

// The triangles in the leaves whose boxes the ray meets.
std::set<std::uint32_t> candidates(const PlainTree& tree, const GnRay& ray) {
  std::set<std::uint32_t> found;
  std::vector<std::uint32_t> open;
  if (!tree.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const PlainNode& node = tree.nodes.at(open.back());
    open.pop_back();
    if (!meets(node, ray)) continue;
    for (std::uint32_t i = 0; i < node.count; ++i) found.insert(tree.indices.at(node.left_first + i));
    if (node.count == 0) open.insert(open.end(), {node.left_first, node.left_first + 1});
  }
  return found;
}

}  // namespace

TEST_CASE("a plain tree holds what the tree holds, numbered as other programs expect") {
  for (const KeptShape& shape : kept_shapes()) {
    CAPTURE(shape.name);
    const Bvh bvh = build_reference(shape.triangles, shape.options);
    const PlainTree tree = parsed(bvh2_bytes(bvh, shape.triangles));
    CHECK(tree.indices == bvh.primitives);
    CHECK(tree.repeats == (bvh.primitives.size() > shape.triangles.size() ? 1U : 0U));
    REQUIRE(tree.triangles.size() == shape.triangles.size());
    if (!shape.triangles.empty())
      CHECK(std::memcmp(tree.triangles.data(), shape.triangles.data(), 36 * tree.triangles.size()) == 0);
    if (bvh.nodes.empty()) {
      CHECK(tree.nodes.empty());
      continue;
    }
    REQUIRE(tree.nodes.size() == bvh.nodes.size() + 1);
    std::size_t indexed = 0;
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
      CAPTURE(i);
      const PlainNode& node = tree.nodes[i];
      indexed += node.count;
      if (i == 1 || node.count > 0) continue;
      REQUIRE(node.left_first > i);
      REQUIRE(node.left_first % 2 == 0);
      REQUIRE(node.left_first + 1 < tree.nodes.size());
    }
    CHECK(indexed == tree.indices.size());
  }
}

TEST_CASE("the best tree's parts are said to repeat") {
  const KeptShape best = kept_shapes()[6];
  const Bvh bvh = build_reference(best.triangles, best.options);
  REQUIRE(bvh.primitives.size() > best.triangles.size());
  CHECK(parsed(bvh2_bytes(bvh, best.triangles)).repeats == 1);
}

TEST_CASE("rays find in a plain tree the triangles that they hit in the tree") {
  for (const KeptShape& shape : kept_shapes()) {
    if (shape.triangles.empty()) continue;
    CAPTURE(shape.name);
    const Bvh bvh = build_reference(shape.triangles, shape.options);
    const PlainTree tree = parsed(bvh2_bytes(bvh, shape.triangles));
    const auto rays = random_rays(300, 33);
    const auto traced = trace_reference(bvh, shape.triangles, rays, false);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t hit = traced.hits[i].primitive;
      if (hit == GN_NONE) continue;
      ++hits;
      REQUIRE(candidates(tree, rays[i]).count(hit) == 1);
    }
    if (shape.triangles.size() > 2) CHECK(hits > 0);
  }
}
