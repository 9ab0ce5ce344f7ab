// The collapse: what it makes of every shape, and that nothing cheaper exists.
#include "gnomon/tree/wide.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "gnomon/base/error.h"
#include "gnomon/shared/collapse_math.h"
#include "gnomon/tree/build_reference.h"
#include "support/wide_shapes.h"
#include "support/wide_slots.h"

using gnomon::Bvh;
using gnomon::CollapseOptions;
using gnomon::Node;
using gnomon::WideBvh;
using gnomon::test::half_area;
using gnomon::test::is_leaf;
using gnomon::test::slot_half_area;

namespace {

// Nodes and blocks weighted by their areas: what the collapse makes least. The root's own step is left out.
double cost_of(const WideBvh& wide, const CollapseOptions& options) {
  double cost = 0.0;
  for (const gnomon::WideNode& node : wide.nodes) {
    for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
      const std::uint32_t link = node.links[slot];
      const double step = is_leaf(link) ? static_cast<double>(options.cost_block) *
                                              gn_blocks_of(gn_leaf_at(wide.leaves.data(), link).count)
                                        : static_cast<double>(options.cost_node);
      cost += slot_half_area(node, slot) * step;
    }
  }
  return cost;
}

// Every way to collapse a small tree, by recursion over all choices: no sharing of results, no shares of
// budgets by sums of two.
class BruteForce {
 public:
  BruteForce(const Bvh& bvh, const CollapseOptions& options, std::span<const float> weights = {})
      : bvh_(bvh), options_(options), weights_(weights) {}

  // Least cost below a wide node that replaces this inner node: over all cuts of at most eight nodes.
  double least_below(std::uint32_t node) const {
    double least = INFINITY;
    const std::uint32_t first = bvh_.nodes[node].first;
    for_every_cut({first, first + 1}, 0, [&](const std::vector<std::uint32_t>& cut) {
      double cost = 0.0;
      for (const std::uint32_t child : cut) cost += least_as_child(child);
      least = std::min(least, cost);
    });
    return least;
  }

 private:
  std::uint32_t triangles(std::uint32_t node) const {
    const Node& n = bvh_.nodes[node];
    return n.count > 0 ? n.count : triangles(n.first) + triangles(n.first + 1);
  }

  // As one child: a leaf, or a wide node.
  double least_as_child(std::uint32_t node) const {
    const double area = weights_.empty() ? half_area(bvh_.nodes[node]) : double{weights_[node]};
    const std::uint32_t count = triangles(node);
    const double leaf = area * static_cast<double>(options_.cost_block) * gn_blocks_of(count);
    if (bvh_.nodes[node].count > 0) return leaf;
    const double wide = area * static_cast<double>(options_.cost_node) + least_below(node);
    return count <= GN_WIDTH ? std::min(leaf, wide) : wide;
  }

  // From each cut on, one more node may be replaced by its children; those before `at` stay as they are.
  void for_every_cut(std::vector<std::uint32_t> cut, std::size_t at,
                     const std::function<void(const std::vector<std::uint32_t>&)>& use) const {
    if (at == cut.size()) return use(cut);
    for_every_cut(cut, at + 1, use);
    const Node& node = bvh_.nodes[cut[at]];
    if (node.count > 0 || cut.size() == GN_WIDTH) return;
    cut[at] = node.first;
    cut.push_back(node.first + 1);
    for_every_cut(cut, at, use);
  }

  const Bvh& bvh_;
  const CollapseOptions& options_;
  std::span<const float> weights_;
};

