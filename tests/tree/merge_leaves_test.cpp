// Joining leaves: sound trees, the least cost there is, the same hits.
#include "gnomon/tree/merge_leaves.h"

#include <catch2/catch.hpp>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/optimise.h"
#include "gnomon/tree/trace_reference.h"
#include "support/bundles.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::merge_leaves;
using gnomon::MergeOptions;

namespace {

constexpr std::array<float, 3> kSurface{1.0F, 1.0F, 1.0F};

BuildOptions single_leaves() {
  BuildOptions options;
  options.max_leaf_size = 1;
  return options;
}

double cost_of(const Bvh& bvh, const MergeOptions& options) {
  const auto measures = gnomon::face_measures(bvh, kSurface);
  double sum = 0.0;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const double step = bvh.nodes[i].count > 0 ? double{options.cost_triangle} * bvh.nodes[i].count
                                               : double{options.cost_inner};
    sum += step * double{measures[i]};
  }
  return sum;
}

// Each once, whether parts of it are in several leaves or not.
std::set<std::uint32_t> triangles_below(const Bvh& bvh, std::uint32_t node) {
  const auto& [lo, first, hi, count] = bvh.nodes[node];
  if (count > 0) return {bvh.primitives.begin() + first, bvh.primitives.begin() + first + count};
  std::set<std::uint32_t> out = triangles_below(bvh, first);
  out.merge(triangles_below(bvh, first + 1));
  return out;
}

// Of the tree whose inner nodes in `leaves` (a bit a pair) are leaves; infinite where one would be too large.
double cost_with(const Bvh& bvh, const MergeOptions& options, std::uint32_t node, std::uint32_t leaves) {
  const gnomon::Node& n = bvh.nodes[node];
  const double measure = double{gnomon::face_measures(bvh, kSurface)[node]};
  const bool closed = n.count > 0 || (leaves >> (n.first / 2) & 1U) != 0;
  if (closed) {
    const auto below = static_cast<std::uint32_t>(triangles_below(bvh, node).size());
    if (n.count == 0 && below > options.max_leaf_size) return INFINITY;
    return measure * double{options.cost_triangle} * below;
  }
  return measure * double{options.cost_inner} + cost_with(bvh, options, n.first, leaves) +
         cost_with(bvh, options, n.first + 1, leaves);
}

// Of all ways to join leaves.
double least_cost(const Bvh& bvh, const MergeOptions& options) {
  double least = INFINITY;
  for (std::uint32_t leaves = 0; leaves < 1U << (bvh.nodes.size() / 2 + 1); ++leaves)
    least = std::min(least, cost_with(bvh, options, 0, leaves));
  return least;
}

}  // namespace

TEST_CASE("trees with joined leaves are sound, whatever the input") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const std::uint32_t most : {1U, 4U, 255U}) {
      CAPTURE(name, most);
      const Bvh before = gnomon::build_reference(triangles, single_leaves());
      MergeOptions options;
      options.max_leaf_size = most;
      const Bvh after = merge_leaves(before, gnomon::face_measures(before, kSurface), options);
      BuildOptions check = single_leaves();
      check.max_leaf_size = most;
      if (const auto fault = gnomon::check_bvh(after, triangles, check)) FAIL(fault->what);
      REQUIRE(after.primitives == before.primitives);
      REQUIRE(cost_of(after, options) <= cost_of(before, options) * (1.0 + 1e-6));
    }
  }
}

TEST_CASE("no way to join the leaves of a small tree costs less") {
  std::uint32_t joined = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const auto triangles = gnomon::test::soup(3 + seed % 6, 700 + seed, seed % 2 == 0 ? 0.5F : 4.0F);
    const Bvh before = gnomon::build_reference(triangles, single_leaves());
    for (const float triangle : {0.3F, 1.2F, 3.0F}) {
      CAPTURE(seed, triangle);
      MergeOptions options;
      options.cost_triangle = triangle;
      const Bvh after = merge_leaves(before, gnomon::face_measures(before, kSurface), options);
      REQUIRE(cost_of(after, options) == Approx(least_cost(before, options)).epsilon(1e-5));
      joined += after.nodes.size() < before.nodes.size() ? 1 : 0;
    }
  }
  REQUIRE(joined > 60);
}

