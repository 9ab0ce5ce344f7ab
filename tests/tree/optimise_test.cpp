// Reinsertion in plain C++: sound trees that cost no more, what a move is and which moves give way.
#include "gnomon/tree/optimise.h"

#include <catch2/catch.hpp>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/shared/reinsert_math.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::OptimiseOptions;

namespace {

OptimiseOptions every_node() {
  OptimiseOptions options;
  options.share = 1.0F;
  options.max_passes = 20;
  options.least_gain = 0.0F;
  return options;
}

// The sum of inner nodes' half areas.
double cost_of(const Bvh& bvh) {
  double sum = 0.0;
  for (const GnNode& node : bvh.nodes) sum += node.count == 0 ? double{gn_half_area(&node)} : 0.0;
  return sum;
}

GnNode box_at(float x, std::uint32_t first, std::uint32_t count) {
  return {{x, 0, 0}, first, {x + 1, 1, 1}, count};
}

// A tree of four unit boxes in a row whose pairs are crossed: at 0 and 10, at 1 and 11.
Bvh crossed() {
  Bvh bvh;
  bvh.nodes = {
      {{0, 0, 0}, 3, {12, 1, 1}, 0}, box_at(0, 0, 1), box_at(10, 1, 1), {{0, 0, 0}, 1, {11, 1, 1}, 0},
      {{1, 0, 0}, 5, {12, 1, 1}, 0}, box_at(1, 2, 1), box_at(11, 3, 1)};
  bvh.primitives = {0, 1, 2, 3};
  return bvh;
}

}  // namespace

TEST_CASE("optimised trees are sound and cost no more, whatever the input") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const std::uint32_t leaf : {1U, 8U}) {
      CAPTURE(name, leaf);
      BuildOptions options;
      options.max_leaf_size = leaf;
      const Bvh before = gnomon::build_reference(triangles, options);
      OptimiseOptions optimise = every_node();
      optimise.max_depth = options.median_depth + 2;  // what check_bvh allows a tree of so few triangles
      const Bvh after = gnomon::optimise_reference(before, optimise);
      if (const auto fault = gnomon::check_bvh(after, triangles, options)) FAIL(fault->what);
      REQUIRE(after.nodes.size() == before.nodes.size());
      REQUIRE(cost_of(after) <= cost_of(before) * (1.0 + 1e-6));
    }
  }
}

TEST_CASE("reinsertion makes a poor tree good") {
  // Halved by count in the order of the input, which is none.
  const auto triangles = gnomon::test::soup(2000, 201, 0.1F);
  BuildOptions poor;
  poor.bins = 2;
  poor.median_depth = 1;
  const Bvh before = gnomon::build_reference(triangles, poor);
  OptimiseOptions options = every_node();
  options.max_depth = 128;
  const Bvh after = gnomon::optimise_reference(before, options);
  BuildOptions good;
  if (const auto fault = gnomon::check_bvh(after, triangles, good)) FAIL(fault->what);
  REQUIRE(cost_of(after) < 0.9 * cost_of(before));
}

TEST_CASE("leaving settled nodes alone costs little") {
  const auto triangles = gnomon::test::soup(3000, 202, 0.1F);
  BuildOptions poor;
  poor.median_depth = 1;
  const Bvh before = gnomon::build_reference(triangles, poor);
  OptimiseOptions options = every_node();
  const Bvh all = gnomon::optimise_reference(before, options);
  options.leave_settled = true;
  const Bvh some = gnomon::optimise_reference(before, options);
  if (const auto fault = gnomon::check_bvh(some, triangles, {})) FAIL(fault->what);
  REQUIRE(tree_hash(some) != tree_hash(all));
  REQUIRE(cost_of(some) < 1.02 * cost_of(all));
  REQUIRE(cost_of(some) < 0.9 * cost_of(before));
  // One pass has none that are settled before it.
  options.max_passes = 1;
  const Bvh once = gnomon::optimise_reference(before, options);
  options.leave_settled = false;
  REQUIRE(tree_hash(gnomon::optimise_reference(before, options)) == tree_hash(once));
}

TEST_CASE("two crossed pairs are put right by one move") {
  const Bvh bvh = crossed();
  const Bvh after = gnomon::optimise_reference(bvh, every_node());
  REQUIRE(after.primitives.size() == 4);
  // Inner nodes: the root (12 long) and one pair each (2 long).
  REQUIRE(cost_of(after) == Approx((12 * 2 + 1) + 2 * (2 * 2 + 1)));
}

TEST_CASE("without passes an optimised tree is what it was, to the last byte") {
  OptimiseOptions none;
  none.max_passes = 0;
  const auto triangles = gnomon::test::soup(700, 202);
  for (const std::uint32_t leaf : {1U, 8U}) {
    BuildOptions options;
    options.max_leaf_size = leaf;
    const Bvh bvh = gnomon::build_reference(triangles, options);
    REQUIRE(tree_hash(gnomon::optimise_reference(bvh, none)) == tree_hash(bvh));
  }
  REQUIRE(gnomon::optimise_reference({}, none).nodes.empty());
}

