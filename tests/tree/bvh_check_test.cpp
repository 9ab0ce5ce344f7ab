// Every promise of a tree, broken by hand: the check names it. Trees come from the smallest builder that
// keeps them all.
#include "gnomon/tree/bvh_check.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::check_bvh;
using gnomon::Node;
using Triangles = std::vector<GnTriangle>;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Triangles random_triangles(std::size_t count) {
  std::mt19937_64 engine(31);
  Triangles triangles(count);
  for (GnTriangle& triangle : triangles) {
    for (float* corner : {triangle.v0, triangle.v1, triangle.v2}) {
      for (int axis = 0; axis < 3; ++axis) corner[axis] = static_cast<float>(engine() % 1000) - 500.0F;
    }
  }
  return triangles;
}

BuildOptions leaves_of(std::uint32_t size) {
  BuildOptions options;
  options.max_leaf_size = size;
  return options;
}

// Halves the triangles in their given order; with `lopsided` it splits off a single leaf each time.
struct Builder {
  const Triangles& triangles;
  std::uint32_t leaf_size;
  bool lopsided;
  Bvh bvh;

  [[nodiscard]] std::uint32_t left_of(std::uint32_t count) const { return lopsided ? leaf_size : count / 2; }

  [[nodiscard]] std::uint32_t inner_nodes(std::uint32_t count) const {
    if (count <= leaf_size) return 0;
    return 1 + inner_nodes(left_of(count)) + inner_nodes(count - left_of(count));
  }

  // Fills the node over [begin, begin + count), before which `splits` nodes split.
  void place(std::uint32_t index, std::uint32_t begin, std::uint32_t count, std::uint32_t splits) {
    Node node{{INFINITY, INFINITY, INFINITY}, begin, {-INFINITY, -INFINITY, -INFINITY}, count};
    for (std::uint32_t i = begin; i < begin + count; ++i) {
      const GnTriangle& triangle = triangles[bvh.primitives[i]];
      for (const float* corner : {triangle.v0, triangle.v1, triangle.v2}) {
        for (int axis = 0; axis < 3; ++axis) {
          node.lo[axis] = std::min(node.lo[axis], corner[axis]);
          node.hi[axis] = std::max(node.hi[axis], corner[axis]);
        }
      }
    }
    if (count > leaf_size) {
      const std::uint32_t left = left_of(count);
      const std::uint32_t rank = splits + inner_nodes(left);
      node.first = 1 + 2 * rank;
      node.count = 0;
      place(node.first, begin, left, splits);
      place(node.first + 1, begin + left, count - left, rank + 1);
    }
    bvh.nodes[index] = node;
  }
};

Bvh build(const Triangles& triangles, std::uint32_t leaf_size, bool lopsided = false) {
  Builder builder{triangles, leaf_size, lopsided, {}};
  const auto count = static_cast<std::uint32_t>(triangles.size());
  if (count == 0) return {};
  builder.bvh.primitives.resize(count);
  std::iota(builder.bvh.primitives.rbegin(), builder.bvh.primitives.rend(), 0U);
  builder.bvh.nodes.resize(2 * builder.inner_nodes(count) + 1);
  builder.place(0, 0, count, 0);
  return builder.bvh;
}

// A sound tree over 20 triangles, up to 4 in a leaf, for a test to break.
struct Sound {
  Triangles triangles = random_triangles(20);
  BuildOptions options = leaves_of(4);
  Bvh bvh = build(triangles, 4);

  Sound() { REQUIRE_FALSE(check_bvh(bvh, triangles, options)); }

  std::uint32_t inner(std::uint32_t skip = 0) const { return find(false, skip); }
  std::uint32_t leaf(std::uint32_t skip = 0) const { return find(true, skip); }
  // The complaint about the tree as it is now.
  std::string complaint() const {
    const std::optional<gnomon::BvhFault> fault = check_bvh(bvh, triangles, options);
    return fault ? fault->what + " @ " + std::to_string(fault->node) : "nothing";
  }

 private:
  std::uint32_t find(bool leaves, std::uint32_t skip) const {
    for (std::uint32_t i = 1; i < bvh.nodes.size(); ++i) {
      if ((bvh.nodes[i].count > 0) == leaves && skip-- == 0) return i;
    }
    throw std::logic_error("no such node");
  }
};

std::string at(std::uint32_t node) {
  return "@ " + std::to_string(node);
}

}  // namespace

using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