// What the collapse makes least where nodes have weights: boxes tell which node a slot is.
double cost_by_weights(const WideBvh& wide, const Bvh& bvh, std::span<const float> weights) {
  double cost = 0.0;
  for (const gnomon::WideNode& node : wide.nodes) {
    for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
      const auto same_box = [&](const Node& other) {
        bool same = true;
        for (int k = 0; k < 3; ++k)
          same =
              same && other.lo[k] == node.planes[2 * k][slot] && other.hi[k] == node.planes[2 * k + 1][slot];
        return same;
      };
      const auto from = std::find_if(bvh.nodes.begin(), bvh.nodes.end(), same_box);
      REQUIRE(std::count_if(from, bvh.nodes.end(), same_box) == 1);
      const std::uint32_t link = node.links[slot];
      cost += double{weights[static_cast<std::size_t>(from - bvh.nodes.begin())]} *
              (is_leaf(link) ? gn_blocks_of(gn_leaf_at(wide.leaves.data(), link).count) : 1U);
    }
  }
  return cost;
}

CollapseOptions costs(float node, float block) {
  CollapseOptions options;
  options.cost_node = node;
  options.cost_block = block;
  return options;
}

// `count` triangles in one leaf.
Bvh single_leaf(std::uint32_t count) {
  Bvh bvh;
  Node leaf{};
  for (int k = 0; k < 3; ++k) leaf.hi[k] = 1.0F;
  leaf.count = count;
  bvh.nodes = {leaf};
  for (std::uint32_t i = 0; i < count; ++i) bvh.primitives.push_back(i);
  return bvh;
}

bool same_bytes(const WideBvh& a, const WideBvh& b) {
  return gnomon::tree_hash(a) == gnomon::tree_hash(b) && a.depth == b.depth;
}

}  // namespace

TEST_CASE("collapsed trees of every shape keep all promises") {
  for (const auto& shape : gnomon::test::wide_shapes()) {
    const Bvh bvh = gnomon::build_reference(shape.triangles, shape.options);
    for (const CollapseOptions& options : {costs(1, 1), costs(1000, 0.001F), costs(0.001F, 1000)}) {
      CAPTURE(shape.name, options.cost_node, options.cost_block);
      const WideBvh wide = gnomon::collapse_reference(bvh, shape.triangles, options);
      const auto fault = gnomon::check_wide(wide, shape.triangles);
      if (fault) FAIL(fault->what);
      REQUIRE(wide.depth <= stats_of(bvh, shape.options).max_depth + 1);
    }
  }
}

TEST_CASE("with weights no way to collapse a small tree costs less by these") {
  std::uint32_t unlike_areas = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const auto triangles = gnomon::test::soup(4 + seed % 11, 1900 + seed, 1.0F);
    const Bvh bvh = gnomon::build_reference(triangles, gnomon::test::leaves_of(1));
    // Of a node at most its parent's; some of none.
    std::vector<float> weights(bvh.nodes.size(), 1.0F);
    for (const Node& node : bvh.nodes) {
      if (node.count > 0) continue;
      const auto own = weights[static_cast<std::size_t>(&node - bvh.nodes.data())];
      weights[node.first] = own * static_cast<float>((seed + node.first) % 5) / 4.0F;
      weights[node.first + 1] = own * static_cast<float>((seed + 3 * node.first) % 4) / 3.0F;
    }
    CAPTURE(seed);
    const WideBvh wide = gnomon::collapse_reference(bvh, triangles, {}, {}, weights);
    if (const auto fault = gnomon::check_wide(wide, triangles)) FAIL(fault->what);
    REQUIRE(cost_by_weights(wide, bvh, weights) ==
            Approx(BruteForce(bvh, {}, weights).least_below(0)).margin(1e-6));
    unlike_areas += same_bytes(wide, gnomon::collapse_reference(bvh, triangles)) ? 0 : 1;
  }
  REQUIRE(unlike_areas > 20);
}

TEST_CASE("areas given as weights collapse as areas do, and bad weights are refused") {
  const auto triangles = gnomon::test::soup(300, 1990, 0.3F);
  const Bvh bvh = gnomon::build_reference(triangles, gnomon::test::leaves_of(2));
  std::vector<float> areas;
  for (const Node& node : bvh.nodes) areas.push_back(gn_half_area(&node));
  REQUIRE(same_bytes(gnomon::collapse_reference(bvh, triangles, {}, {}, areas),
                     gnomon::collapse_reference(bvh, triangles)));
  REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, {}, {}, std::span(areas).first(3)),
                      Catch::Contains("3 weights"));
  for (const float bad : {-1.0F, NAN, INFINITY}) {
    areas[5] = bad;
    REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, {}, {}, areas),
                        Catch::Contains("weight 5"));
  }
}

