// The reference builder: what a tree is, before any device is asked.
#include "gnomon/tree/build_reference.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/trace_reference.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;

namespace {

void require_valid(const Bvh& bvh, const std::vector<GnTriangle>& triangles, const BuildOptions& options) {
  const auto fault = gnomon::check_bvh(bvh, triangles, options);
  if (fault) FAIL(fault->what << " at node " << fault->node);
}

double half_area(const float* lo, const float* hi) {
  const double d[3] = {static_cast<double>(hi[0]) - lo[0], static_cast<double>(hi[1]) - lo[1],
                       static_cast<double>(hi[2]) - lo[2]};
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

// Cheapest object split of all, on any axis, by exhaustive sweep over sorted centroids.
double best_sweep_cost(const std::vector<GnTriangle>& triangles) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::size_t> order(triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto box = [&](std::size_t first, std::size_t last) {
      float lo[3] = {INFINITY, INFINITY, INFINITY};
      float hi[3] = {-INFINITY, -INFINITY, -INFINITY};
      for (std::size_t i = first; i < last; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], gnomon::test::corner(triangles[order[i]], c)[k]);
            hi[k] = std::max(hi[k], gnomon::test::corner(triangles[order[i]], c)[k]);
          }
        }
      }
      return half_area(lo, hi) * static_cast<double>(last - first);
    };
    const auto centre = [&](std::size_t i) {
      const GnTriangle& t = triangles[i];
      return std::min({t.v0[axis], t.v1[axis], t.v2[axis]}) + std::max({t.v0[axis], t.v1[axis], t.v2[axis]});
    };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return centre(a) < centre(b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (centre(order[i - 1]) < centre(order[i])) best = std::min(best, box(0, i) + box(i, order.size()));
    }
  }
  return best;
}

}  // namespace

TEST_CASE("every awkward input gives a valid tree") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const std::uint32_t leaf : {1U, 4U, 255U}) {
      for (const std::uint32_t bins : {2U, 16U, 64U}) {
        CAPTURE(name, leaf, bins);
        BuildOptions options;
        options.max_leaf_size = leaf;
        options.bins = bins;
        require_valid(gnomon::build_reference(triangles, options), triangles, options);
      }
    }
  }
}

TEST_CASE("nodes past median_depth are halved by count, which bounds the depth") {
  const auto inputs = gnomon::test::awkward_inputs();
  BuildOptions options;
  options.max_leaf_size = 1;
  for (const std::uint32_t depth : {1U, 8U, 64U}) {
    options.median_depth = depth;
    for (const auto& [name, triangles] : inputs) {
      CAPTURE(depth, name);
      const Bvh bvh = gnomon::build_reference(triangles, options);
      require_valid(bvh, triangles, options);
      const double limit =
          depth + std::ceil(std::log2(std::max<double>(1.0, static_cast<double>(triangles.size())))) + 1;
      REQUIRE(gnomon::stats_of(bvh, options).max_depth <= limit);
    }
  }
}

TEST_CASE("the root's split is the exhaustive sweep's when bins separate all centroids") {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    // Centroids on a coarse lattice of 8 places per axis; 64 bins keep every two of them apart.
    gnomon::test::Random random(seed);
    std::vector<GnTriangle> triangles;
    for (int i = 0; i < 24; ++i) {
      std::array<float, 3> c{};
      for (float& x : c) x = static_cast<float>(random.below(8));
      const float s = random.between(0.1F, 3.0F);
      triangles.push_back(gnomon::test::triangle({c[0] - s, c[1] - s, c[2] - s},
                                                 {c[0] + s, c[1] + s, c[2] + s}, {c[0] + s, c[1] - s, c[2]}));
    }
    BuildOptions options;
    options.bins = 64;
    options.max_leaf_size = 1;
    const Bvh bvh = gnomon::build_reference(triangles, options);
    const auto subtree_cost = [&](std::uint32_t root) {
      // Leaves below hold one triangle each: count them.
      double count = 0.0;
      std::vector<std::uint32_t> open{root};
      while (!open.empty()) {
        const gnomon::Node node = bvh.nodes[open.back()];
        open.pop_back();
        count += node.count;
        if (node.count == 0) open.insert(open.end(), {node.first, node.first + 1});
      }
      return half_area(bvh.nodes[root].lo, bvh.nodes[root].hi) * count;
    };
    const std::uint32_t left = bvh.nodes[0].first;
    REQUIRE(subtree_cost(left) + subtree_cost(left + 1) == Approx(best_sweep_cost(triangles)).epsilon(1e-5));
  }
}

