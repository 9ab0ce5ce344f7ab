// Reinsertion on the device against its reference: the same bytes, whatever the device.
#include "gnomon/device/optimise_device.h"

#include <catch2/catch.hpp>

#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/areas_of_rays.h"
#include "support/device.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::OptimiseOptions;
using gnomon::test::context;

namespace {

using Triangles = std::vector<GnTriangle>;

OptimiseOptions every_node(std::uint32_t passes = 20) {
  OptimiseOptions options;
  options.share = 1.0F;
  options.max_passes = passes;
  options.least_gain = 0.0F;
  return options;
}

// Demands the reference's bytes and returns how they differ from the tree before.
bool require_same(const Triangles& triangles, const BuildOptions& build, const OptimiseOptions& options) {
  const Bvh before = gnomon::build_reference(triangles, build);
  const auto tree =
      gnomon::optimise_device(context(), gnomon::upload_bvh(context(), before, triangles), options);
  const Bvh expected = gnomon::optimise_reference(before, options);
  const Bvh device = gnomon::download_bvh(context(), tree);
  REQUIRE(device.primitives == expected.primitives);
  REQUIRE(tree_hash(device) == tree_hash(expected));
  REQUIRE(tree.max_depth == gnomon::stats_of(expected, build).max_depth);
  const auto corners =
      context().download_values<GnLeafTriangle>(tree.leaf_triangles, device.primitives.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    CAPTURE(i);
    REQUIRE(corners[i].primitive == device.primitives[i]);
    for (int k = 0; k < 3; ++k) REQUIRE(corners[i].v1[k] == triangles[corners[i].primitive].v1[k]);
  }
  return tree_hash(device) != tree_hash(before);
}

// Halved by count from the root on: much to move.
BuildOptions poor(std::uint32_t leaf = 1) {
  BuildOptions options;
  options.median_depth = 1;
  options.max_leaf_size = leaf;
  return options;
}

}  // namespace

TEST_CASE("the device optimises every awkward input's tree as the reference does", "[portable][optimise]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, {}, every_node());
    require_same(triangles, poor(), every_node(3));
  }
}

TEST_CASE("poor trees move much, and the same on every device", "[portable][optimise]") {
  REQUIRE(require_same(gnomon::test::soup(1500, 211, 0.2F), poor(), every_node(4)));
  REQUIRE(require_same(gnomon::test::soup(1500, 212, 0.2F), poor(4), {}));
}

TEST_CASE("nodes that found no better place are left alone until something near moves, as in the reference",
          "[portable][optimise]") {
  OptimiseOptions patient = every_node();
  patient.leave_settled = true;
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, poor(), patient);
  }
  REQUIRE(require_same(gnomon::test::soup(1500, 222, 0.2F), poor(), patient));
  patient.share = 0.25F;
  REQUIRE(require_same(gnomon::test::soup(5000, 223, 0.2F), poor(4), patient));
}

TEST_CASE("large trees are cut into subtrees and optimised as the reference's", "[unlimited][optimise]") {
  REQUIRE(require_same(gnomon::test::soup(30000, 213, 0.2F), {}, every_node(2)));
  OptimiseOptions from_above;
  from_above.face_weights = {0.2F, 1.0F, 0.1F};
  REQUIRE(require_same(gnomon::test::soup(30000, 214, 0.2F), {}, from_above));
}

TEST_CASE("what areas see of boxes moves nodes as in the reference, with depth maps and without",
          "[unlimited][optimise]") {
  const Triangles triangles = gnomon::test::soup(600, 224, 0.4F);
  const auto areas = gnomon::test::areas_around(triangles);
  OptimiseOptions options = every_node(3);
  for (const auto& area : areas) {
    options.areas = {area};
    REQUIRE(require_same(triangles, poor(), options));
  }
  options.areas = areas;
  REQUIRE(require_same(triangles, poor(), options));
  for (const auto& [name, some] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    static_cast<void>(require_same(some, {}, options));
  }
}

TEST_CASE("sampled segments move nodes as in the reference, by themselves and beside areas",
          "[unlimited][optimise]") {
  const Triangles triangles = gnomon::test::soup(600, 226, 0.4F);
  OptimiseOptions options = every_node(3);
  for (const std::uint32_t count : {1U, 7U, 300U}) {
    CAPTURE(count);
    options.segments = gnomon::test::random_rays(count, 227, 0.0F, 10.0F);
    REQUIRE(require_same(triangles, poor(), options));
  }
  for (const auto& [name, some] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    static_cast<void>(require_same(some, {}, options));
  }
  options.areas = gnomon::test::areas_around(triangles);
  REQUIRE(require_same(triangles, poor(), options));
}

