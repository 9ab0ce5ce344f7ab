// Regions beside a tree of all triangles: what is refused, and rays that are in none.
#include "gnomon/tree/regions.h"

#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/tree/refit.h"
#include "support/region_trees.h"

using gnomon::region_of;
using gnomon::TreeSize;
using gnomon::WideBvh;

namespace {

gnomon::InfluenceArea box(double half) {
  gnomon::PlaneWindow window;
  window.point = {5, 5, 5.0 - half};
  window.half_width = window.half_height = half;
  window.depth = 2.0 * half;
  return gnomon::InfluenceArea::plane(window);
}

}  // namespace

TEST_CASE("a ray is of the first region that has all of it within its range, and of none if it is no ray") {
  const auto triangles = gnomon::test::soup(300, 760, 0.5F);
  const auto trees = gnomon::test::region_trees(triangles, {box(1), box(3)});
  const std::vector<gnomon::Region> regions{trees[0].region, trees[1].region};
  const auto at = [&](const GnRay& ray) {
    REQUIRE(region_of(regions, ray) == region_of(trees, ray));
    return region_of(regions, ray);
  };
  using gnomon::test::ray;
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, 0.0F, 0.9F)) == 0);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, 0.0F, 1.1F)) == 1);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, 1.1F, 2.9F)) == 1);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, -0.9F, 0.9F)) == 0);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, -1.1F, 0.9F)) == 1);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0}, 0.0F, 3.1F)) == GN_NONE);
  REQUIRE(at(ray({5, 5, 5}, {0, 1, 0})) == GN_NONE);
  REQUIRE(at(ray({5, 1, 5}, {0, 1, 0}, 3.5F, 4.5F)) == 0);
  REQUIRE(at(ray({5, 5, 5}, {0, 0, 0}, 0.0F, 0.1F)) == GN_NONE);
  REQUIRE(at(ray({NAN, 5, 5}, {0, 1, 0}, 0.0F, 0.1F)) == GN_NONE);
  REQUIRE(at(ray({5, 5, 5}, {0, NAN, 0}, 0.0F, 0.1F)) == GN_NONE);
  REQUIRE(region_of(std::span<const gnomon::Region>(), ray({5, 5, 5}, {0, 1, 0})) == GN_NONE);
}

TEST_CASE(
    "trees are not joined where links cannot name all triangles, nor twice, nor without a region each") {
  const TreeSize half{1, GN_MAX_PLACES / 2 + 1};
  REQUIRE_NOTHROW(gnomon::check_join(std::vector<TreeSize>{half, {1, GN_MAX_PLACES / 2 - 1}}, 1));
  REQUIRE_THROWS_WITH(gnomon::check_join(std::vector<TreeSize>{half, half}, 1),
                      Catch::Contains("more than links can name"));
  const auto triangles = gnomon::test::soup(300, 761, 0.5F);
  const auto trees = gnomon::test::region_trees(triangles, {box(2)});
  const WideBvh all = gnomon::collapse_reference(gnomon::build_reference(triangles), triangles);
  const std::vector<WideBvh> local{gnomon::collapse_reference(trees[0].bvh, triangles)};
  const std::vector<gnomon::Region> regions{trees[0].region};
  REQUIRE_THROWS_WITH(join_reference(all, local, {}), Catch::Contains("1 local trees for 0 regions"));
  WideBvh joined = join_reference(all, local, regions);
  REQUIRE(joined.regions[0].root == all.nodes.size());
  REQUIRE(joined.places() == all.places() + local[0].places());
  REQUIRE_THROWS_WITH(join_reference(joined, local, regions), Catch::Contains("local ones"));
  REQUIRE_THROWS_WITH(refit_reference(joined, triangles), Catch::Contains("local ones"));
}
