// Local trees behind a tree of all triangles, on the device: joined to the reference's bytes, and traced to
// the bits of the tree of all by itself.
#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/device/join_wide.h"
#include "gnomon/device/refit_device.h"
#include "support/bundles.h"
#include "support/flavours.h"
#include "support/region_trees.h"

using gnomon::DeviceWideBvh;
using gnomon::InfluenceArea;
using gnomon::TraceFlavour;
using gnomon::WideBvh;
using gnomon::test::context;
using gnomon::test::Rays;
using gnomon::test::region_trees;
using gnomon::test::Traced;
using gnomon::test::Triangles;

namespace {

using RegionTrees = std::vector<gnomon::RegionTree>;

DeviceWideBvh joined(const Triangles& triangles, const RegionTrees& local) {
  const auto all = gnomon::build_device(context(), triangles);
  return collapse_with_regions(context(), all, triangles, local);
}

Traced trace(const DeviceWideBvh& tree, const Rays& rays, const gnomon::TraceOptions& options) {
  const gnomon::Tracer tracer(context(), tree, options);
  return {tracer.closest(rays), tracer.any(rays)};
}

// How many rays go through local trees; all have the tree of all's answers, and the reference's visits.
std::size_t require_same_as_all(const Triangles& triangles, const RegionTrees& local, const Rays& rays) {
  const DeviceWideBvh tree = joined(triangles, local);
  const auto plain = gnomon::build_device(context(), triangles);
  const Traced expected = gnomon::test::trace(plain, rays, TraceFlavour::kWide);
  gnomon::TraceOptions how;
  for (const bool portable : {false, true}) {
    how.portable = portable;
    how.counters = false;
    how.flavour = TraceFlavour::kPacket;
    if (gnomon::test::takes_packets()) gnomon::test::require_same_answers(expected, trace(tree, rays, how));
    how.flavour = TraceFlavour::kWide;
    gnomon::test::require_same_answers(expected, trace(tree, rays, how));
    how.counters = true;
    const Traced counted = trace(tree, rays, how);
    gnomon::test::require_same_answers(expected, counted);
    gnomon::test::require_reference_work(download_wide(context(), tree), rays, counted);
  }
  std::size_t within = 0;
  for (const GnRay& ray : rays) within += region_of(local, ray) != GN_NONE ? 1 : 0;
  return within;
}

InfluenceArea corner_box(float side) {
  gnomon::PlaneWindow window;
  window.point = {0.5 * side, 0.5 * side, -1.0};
  window.half_width = window.half_height = 0.5 * side;
  window.depth = 12.0;
  return InfluenceArea::plane(window);
}

}  // namespace

TEST_CASE("local trees are joined to the reference's bytes, and hit as the tree of all does",
          "[portable][memcheck]") {
  const auto triangles = gnomon::test::soup(120, 500, 1.0F);
  const RegionTrees local = region_trees(triangles, {corner_box(4.0F), corner_box(7.0F)});
  REQUIRE(local.size() == 2);
  const DeviceWideBvh tree = joined(triangles, local);
  std::vector<WideBvh> trees;
  std::vector<gnomon::Region> regions;
  for (const auto& one : local) {
    REQUIRE(one.bvh.primitives.size() < triangles.size());
    trees.push_back(gnomon::collapse_reference(one.bvh, triangles));
    regions.push_back(one.region);
  }
  const auto all = gnomon::build_device(context(), triangles);
  const WideBvh expected =
      join_reference(gnomon::collapse_reference(download_bvh(context(), all), triangles), trees, regions);
  const WideBvh made = download_wide(context(), tree);
  REQUIRE(tree_hash(made) == tree_hash(expected));
  REQUIRE(made.depth == expected.depth);
  REQUIRE(made.regions.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(made.regions[i].root == expected.regions[i].root);
    REQUIRE(made.regions[i].root > 0);
  }
  gnomon::TraceOptions how;
  how.flavour = TraceFlavour::kWide;
  const Rays rays = gnomon::test::rays_in(corner_box(4.0F), 60, 501);
  gnomon::test::require_same_answers(gnomon::test::trace(all, rays, TraceFlavour::kThread),
                                     trace(tree, rays, how));
}

TEST_CASE("rays between points of a region's border hit what they hit in the tree of all", "[unlimited]") {
  std::uint32_t seed = 510;
  for (const double offset : {0.0, 1000.0}) {
    for (const auto& [name, area] : gnomon::test::areas_of_every_kind({offset, offset, offset})) {
      CAPTURE(name, offset);
      auto triangles = gnomon::test::scaled(gnomon::test::soup(1500, seed++, 1.0F), 1.0F,
                                            static_cast<float>(offset) - 5.0F);
      const RegionTrees local = region_trees(triangles, {area});
      const Rays rays = gnomon::test::rays_in(area, 600, seed++);
      const std::size_t within = require_same_as_all(triangles, local, rays);
      if (!local.empty()) REQUIRE(within > 20);
    }
  }
}