TEST_CASE("no way to collapse a small tree costs less") {
  std::uint32_t with_nodes_below = 0;
  std::uint32_t with_merged_leaves = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const std::uint32_t count = 2 + seed % 13;
    const float size = seed % 3 == 0 ? 0.1F : seed % 3 == 1 ? 1.0F : 4.0F;
    const auto triangles = gnomon::test::soup(count, 900 + seed, size);
    const Bvh bvh = gnomon::build_reference(triangles, gnomon::test::leaves_of(1 + seed % 2));
    if (bvh.nodes.size() == 1) continue;
    for (const CollapseOptions& options :
         {costs(1, 1), costs(1, 0.25F), costs(0.25F, 1), costs(0.01F, 1), costs(1, 0.01F)}) {
      CAPTURE(seed, count, options.cost_node, options.cost_block);
      const WideBvh wide = gnomon::collapse_reference(bvh, triangles, options);
      const double least = BruteForce(bvh, options).least_below(0);
      REQUIRE(cost_of(wide, options) == Approx(least).epsilon(1e-6));
      with_nodes_below += wide.nodes.size() > 1 ? 1 : 0;
      with_merged_leaves += gnomon::stats_of(wide).blocks * 2 < bvh.nodes.size() ? 1 : 0;
    }
  }
  REQUIRE(with_nodes_below > 50);
  REQUIRE(with_merged_leaves > 50);
}

TEST_CASE("an empty scene becomes a root without children") {
  const WideBvh wide = gnomon::collapse_reference({}, {});
  REQUIRE(wide.nodes.size() == 1);
  REQUIRE(wide.leaves.empty());
  REQUIRE(wide.depth == 1);
  REQUIRE_FALSE(gnomon::check_wide(wide, {}));
  REQUIRE(gnomon::check_wide(wide, gnomon::test::soup(1, 1)));
}

TEST_CASE("a leaf of 256 triangles fits, one of 257 does not") {
  const auto triangles = gnomon::test::repeated(gnomon::test::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 1}), 257);
  const std::span<const GnTriangle> most(triangles.data(), 256);
  const WideBvh wide = gnomon::collapse_reference(single_leaf(256), most);
  REQUIRE(wide.places() == 257);
  REQUIRE(gn_leaf_at(wide.leaves.data(), wide.nodes[0].links[0]).count == 256);
  REQUIRE_FALSE(gnomon::check_wide(wide, most));
  REQUIRE_THROWS_WITH(gnomon::collapse_reference(single_leaf(257), triangles),
                      Catch::Contains("257") && Catch::Contains("256"));
}

TEST_CASE("costs out of range are named") {
  const auto triangles = gnomon::test::soup(3, 1);
  const Bvh bvh = gnomon::build_reference(triangles);
  for (const float bad : {0.0F, -1.0F, 1000.1F, INFINITY, std::nanf("")}) {
    CAPTURE(bad);
    REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, costs(bad, 1)),
                        Catch::Contains("cost_node"));
    REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, costs(1, bad)),
                        Catch::Contains("cost_block"));
  }
  CollapseOptions options;
  options.triangles_per_task = (1U << 20U) + 1;
  REQUIRE_THROWS_WITH(gnomon::collapse_reference(bvh, triangles, options),
                      Catch::Contains("triangles_per_task"));
  options.triangles_per_task = 1U << 20U;
  REQUIRE_NOTHROW(gnomon::collapse_reference(bvh, triangles, options));
  REQUIRE_NOTHROW(gnomon::collapse_reference(bvh, triangles, costs(1000, 1e-30F)));
}