TEST_CASE("sound trees of all sizes pass") {
  for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 5U, 8U, 9U, 100U, 1000U}) {
    for (const std::uint32_t leaf_size : {1U, 2U, 8U, 255U}) {
      for (const bool lopsided : {false, true}) {
        if (lopsided && count > 60 * leaf_size) continue;  // deeper than promised
        CAPTURE(count, leaf_size, lopsided);
        const Triangles triangles = random_triangles(count);
        REQUIRE_FALSE(check_bvh(build(triangles, leaf_size, lopsided), triangles, leaves_of(leaf_size)));
      }
    }
  }
}

TEST_CASE("negative zero equals zero in a box") {
  Triangles triangles = random_triangles(2);
  triangles[0] = {{0, 0, 0}, {-0.0F, 1, 0}, {0, 1, -0.0F}};
  Bvh bvh = build(triangles, 1);
  for (Node& node : bvh.nodes) {
    for (float* bound : {node.lo, node.hi}) {
      for (int axis = 0; axis < 3; ++axis) bound[axis] = bound[axis] == 0.0F ? -bound[axis] : bound[axis];
    }
  }
  CHECK_FALSE(check_bvh(bvh, triangles, leaves_of(1)));
}

TEST_CASE("a tree without triangles or triangles without a tree are found") {
  Sound sound;
  const Bvh empty;
  CHECK_FALSE(check_bvh(empty, {}, sound.options));
  CHECK_THAT(check_bvh(empty, sound.triangles, sound.options).value().what,
             StartsWith("sizes: 0 primitives for 20"));
  CHECK_THAT(check_bvh(sound.bvh, {}, sound.options).value().what, StartsWith("sizes: 20 primitives for 0"));
  sound.bvh.primitives.pop_back();
  CHECK_THAT(sound.complaint(), StartsWith("sizes: 19 primitives for 20 triangles"));
  Bvh nodes_only;
  nodes_only.nodes.resize(1);
  CHECK_THAT(check_bvh(nodes_only, {}, sound.options).value().what, StartsWith("sizes: 1 nodes for 0"));
}

TEST_CASE("a node too many or too few is found") {
  Sound sound;
  const std::vector<Node> nodes = sound.bvh.nodes;
  sound.bvh.nodes.pop_back();
  CHECK_THAT(sound.complaint(), StartsWith("node count: "));
  sound.bvh.nodes = nodes;
  sound.bvh.nodes.push_back(nodes.back());
  CHECK_THAT(sound.complaint(), StartsWith("node count: "));
}

TEST_CASE("children out of range are found") {
  for (const std::uint32_t first : {0xffffffffU, 0xfffffffeU}) {
    Sound sound;
    sound.bvh.nodes[sound.inner()].first = first;
    CHECK_THAT(sound.complaint(), StartsWith("links: children at " + std::to_string(first)));
  }
  Sound sound;
  sound.bvh.nodes[0].first = static_cast<std::uint32_t>(sound.bvh.nodes.size() - 1);
  CHECK_THAT(sound.complaint(), StartsWith("links: children at") && EndsWith(at(0)));
}

TEST_CASE("a node with two parents is found, overlapping pairs of siblings included") {
  Sound sound;
  sound.bvh.nodes[sound.inner(1)].first = sound.bvh.nodes[sound.inner(0)].first;
  CHECK_THAT(sound.complaint(), StartsWith("links: node") && Contains("twice"));
  Sound shifted;
  shifted.bvh.nodes[shifted.inner(1)].first = shifted.bvh.nodes[shifted.inner(0)].first + 1;
  CHECK_THAT(shifted.complaint(), StartsWith("links: node") && Contains("twice"));
}

TEST_CASE("a cycle is found") {
  Sound to_root;
  to_root.bvh.nodes[to_root.inner()].first = 0;
  CHECK_THAT(to_root.complaint(), StartsWith("links: node 0 is referenced twice or is the root"));
  Sound own;
  own.bvh.nodes[own.inner()].first = own.bvh.nodes[0].first;
  CHECK_THAT(own.complaint(), StartsWith("links: node") && Contains("twice"));
}

TEST_CASE("an island that no node leads to is found") {
  Sound sound;
  const auto size = static_cast<std::uint32_t>(sound.bvh.nodes.size());
  Node own_parent = sound.bvh.nodes[0];
  own_parent.first = size;
  sound.bvh.nodes.push_back(own_parent);
  sound.bvh.nodes.push_back(sound.bvh.nodes[sound.leaf()]);
  CHECK_THAT(sound.complaint(), StartsWith("links: node never referenced @ " + std::to_string(size)));
}

TEST_CASE("a primitive that appears twice or does not exist is found") {
  Sound twice;
  twice.bvh.primitives[3] = twice.bvh.primitives[17];
  CHECK_THAT(twice.complaint(), StartsWith("primitives: triangle 2 appears twice"));
  Sound beyond;
  beyond.bvh.primitives[3] = 20;
  CHECK_THAT(beyond.complaint(), StartsWith("primitives: index 20 is out of range"));
}