TEST_CASE("a device that ends loops is not asked to weigh boxes by many segments", "[portable]") {
  const Triangles triangles = gnomon::test::soup(20, 228);
  OptimiseOptions options;
  options.segments = gnomon::test::random_rays(512, 229);
  const auto tree = gnomon::upload_bvh(context(), gnomon::build_reference(triangles), triangles);
  if (context().device().loop_limit != 0) {
    REQUIRE_THROWS_WITH(gnomon::optimise_device(context(), tree, options), Catch::Contains("512 segments"));
  } else {
    REQUIRE(gnomon::optimise_device(context(), tree, options).triangle_count == 20);
  }
}

TEST_CASE("a few nodes are moved by what segments meet within their buffers", "[memcheck][optimise]") {
  OptimiseOptions options = every_node(1);
  options.segments = gnomon::test::random_rays(9, 230);
  static_cast<void>(require_same(gnomon::test::soup(30, 231), poor(), options));
}

TEST_CASE("a few nodes are moved by what areas see within their buffers", "[memcheck][optimise]") {
  const Triangles triangles = gnomon::test::soup(30, 225);
  OptimiseOptions options = every_node(1);
  options.areas = gnomon::test::areas_around(triangles);
  static_cast<void>(require_same(triangles, poor(), options));
}

TEST_CASE("a pass the device must take back leaves the reference's tree", "[portable][optimise]") {
  OptimiseOptions options = every_node();
  options.max_depth = 1;
  static_cast<void>(require_same(gnomon::test::soup(500, 215, 2.0F), poor(), options));
  Triangles chain;
  for (int i = 0; i < 64; ++i) {
    const float x = std::ldexp(1.0F, i % 40 - 20);
    chain.push_back(gnomon::test::triangle({0, 0, 0}, {x, 0, 0}, {x, x, x}));
  }
  REQUIRE_FALSE(require_same(chain, poor(), options));
}

// Few triangles: the simulator that watches every access takes its time.
TEST_CASE("optimising small trees keeps to its buffers", "[memcheck][optimise]") {
  require_same(gnomon::test::soup(40, 216), poor(), every_node(2));
  require_same(gnomon::test::soup(60, 217), poor(4), every_node(1));
  require_same(gnomon::test::soup(1, 218), {}, every_node());
}

TEST_CASE("a leaf's copies of a triangle go, on the device as in the reference",
          "[portable][memcheck][optimise]") {
  const Triangles triangles = gnomon::test::soup(6, 219);
  Bvh before;
  before.nodes = {
      {{0, 0, 0}, 1, {12, 1, 1}, 0}, {{0, 0, 0}, 0, {1, 1, 1}, 4}, {{11, 0, 0}, 4, {12, 1, 1}, 3}};
  before.primitives = {5, 3, 5, 5, 3, 3, 4};
  const auto tree = gnomon::optimise_device(context(), gnomon::upload_bvh(context(), before, triangles));
  REQUIRE(tree.triangle_count == 4);
  REQUIRE(tree_hash(gnomon::download_bvh(context(), tree)) == tree_hash(gnomon::optimise_reference(before)));
}

TEST_CASE("optimised trees are traced to the same hits", "[portable][optimise]") {
  const Triangles triangles = gnomon::test::soup(1000, 220, 0.6F);
  const auto rays = gnomon::test::random_rays(300, 221);
  const auto before = gnomon::upload_bvh(context(), gnomon::build_reference(triangles, poor()), triangles);
  const auto after = gnomon::optimise_device(context(), before, every_node());
  const auto expected = gnomon::Tracer(context(), before).closest(rays).hits;
  const auto hits = gnomon::Tracer(context(), after).closest(rays).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(hits[i].primitive == expected[i].primitive);
    REQUIRE(hits[i].t == expected[i].t);
  }
}

TEST_CASE("what cannot be optimised on a device is refused", "[optimise]") {
  gnomon::cl::DeviceInfo limited = context().device();
  limited.loop_limit = 65535;
  REQUIRE_NOTHROW(gnomon::heed_optimise_limit(limited, 5000));
  REQUIRE_THROWS_WITH(gnomon::heed_optimise_limit(limited, 100000), Catch::Contains("ends loops"));
  OptimiseOptions options;
  options.share = 2.0F;
  REQUIRE_THROWS_WITH(gnomon::optimise_device(context(), {}, options), Catch::Contains("share"));
}