TEST_CASE("halves of a triangle that meet in a joined leaf are one, and no way to join leaves costs less") {
  std::uint32_t joined = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const auto triangles = gnomon::test::soup(2 + seed % 5, 900 + seed, seed % 2 == 0 ? 2.0F : 6.0F);
    std::vector<GnPrimitive> halves;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      const GnPrimitive whole = gnomon::primitive_of(triangles[i], i);
      halves.insert(halves.end(), 2, whole);
      const std::uint32_t axis = (seed + i) % 3;
      const float middle = 0.5F * (whole.lo[axis] + whole.hi[axis]);
      halves[2 * i].hi[axis] = halves[2 * i + 1].lo[axis] = middle;
    }
    const Bvh before =
        gnomon::optimise_reference(gnomon::build_over_primitives(halves, triangles, single_leaves()));
    for (const auto& [most, triangle] : {std::pair{1U, 0.3F}, {2U, 1.2F}, {4U, 3.0F}}) {
      CAPTURE(seed, most);
      MergeOptions options;
      options.max_leaf_size = most;
      options.cost_triangle = triangle;
      const Bvh after = merge_leaves(before, gnomon::face_measures(before, kSurface), options);
      REQUIRE(cost_of(after, options) == Approx(least_cost(before, options)).epsilon(1e-5));
      std::size_t held = 0;
      for (const gnomon::Node& node : after.nodes) {
        if (node.count == 0) continue;
        REQUIRE(node.first == held);
        REQUIRE(node.count <= most);
        const std::set<std::uint32_t> own(after.primitives.begin() + node.first,
                                          after.primitives.begin() + node.first + node.count);
        REQUIRE(own.size() == node.count);
        held += node.count;
      }
      REQUIRE(held == after.primitives.size());
      joined += after.primitives.size() < before.primitives.size() ? 1 : 0;
    }
  }
  REQUIRE(joined > 40);
}

TEST_CASE("nodes that stay keep their measures") {
  const auto triangles = gnomon::test::soup(200, 44, 0.5F);
  const Bvh before = gnomon::build_reference(triangles, single_leaves());
  const std::vector<float> measures = gnomon::face_measures(before, kSurface);
  std::vector<float> kept{7.0F};
  const Bvh after = merge_leaves(before, measures, {}, &kept);
  REQUIRE(after.nodes.size() < before.nodes.size());
  REQUIRE(kept == gnomon::face_measures(after, kSurface));
  static_cast<void>(merge_leaves({}, {}, {}, &kept));
  REQUIRE(kept.empty());
}

TEST_CASE("joined leaves change no hit") {
  const auto triangles = gnomon::test::soup(500, 41, 0.7F);
  const auto rays = gnomon::test::random_rays(500, 42);
  const Bvh before = gnomon::optimise_reference(gnomon::build_reference(triangles, single_leaves()));
  const Bvh after = merge_leaves(before, gnomon::face_measures(before, kSurface));
  REQUIRE(after.nodes.size() < before.nodes.size());
  const auto expected = gnomon::trace_reference(before, triangles, rays, false).hits;
  const auto got = gnomon::trace_reference(after, triangles, rays, false).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(got[i].primitive == expected[i].primitive);
    REQUIRE(got[i].t == expected[i].t);
  }
}

TEST_CASE("joining leaves refuses what it cannot do, naming it") {
  const Bvh bvh = gnomon::build_reference(gnomon::test::soup(10, 43), single_leaves());
  const auto measures = gnomon::face_measures(bvh, kSurface);
  MergeOptions options;
  options.max_leaf_size = 0;
  REQUIRE_THROWS_WITH(merge_leaves(bvh, measures, options), Catch::Contains("max_leaf_size"));
  options = {};
  options.cost_inner = 0.0F;
  REQUIRE_THROWS_WITH(merge_leaves(bvh, measures, options), Catch::Contains("cost_inner"));
  options = {};
  options.cost_triangle = NAN;
  REQUIRE_THROWS_WITH(merge_leaves(bvh, measures, options), Catch::Contains("cost_triangle"));
  REQUIRE_THROWS_WITH(merge_leaves(bvh, std::span(measures).first(3)), Catch::Contains("3 measures"));
  REQUIRE(merge_leaves({}, {}).nodes.empty());
}