TEST_CASE("leaf ranges that overlap, leave a gap, run out of range or change order are found") {
  Sound overlap;
  overlap.bvh.nodes[overlap.leaf(1)].first -= 1;
  CHECK_THAT(overlap.complaint(), StartsWith("leaf ranges: starts at"));
  Sound gap;
  gap.bvh.nodes[gap.leaf(1)].count -= 1;
  CHECK_THAT(gap.complaint(), StartsWith("leaf ranges: "));
  Sound beyond;
  const auto last = std::find_if(beyond.bvh.nodes.begin(), beyond.bvh.nodes.end(), [](const Node& node) {
    return node.count > 0 && node.first + node.count == 20;
  });
  last->count += 100;
  CHECK_THAT(beyond.complaint(), StartsWith("leaf ranges: ends at 120 of 20"));
  last->count -= 101;
  CHECK_THAT(beyond.complaint(), StartsWith("leaf ranges: cover 19 of 20"));
  Sound swapped;
  const std::uint32_t left = swapped.leaf();
  REQUIRE(swapped.bvh.nodes[left + 1].count > 0);
  std::swap(swapped.bvh.nodes[left], swapped.bvh.nodes[left + 1]);
  CHECK_THAT(swapped.complaint(), StartsWith("leaf ranges: starts at"));
}

TEST_CASE("a leaf larger than the options allow is found") {
  Sound sound;
  sound.options.max_leaf_size = 2;
  CHECK_THAT(sound.complaint(), StartsWith("leaf size: 3 above 2"));
}

TEST_CASE("a box with NaN is found") {
  for (int axis = 0; axis < 3; ++axis) {
    Sound lo;
    lo.bvh.nodes[lo.leaf(2)].lo[axis] = kNan;
    CHECK_THAT(lo.complaint(), StartsWith("box: NaN") && EndsWith(at(lo.leaf(2))));
    Sound hi;
    hi.bvh.nodes[0].hi[axis] = kNan;
    CHECK_THAT(hi.complaint(), StartsWith("box: NaN") && EndsWith(at(0)));
  }
}

TEST_CASE("a box that reaches beyond its parent's is found") {
  for (int axis = 0; axis < 3; ++axis) {
    Sound lo;
    lo.bvh.nodes[lo.leaf(2)].lo[axis] = -1000.0F;
    CHECK_THAT(lo.complaint(), StartsWith("box: reaches beyond its parent's") && EndsWith(at(lo.leaf(2))));
    Sound hi;
    hi.bvh.nodes[hi.inner()].hi[axis] = 1000.0F;
    CHECK_THAT(hi.complaint(), StartsWith("box: reaches beyond its parent's") && EndsWith(at(hi.inner())));
  }
}

TEST_CASE("a box one ulp too large or too small is found") {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string named = "box: not the union of what it holds, axis " + std::to_string(axis);
    Sound large;
    large.bvh.nodes[0].lo[axis] = std::nextafter(large.bvh.nodes[0].lo[axis], -INFINITY);
    CHECK_THAT(large.complaint(), StartsWith(named) && EndsWith(at(0)));
    Sound small;
    Node& leaf = small.bvh.nodes[small.leaf(1)];
    leaf.hi[axis] = std::nextafter(leaf.hi[axis], -INFINITY);
    CHECK_THAT(small.complaint(), StartsWith(named));
  }
}

TEST_CASE("inner nodes numbered against the order of their splits are found") {
  Sound sound;
  std::vector<Node>& nodes = sound.bvh.nodes;
  const std::uint32_t a = sound.inner(0);
  const std::uint32_t b = sound.inner(1);
  REQUIRE(nodes[a].first != b);
  REQUIRE(nodes[b].first != a);
  for (std::uint32_t i = 0; i < 2; ++i) std::swap(nodes[nodes[a].first + i], nodes[nodes[b].first + i]);
  std::swap(nodes[a].first, nodes[b].first);
  CHECK_THAT(sound.complaint(), StartsWith("numbering: children at"));
}

TEST_CASE("a tree deeper than promised is found") {
  const Triangles triangles = random_triangles(20);
  const Bvh bvh = build(triangles, 1, true);  // depth 19
  BuildOptions options = leaves_of(1);
  options.median_depth = 13;  // 13 + ceil(log2 20) + 1 = 19
  CHECK_FALSE(check_bvh(bvh, triangles, options));
  options.median_depth = 12;
  CHECK_THAT(check_bvh(bvh, triangles, options).value().what, StartsWith("depth: 19 above 18"));
}