TEST_CASE("bundles in regions are traced as packets, whole or not", "[unlimited][packets]") {
  const auto triangles = gnomon::test::soup(1500, 530, 0.4F);
  gnomon::PointView view;
  view.eye = {5, 4, 31};
  view.direction = {0, 0, -1};
  view.fov_x = view.fov_y = 0.5;
  view.near_distance = 0.01;
  view.far_distance = 60.0;
  const RegionTrees local = region_trees(triangles, {corner_box(5.0F), InfluenceArea::point(view)});
  REQUIRE(local.size() == 2);
  std::size_t within = 0;
  for (const auto& [name, rays] : gnomon::test::bundles(3)) {
    CAPTURE(name);
    within += require_same_as_all(triangles, local, rays);
  }
  REQUIRE(within > 500);
}

TEST_CASE("a packet that is whole in a region begins at its tree's root", "[unlimited][packets]") {
  if (!gnomon::test::takes_packets()) return;
  const auto triangles = gnomon::test::soup(1500, 531, 0.4F);
  const Rays rays = gnomon::test::sun_rays(2, {0, -1, 0}, 0.5F);
  gnomon::PlaneWindow window;
  window.point = {5, 14, 5};
  window.direction = {0, -1, 0};
  window.half_width = window.half_height = 3.0;
  window.depth = 30.0;
  const RegionTrees local = region_trees(triangles, {InfluenceArea::plane(window)});
  gnomon::TraceOptions how;
  how.flavour = TraceFlavour::kPacket;
  how.counters = true;
  const auto boxes = [&](const RegionTrees& trees) {
    std::uint64_t sum = 0;
    for (const auto& counters : trace(joined(triangles, trees), rays, how).closest.counters)
      sum += counters.boxes;
    return sum;
  };
  REQUIRE(local.front().bvh.primitives.size() < 1000);
  REQUIRE(boxes(local) < boxes({}));
}

TEST_CASE("a packet of which a part leaves the region is traced through the tree of all",
          "[unlimited][packets]") {
  const auto triangles = gnomon::test::soup(1500, 532, 0.4F);
  gnomon::PlaneWindow window;
  window.direction = {0, -1, 0};
  window.up = {0, 0, 1};
  // All rays begin in it and go on where it ends.
  window.point = {5, 14, 5};
  window.half_width = window.half_height = 6.0;
  window.depth = 6.0;
  const RegionTrees above = region_trees(triangles, {InfluenceArea::plane(window)});
  REQUIRE(require_same_as_all(triangles, above, gnomon::test::sun_rays(2, {0, -1, 0}, 6.0F)) == 0);
  // Of every 64 rays, eight rows of eight, the first rows are in it.
  window.point = {5, 14, 0};
  window.half_width = 8.0;
  window.half_height = 4.9;
  window.depth = 30.0;
  const RegionTrees beside = region_trees(triangles, {InfluenceArea::plane(window)});
  const Rays rays = gnomon::test::sun_rays(1, {0, -1, 0}, 1.0F);
  const std::size_t within = require_same_as_all(triangles, beside, rays);
  REQUIRE(within >= 16);
  REQUIRE(within < rays.size());
}

TEST_CASE("of regions that have a ray the first says where it begins", "[unlimited]") {
  const auto triangles = gnomon::test::soup(1500, 533, 0.4F);
  const Rays rays = gnomon::test::rays_in(corner_box(3.0F), 300, 534);
  const std::size_t within =
      require_same_as_all(triangles, region_trees(triangles, {corner_box(3.0F), corner_box(7.0F)}), rays);
  REQUIRE(within > 100);
  REQUIRE(require_same_as_all(triangles, region_trees(triangles, {corner_box(7.0F), corner_box(3.0F)}),
                              rays) >= within);
}

TEST_CASE("joined trees are refused where their regions would be lost", "[unlimited]") {
  const auto triangles = gnomon::test::soup(200, 540);
  const RegionTrees local = region_trees(triangles, {corner_box(4.0F)});
  auto tree = joined(triangles, local);
  gnomon::TraceOptions how;
  how.flavour = TraceFlavour::kCompact;
  REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, how), Catch::Contains("local"));
  REQUIRE_THROWS_WITH(gnomon::compact_device(context(), tree), Catch::Contains("compact"));
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), tree, triangles), Catch::Contains("refitting"));
  const std::vector<DeviceWideBvh> none;
  const std::vector<gnomon::Region> one(1, local.front().region);
  REQUIRE_THROWS_WITH(join_wide(context(), tree, none, {}), Catch::Contains("joining"));
  const auto plain = joined(triangles, {});
  REQUIRE(plain.regions.empty());
  REQUIRE_THROWS_WITH(join_wide(context(), plain, none, one), Catch::Contains("0 local trees for 1 regions"));
}
