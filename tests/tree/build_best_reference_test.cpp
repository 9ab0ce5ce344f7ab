// The best builder's reference: sound trees of every awkward input, better than balanced ones, and what it
// refuses.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/trace_reference.h"
#include "gnomon/tree/wide.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;

namespace {

using Triangles = std::vector<GnTriangle>;

BuildOptions best() {
  BuildOptions options;
  options.builder = gnomon::Builder::kBest;
  return options;
}

Bvh require_sound(const Triangles& triangles, const BuildOptions& options) {
  Bvh bvh = gnomon::build_reference(triangles, options);
  if (const auto fault = gnomon::check_bvh(bvh, triangles, options)) FAIL(fault->what);
  const auto wide = gnomon::collapse_reference(bvh, triangles);
  if (const auto fault = gnomon::check_wide(wide, triangles, gnomon::Repeats::kAllowed)) FAIL(fault->what);
  return bvh;
}

}  // namespace

TEST_CASE("the best builder makes sound trees of every awkward input, whatever leaves may hold") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const std::uint32_t leaf : {1U, 8U, 255U}) {
      CAPTURE(name, leaf);
      BuildOptions options = best();
      options.max_leaf_size = leaf;
      if (leaf == 255) options.cost_traversal = 1000.0F;
      require_sound(triangles, options);
    }
  }
}

TEST_CASE("best trees of scenes with large triangles name some of them in several leaves, and cost less") {
  Triangles triangles = gnomon::test::soup(3000, 310, 0.1F);
  const Triangles large = gnomon::test::soup(300, 311, 5.0F);
  triangles.insert(triangles.end(), large.begin(), large.end());
  const Bvh bvh = require_sound(triangles, best());
  REQUIRE(bvh.primitives.size() > triangles.size());
  const double cost = gnomon::stats_of(bvh, {}).sah_cost;
  REQUIRE(cost < 0.9 * gnomon::stats_of(gnomon::build_reference(triangles, {}), {}).sah_cost);
}

TEST_CASE("the reference's best trees give the oracle's hits") {
  Triangles triangles = gnomon::test::soup(400, 312, 0.3F);
  const Triangles large = gnomon::test::soup(150, 313, 5.0F);
  triangles.insert(triangles.end(), large.begin(), large.end());
  const Bvh bvh = require_sound(triangles, best());
  std::size_t found = 0;
  for (const GnRay& ray : gnomon::test::random_rays(400, 314)) {
    const auto expected = gnomon::oracle_closest(ray, triangles);
    const auto hit = gnomon::trace_reference(bvh, triangles, std::vector<GnRay>{ray}, false).hits.front();
    REQUIRE(hit.primitive == expected.primitive);
    found += hit.primitive != GN_NONE ? 1 : 0;
  }
  REQUIRE(found > 100);
}

TEST_CASE("rays to corners in the planes that divide their triangles hit what the oracle hits") {
  const Triangles triangles = gnomon::test::corners_in_planes(1500, 100, 315);
  const Bvh bvh = require_sound(triangles, best());
  REQUIRE(bvh.primitives.size() > triangles.size());
  for (std::size_t i = 1500; i < triangles.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const GnRay ray = gnomon::test::aimed({-31, 47, 101}, gnomon::test::corner(triangles[i], c));
      CAPTURE(i, c);
      const auto expected = gnomon::oracle_closest(ray, triangles);
      const auto hit = gnomon::trace_reference(bvh, triangles, std::vector<GnRay>{ray}, false).hits.front();
      REQUIRE(hit.primitive == expected.primitive);
    }
  }
}

TEST_CASE("best trees keep to the depth that checks demand") {
  Triangles triangles;
  for (int i = 0; i < 64; ++i) {
    const float x = std::ldexp(1.0F, i % 40 - 20);
    triangles.push_back(gnomon::test::triangle({0, 0, 0}, {x, 0, 0}, {x, x, x}));
  }
  BuildOptions options = best();
  options.max_leaf_size = 1;
  options.median_depth = 1;
  const Bvh bvh = require_sound(triangles, options);
  REQUIRE(gnomon::stats_of(bvh, options).max_depth <= gnomon::most_depth_of_best(options, triangles.size()));
  REQUIRE(gnomon::most_depth_of_best(options, 64) == 1 + 6 + 1);
  REQUIRE(gnomon::most_depth_of_best(options, 65) == 1 + 7 + 1);
}