TEST_CASE("how the device works changes no tree") {
  const auto triangles = gnomon::test::soup(200, 7);
  const Bvh bvh = gnomon::build_reference(triangles);
  CollapseOptions options;
  options.triangles_per_task = 16;
  REQUIRE(same_bytes(gnomon::collapse_reference(bvh, triangles, options),
                     gnomon::collapse_reference(bvh, triangles)));
}

// Two clusters of eight cubes' diagonals, far apart: the root keeps two leaves of eight in one node.
TEST_CASE("the numbers of a small tree are those worked out by hand") {
  std::vector<GnTriangle> triangles;
  for (const float x : {0.0F, 9.0F}) {
    for (int i = 0; i < 8; ++i)
      triangles.push_back(gnomon::test::triangle({x, 0, 0}, {x + 1, 0, 1}, {x + 1, 1, 1}));
  }
  const WideBvh wide =
      gnomon::collapse_reference(gnomon::build_reference(triangles, gnomon::test::leaves_of(8)), triangles);
  REQUIRE(wide.nodes.size() == 1);
  const auto stats = gnomon::stats_of(wide);
  // Half areas: the whole box 10 x 1 x 1 has 21, a cluster's unit cube 3.
  REQUIRE(stats.expected_nodes == 1.0);
  REQUIRE(stats.expected_blocks == Approx(2.0 * 3.0 / 21.0));
  REQUIRE(stats.mean_children == 2.0);
  REQUIRE(stats.mean_block == 8.0);
  REQUIRE(stats.bytes == 224 + 16 * 40);

  const WideBvh split = gnomon::collapse_reference(
      gnomon::build_reference(triangles, gnomon::test::leaves_of(1)), triangles, costs(0.001F, 1000));
  REQUIRE(gnomon::stats_of(split).expected_blocks == Approx(2.0 * 3.0 / 21.0));
}

TEST_CASE("wide nodes below the root count with their share of its area") {
  // Seventeen unit cubes' diagonals in a row, two units apart: more than one node can hold as single leaves.
  std::vector<GnTriangle> triangles;
  for (int i = 0; i < 17; ++i) {
    const auto x = static_cast<float>(2 * i);
    triangles.push_back(gnomon::test::triangle({x, 0, 0}, {x + 1, 0, 1}, {x + 1, 1, 1}));
  }
  const WideBvh wide = gnomon::collapse_reference(
      gnomon::build_reference(triangles, gnomon::test::leaves_of(1)), triangles, costs(0.001F, 1000));
  double nodes = 1.0;
  double blocks = 0.0;
  double children = 0.0;
  for (const auto& node : wide.nodes) {
    for (std::uint32_t slot = 0; slot < GN_WIDTH && node.links[slot] != GN_NONE; ++slot) {
      const double length = static_cast<double>(node.planes[1][slot] - node.planes[0][slot]);
      children += 1.0;
      (is_leaf(node.links[slot]) ? blocks : nodes) += (2.0 * length + 1.0) / (2.0 * 33.0 + 1.0);
    }
  }
  REQUIRE(wide.nodes.size() > 1);
  const auto stats = gnomon::stats_of(wide);
  REQUIRE(stats.expected_nodes == Approx(nodes));
  REQUIRE(stats.expected_blocks == Approx(blocks));
  REQUIRE(stats.mean_children == Approx(children / static_cast<double>(wide.nodes.size())));
}

TEST_CASE("a byte of a node or a block changes the hash") {
  const auto triangles = gnomon::test::soup(200, 7);
  WideBvh wide = gnomon::collapse_reference(gnomon::build_reference(triangles), triangles);
  const std::string before = gnomon::tree_hash(wide);
  REQUIRE(before.size() == 16);
  wide.leaves.back() ^= 1U;
  REQUIRE(gnomon::tree_hash(wide) != before);
  wide.leaves.back() ^= 1U;
  wide.nodes.back().links[7] ^= 1U;
  REQUIRE(gnomon::tree_hash(wide) != before);
}