TEST_CASE("the same input gives the same bytes, and scaling by powers of two the same topology") {
  const auto triangles = gnomon::test::soup(2000, 7);
  const Bvh first = gnomon::build_reference(triangles);
  REQUIRE(gnomon::tree_hash(first) == gnomon::tree_hash(gnomon::build_reference(triangles)));
  for (const int exponent : {-30, 30}) {
    auto scaled = triangles;
    for (GnTriangle& t : scaled) {
      for (float* v : {t.v0, t.v1, t.v2}) {
        for (std::size_t k = 0; k < 3; ++k) v[k] = std::ldexp(v[k], exponent);
      }
    }
    const Bvh other = gnomon::build_reference(scaled);
    REQUIRE(other.primitives == first.primitives);
    REQUIRE(other.nodes.size() == first.nodes.size());
    for (std::size_t i = 0; i < first.nodes.size(); ++i) {
      REQUIRE(other.nodes[i].first == first.nodes[i].first);
      REQUIRE(other.nodes[i].count == first.nodes[i].count);
    }
  }
}

TEST_CASE("dearer traversal makes larger leaves") {
  const auto triangles = gnomon::test::soup(3000, 8);
  BuildOptions cheap;
  BuildOptions dear;
  dear.cost_traversal = 8.0F;
  REQUIRE(gnomon::stats_of(gnomon::build_reference(triangles, dear), dear).mean_leaf >
          1.5 * gnomon::stats_of(gnomon::build_reference(triangles, cheap), cheap).mean_leaf);
}

TEST_CASE("options out of range and coordinates that cannot be traced are refused by name") {
  const auto triangles = gnomon::test::soup(10, 9);
  const auto refuse = [&](auto change, const char* option) {
    BuildOptions options;
    change(options);
    CAPTURE(option);
    REQUIRE_THROWS_WITH(gnomon::build_reference(triangles, options), Catch::Contains(option));
  };
  refuse([](BuildOptions& o) { o.bins = 1; }, "bins");
  refuse([](BuildOptions& o) { o.bins = 65; }, "bins");
  refuse([](BuildOptions& o) { o.max_leaf_size = 0; }, "max_leaf_size");
  refuse([](BuildOptions& o) { o.max_leaf_size = 256; }, "max_leaf_size");
  refuse([](BuildOptions& o) { o.cost_traversal = 0.0F; }, "cost_traversal");
  refuse([](BuildOptions& o) { o.cost_triangle = std::nanf(""); }, "cost_triangle");
  refuse([](BuildOptions& o) { o.median_depth = 65; }, "median_depth");
  refuse([](BuildOptions& o) { o.work_group_size = 24; }, "work_group_size");
  refuse([](BuildOptions& o) { o.subtree_size = 8; }, "subtree_size");
  refuse([](BuildOptions& o) { o.chunk_size = 1; }, "chunk_size");
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY, 1e15F}) {
    auto broken = triangles;
    broken[7].v2[1] = bad;
    CAPTURE(bad);
    REQUIRE_THROWS_WITH(gnomon::build_reference(broken), Catch::Contains("triangle 7"));
  }
}

TEST_CASE("reference traversal finds what brute force finds") {
  const auto triangles = gnomon::test::soup(500, 10, 1.0F);
  const auto rays = gnomon::test::random_rays(2000, 11);
  const Bvh bvh = gnomon::build_reference(triangles);
  const auto closest = gnomon::trace_reference(bvh, triangles, rays, false);
  const auto any = gnomon::trace_reference(bvh, triangles, rays, true);
  std::vector<std::uint32_t> occluded;
  for (const GnHit& hit : any.hits) occluded.push_back(hit.primitive != GN_NONE ? 1 : 0);
  gnomon::OracleOptions options;
  options.max_rays = rays.size();
  const auto report = gnomon::judge(triangles, rays, closest.hits, occluded, options);
  REQUIRE(report.rays_judged == rays.size());
  REQUIRE(report.hits > 200);
  REQUIRE(report.mismatches() == 0);
  REQUIRE(report.max_t_error_ulp <= 1.0);
}