TEST_CASE("a triangle that one leaf holds twice is held once") {
  Bvh bvh;
  bvh.nodes = {{{0, 0, 0}, 1, {12, 1, 1}, 0}, box_at(0, 0, 4), box_at(11, 4, 3)};
  bvh.primitives = {5, 3, 5, 5, 3, 3, 4};
  OptimiseOptions none;
  none.max_passes = 0;
  const Bvh after = gnomon::optimise_reference(bvh, none);
  REQUIRE(after.primitives == std::vector<std::uint32_t>{5, 3, 3, 4});
  REQUIRE(after.nodes[1].count == 2);
  REQUIRE(after.nodes[2].first == 2);
  REQUIRE(after.nodes[2].count == 2);
}

TEST_CASE("a pass that would make the tree too deep is taken back") {
  std::vector<GnTriangle> triangles;  // each twice as large as the one before: cheapest as a chain
  for (int i = 0; i < 64; ++i) {
    const float x = std::ldexp(1.0F, i % 40 - 20);
    triangles.push_back(gnomon::test::triangle({0, 0, 0}, {x, 0, 0}, {x, x, x}));
  }
  BuildOptions halved;
  halved.max_leaf_size = 1;
  halved.median_depth = 1;
  const Bvh before = gnomon::build_reference(triangles, halved);
  OptimiseOptions options = every_node();
  const auto depth = [](const Bvh& bvh) { return gnomon::stats_of(bvh, {}).max_depth; };
  REQUIRE(depth(gnomon::optimise_reference(before, options)) > depth(before));
  options.max_depth = 1;  // no deeper than it was
  const Bvh after = gnomon::optimise_reference(before, options);
  REQUIRE(depth(after) <= depth(before));
  if (const auto fault = gnomon::check_bvh(after, triangles, halved)) FAIL(fault->what);
}

TEST_CASE("other measures make other trees") {
  const auto triangles = gnomon::test::soup(600, 203);
  const Bvh before = gnomon::build_reference(triangles, {});
  OptimiseOptions from_above = every_node();
  from_above.face_weights = {0.0F, 1.0F, 0.0F};
  const Bvh sah = gnomon::optimise_reference(before, every_node());
  const Bvh pah = gnomon::optimise_reference(before, from_above);
  REQUIRE(tree_hash(sah) != tree_hash(pah));
  const auto seen_from_above = [](const Bvh& bvh) {
    double sum = 0.0;
    for (const GnNode& n : bvh.nodes)
      sum += n.count == 0 ? double{n.hi[0] - n.lo[0]} * (double{n.hi[2]} - n.lo[2]) : 0.0;
    return sum;
  };
  REQUIRE(seen_from_above(pah) < seen_from_above(sah));
}

TEST_CASE("the most costly bins make up the share that is asked for") {
  std::vector<std::uint32_t> bins(GN_MEASURE_BINS);
  REQUIRE(gnomon::candidate_floor(bins, 0.5F) == 0);
  bins[100] = 50;
  bins[200] = 30;
  bins[300] = 20;
  REQUIRE(gnomon::candidate_floor(bins, 0.5F) == 101);
  REQUIRE(gnomon::candidate_floor(bins, 0.49F) == 201);
  REQUIRE(gnomon::candidate_floor(bins, 0.01F) == 300);  // never nobody
  REQUIRE(gnomon::candidate_floor(bins, 1.0F) == 0);
}

TEST_CASE("of two moves into each other's subtree the lesser gives way, equal ones by slot") {
  GnMove move{};
  move.node = 10;
  move.gain = 2.0F;
  REQUIRE(gn_gives_way(&move, 4, 3.0F) == 1);
  REQUIRE(gn_gives_way(&move, 20, 1.0F) == 0);
  REQUIRE(gn_gives_way(&move, 20, 2.0F) == 1);
  REQUIRE(gn_gives_way(&move, 4, 2.0F) == 0);
}

TEST_CASE("optimise options and trees out of range are refused by name") {
  const auto refused = [](const OptimiseOptions& options, const std::string& word) {
    REQUIRE_THROWS_WITH(gnomon::optimise_reference({}, options), Catch::Contains(word));
  };
  OptimiseOptions options;
  options.share = 0.0F;
  refused(options, "share");
  options = {};
  options.least_gain = 1.0F;
  refused(options, "least_gain");
  options = {};
  options.max_passes = 65;
  refused(options, "max_passes");
  options = {};
  options.max_depth = 129;
  refused(options, "max_depth");
  options = {};
  options.face_weights[2] = -1.0F;
  refused(options, "face_weights");
  Bvh chain;  // 200 levels, a leaf left of each
  chain.nodes.push_back(box_at(0, 1, 0));
  for (std::uint32_t i = 0; i < 200; ++i) {
    chain.nodes.push_back(box_at(0, i, 1));
    chain.nodes.push_back(i == 199 ? box_at(0, 200, 1) : box_at(0, 2 * i + 3, 0));
  }
  chain.primitives.resize(201);
  for (std::uint32_t i = 0; i < 201; ++i) chain.primitives[i] = i;
  REQUIRE_THROWS_WITH(gnomon::optimise_reference(chain), Catch::Contains("200 levels deep"));
}
