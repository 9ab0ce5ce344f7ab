// The fast builder's reference: sound trees from every awkward input, the curve's order, bounded depth, and
// the rules that make rounds end.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/shared/fast_math.h"
#include "gnomon/tree/build_fast_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/shapes.h"

using gnomon::BuildOptions;

namespace {

using Triangles = std::vector<GnTriangle>;

BuildOptions fast() {
  BuildOptions options;
  options.builder = gnomon::Builder::kFast;
  return options;
}

gnomon::Bvh require_sound(const Triangles& triangles, const BuildOptions& options) {
  gnomon::Bvh bvh = gnomon::build_reference(triangles, options);
  if (const auto fault = gnomon::check_bvh(bvh, triangles, options)) FAIL(fault->what);
  return bvh;
}

GnTriangle point(float x, float y, float z) {
  return gnomon::test::triangle({x, y, z}, {x, y, z}, {x, y, z});
}

}  // namespace

TEST_CASE("the fast builder makes sound trees of every awkward input, whatever leaves may hold") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    for (const std::uint32_t leaf : {1U, 8U, 255U}) {
      CAPTURE(name, leaf);
      BuildOptions options = fast();
      options.max_leaf_size = leaf;
      if (leaf == 255) options.cost_traversal = 1000.0F;
      const auto bvh = require_sound(triangles, options);
      if (leaf == 1) REQUIRE(bvh.nodes.size() == (triangles.empty() ? 0 : 2 * triangles.size() - 1));
    }
  }
}

TEST_CASE("segments' edges make no difference to soundness") {
  for (const std::uint32_t count : {31U, 32U, 33U, 511U, 512U, 513U, 1024U, 1025U, 5000U}) {
    CAPTURE(count);
    require_sound(gnomon::test::soup(count, 150), fast());
  }
}

TEST_CASE("the curve goes through eight cells in Morton order, equal ones by number") {
  Triangles corners;
  for (int i = 7; i >= 0; --i) {
    corners.push_back(
        point(static_cast<float>(i >> 2 & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i & 1)));
    corners.push_back(corners.back());
  }
  REQUIRE(gnomon::morton_order(corners) ==
          std::vector<std::uint32_t>{14, 15, 12, 13, 10, 11, 8, 9, 6, 7, 4, 5, 2, 3, 0, 1});
}

TEST_CASE("cells are cubes: a flat scene is not cut along its thin side first") {
  // Were the thin side stretched to the long one, z = 1 would come after x = 300.
  const Triangles triangles{point(0, 0, 0),   point(0, 0, 1),    point(300, 0, 0),
                            point(300, 0, 1), point(1000, 0, 0), point(1000, 0, 1)};
  REQUIRE(gnomon::morton_order(triangles) == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
}

TEST_CASE("a segment in one coarse cell is ordered by finer ones") {
  // 600 points within a thousandth of a thousandth of the scene, backwards, and one far off.
  Triangles triangles;
  for (int i = 0; i < 600; ++i) triangles.push_back(point(static_cast<float>(599 - i), 0, 0));
  triangles.push_back(point(1.0e6F, 0, 0));
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 600; ++i) expected.push_back(599 - i);
  expected.push_back(600);
  REQUIRE(gnomon::morton_order(triangles) == expected);
}

TEST_CASE("pair keys are the same from both ends and tell a cluster's candidates apart") {
  for (std::uint32_t place = 20; place < 40; ++place) {
    CAPTURE(place);
    std::set<std::uint32_t> keys;
    for (std::uint32_t distance = 1; distance <= GN_NEIGHBOURS; ++distance) {
      for (const std::uint32_t lower : {place - distance, place}) {
        const std::uint32_t key = gn_pair_key(3.0F, distance, lower);
        REQUIRE(keys.insert(key).second);
        REQUIRE(gn_pair_partner(key, place) == (lower == place ? place + distance : lower));
        const std::uint32_t other = lower == place ? place + distance : lower;
        REQUIRE(gn_pair_partner(key, other) == place);
      }
    }
    REQUIRE(gn_pair_key(4.0F, 1, place) > *keys.rbegin());
  }
}

TEST_CASE("equal triangles merge in pairs, so that their tree is as shallow as can be") {
  const auto copies = gnomon::test::repeated(gnomon::test::soup(1, 151)[0], 512);
  BuildOptions options = fast();
  options.max_leaf_size = 1;
  REQUIRE(gnomon::stats_of(require_sound(copies, options), options).max_depth == 9);
}

TEST_CASE("depth stays below 64 + log2 n where every round merges but two") {
  // Boxes that double in size: each is nearer to the smaller ones before it than to the next.
  Triangles triangles;
  for (int i = 0; i < 512; ++i) {
    const float x = std::ldexp(1.0F, i % 90 - 45);
    triangles.push_back(gnomon::test::triangle({x, 0, 0}, {x * 1.5F, 0, 0}, {x, x, 0}));
  }
  BuildOptions options = fast();
  options.max_leaf_size = 1;
  REQUIRE(gnomon::stats_of(require_sound(triangles, options), options).max_depth <= 64 + 9);
}

TEST_CASE("what the fast builder cannot heed is refused") {
  const auto refused = [](const BuildOptions& options, const std::string& word) {
    REQUIRE_THROWS_WITH(gnomon::build_reference(gnomon::test::soup(3, 1), options),
                        Catch::Contains("builder fast") && Catch::Contains(word));
  };
  BuildOptions options = fast();
  options.axes = gnomon::AxisPolicy::kLsph;
  refused(options, "sah+lsph");
  options = fast();
  options.measure.weights[0] = 2.0F;
  refused(options, "pah");
  options = fast();
  options.published_leaves.on = true;
  refused(options, "published_leaves");
  options = fast();
  options.median_depth = 10;
  refused(options, "median_depth");
  options = fast();
  options.builder = static_cast<gnomon::Builder>(7);
  REQUIRE_THROWS_WITH(gnomon::build_reference({}, options), Catch::Contains("builder"));
}

TEST_CASE("the fast builder refuses bad coordinates with the first triangle's number") {
  auto triangles = gnomon::test::soup(900, 152);
  triangles[700].v2[1] = INFINITY;
  triangles[800].v0[0] = -1e15F;
  REQUIRE_THROWS_WITH(gnomon::build_reference(triangles, fast()), Catch::Contains("triangle 700"));
}