TEST_CASE("what the best builder cannot heed is refused") {
  const auto refused = [](const BuildOptions& options, const std::string& word) {
    REQUIRE_THROWS_WITH(gnomon::build_reference(gnomon::test::soup(3, 1), options),
                        Catch::Contains("builder best") && Catch::Contains(word));
  };
  BuildOptions options = best();
  options.axes = gnomon::AxisPolicy::kLsph;
  refused(options, "sah+lsph");
  options = best();
  options.measure.kind = GN_MEASURE_WINDOW;
  options.measure.half_width = options.measure.half_height = 1.0F;
  refused(options, "pah-window");
  options = best();
  options.published_leaves.on = true;
  refused(options, "published_leaves");
}

TEST_CASE("the best builder takes parallel rays' measures and builds other trees by them") {
  const auto triangles = gnomon::test::soup(2000, 315);
  BuildOptions options = best();
  options.measure.weights[0] = 0.1F;
  options.measure.weights[1] = 1.0F;
  options.measure.weights[2] = 0.1F;
  const Bvh bvh = require_sound(triangles, options);
  REQUIRE(tree_hash(bvh) != tree_hash(gnomon::build_reference(triangles, best())));
}

TEST_CASE("the best builder refuses bad coordinates with the first triangle's number") {
  auto triangles = gnomon::test::soup(900, 316);
  triangles[700].v2[1] = INFINITY;
  triangles[800].v0[0] = -1e15F;
  REQUIRE_THROWS_WITH(gnomon::build_reference(triangles, best()), Catch::Contains("triangle 700"));
}

TEST_CASE("checks of best trees still tell good from bad") {
  Triangles triangles = gnomon::test::soup(600, 317, 0.1F);
  const Triangles large = gnomon::test::soup(150, 318, 5.0F);
  triangles.insert(triangles.end(), large.begin(), large.end());
  const Bvh good = require_sound(triangles, best());
  const auto require_fault = [&](const Bvh& bvh, const std::string& word) {
    const auto fault = gnomon::check_bvh(bvh, triangles, best());
    REQUIRE(fault);
    REQUIRE_THAT(fault->what, Catch::Contains(word));
  };
  REQUIRE(gnomon::check_bvh(good, triangles, {}));  // a balanced tree may not
  Bvh bad = good;
  const std::uint32_t lost = bad.primitives[0];
  for (std::uint32_t& p : bad.primitives) p = p == lost ? (lost + 1) % 600 : p;
  require_fault(bad, "is in no leaf");
  bad = good;
  // A part's leaf that lets go of it.
  std::vector<std::uint32_t> times(triangles.size());
  for (const std::uint32_t p : good.primitives) times[p] += 1;
  bool planted = false;
  for (std::size_t i = 0; i + 1 < good.primitives.size() && !planted; ++i) {
    if (times[good.primitives[i]] < 3) continue;
    bad = good;
    bad.primitives[i] = bad.primitives[i] + 1 < 750 ? bad.primitives[i] + 1 : 600;
    planted = gnomon::check_bvh(bad, triangles, best()).has_value();
  }
  REQUIRE(planted);
  auto wide = gnomon::collapse_reference(good, triangles);
  REQUIRE(gnomon::check_wide(wide, triangles));
  REQUIRE_FALSE(gnomon::check_wide(wide, triangles, gnomon::Repeats::kAllowed));
  std::uint32_t doomed = GN_NONE;
  for (const auto& node : wide.nodes) {
    for (const std::uint32_t link : node.links) {
      if (link == GN_NONE || (link & GN_LEAF_LINK) == 0) continue;
      const GnLeaf leaf = gn_leaf_at(wide.leaves.data(), link);
      for (std::uint32_t i = 0; i < leaf.count; ++i) {
        const std::uint32_t seat = gn_seat_in(leaf, i);
        if (doomed == GN_NONE) doomed = gnomon::number_in(wide, seat);
        if (gnomon::number_in(wide, seat) != doomed) continue;
        wide.leaves[gn_seat_word(seat) + 9 * gn_seat_stride(seat)] = GN_NUMBER + (doomed + 1) % 750;
      }
    }
  }
  REQUIRE(gnomon::check_wide(wide, triangles, gnomon::Repeats::kAllowed));
}
