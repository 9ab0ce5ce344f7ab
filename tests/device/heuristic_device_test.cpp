// Every measure and axis policy on the device, against the reference builder: the same bytes.
#include <catch2/catch.hpp>

#include "gnomon/device/build_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/device.h"
#include "support/measures.h"
#include "support/same_tree.h"
#include "support/shapes.h"

using gnomon::AxisPolicy;
using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::test::context;

namespace {

// Hash of the tree, after device and reference agreed on it.
std::string same_tree(const std::vector<GnTriangle>& triangles, const BuildOptions& options) {
  CAPTURE(gnomon::heuristic_name(options), options.work_group_size);
  return gnomon::test::require_same(triangles, options);
}

}  // namespace

// Weighing one node by a window or from a point takes more turns than a device that ends long loops allows.
TEST_CASE("every measure builds the reference's tree, through large nodes and small ones", "[unlimited]") {
  const auto triangles = gnomon::test::soup(1500, 91);
  std::vector<std::string> hashes;
  for (const auto& [name, measure] : gnomon::test::every_measure()) {
    CAPTURE(name);
    BuildOptions options;
    options.measure = measure;
    options.work_group_size = 1;
    options.subtree_size = 256;
    options.chunk_size = 200;
    hashes.push_back(same_tree(triangles, options));
  }
  // Different measures see different boxes: a measure that is not heeded would repeat another's tree.
  std::sort(hashes.begin(), hashes.end());
  REQUIRE(std::unique(hashes.begin(), hashes.end()) == hashes.end());
}

// One work-group builds the whole tree where the published leaf rule holds: too much for a device that ends
// long loops. That rule and published planes know of a measure only what it says of boxes: a measure of each
// way to say it is enough, and spares compiling the others once more.
TEST_CASE("axis policies, published and repaired, choose what the reference chooses", "[unlimited]") {
  const auto triangles = gnomon::test::soup(700, 92);
  for (const auto& [name, measure] : gnomon::test::every_measure()) {
    const bool published_too = measure.kind == GN_MEASURE_LINEAR || measure.kind == GN_MEASURE_WINDOW ||
                               measure.kind == GN_MEASURE_SOLID_ANGLE;
    for (const AxisPolicy axes : {AxisPolicy::kSpfh, AxisPolicy::kLsph}) {
      for (const bool repaired : {false, true}) {
        if (!repaired && !published_too) continue;
        CAPTURE(name, repaired);
        BuildOptions options;
        options.measure = measure;
        options.axes = axes;
        options.policy.repaired = repaired;
        options.published_leaves.on = !repaired;
        options.work_group_size = 1;
        same_tree(triangles, options);
      }
    }
  }
}

namespace {

void require_same_in_groups(std::size_t which, AxisPolicy axes) {
  const auto measures = gnomon::test::every_measure();
  CAPTURE(measures[which].first);
  BuildOptions options;
  options.measure = measures[which].second;
  options.axes = axes;
  options.work_group_size = 16;
  options.subtree_size = 64;
  options.chunk_size = 64;
  same_tree(gnomon::test::soup(300, 93), options);
}

}  // namespace

TEST_CASE("the cooperative flavour heeds linear measures and policies", "[portable]") {
  for (const AxisPolicy axes : {AxisPolicy::kAll, AxisPolicy::kSpfh, AxisPolicy::kLsph})
    require_same_in_groups(1, axes);
}

// A group's work-items each measure boxes of their own, by whichever measure: its kinds are told apart above.
// Each compiles for 13 s.
TEST_CASE("the cooperative flavour heeds windows and points", "[unlimited]") {
  for (const std::size_t which : {2U, 8U}) require_same_in_groups(which, AxisPolicy::kAll);
}

// Points on a line have boxes without surface: every split costs nothing and ties at nothing.
TEST_CASE("of splits that cost nothing the most even one is chosen") {
  std::vector<GnTriangle> points;
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i * i);
    points.push_back(gnomon::test::triangle({x, 1, 2}, {x, 1, 2}, {x, 1, 2}));
  }
  BuildOptions options;
  options.measure = gnomon::test::every_measure()[1].second;
  REQUIRE(options.measure.breaks_ties == 1);
  options.work_group_size = 1;
  same_tree(points, options);
  const Bvh tree = gnomon::build_reference(points, options);
  REQUIRE(tree.nodes[0].count == 0);
  // Bins of 95.06 wide: 20 points are before 380 = 4 of them, and no plane halves better.
  const auto left_of = [&](std::uint32_t node) {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> stack{node};
    while (!stack.empty()) {
      const GnNode& at = tree.nodes[stack.back()];
      stack.pop_back();
      if (at.count > 0) {
        count += at.count;
      } else {
        stack.push_back(at.first);
        stack.push_back(at.first + 1);
      }
    }
    return count;
  };
  REQUIRE(left_of(tree.nodes[0].first) == 20);
}

TEST_CASE("a device that ends long loops refuses measures that need them") {
  gnomon::cl::DeviceInfo limited = context().device();
  limited.loop_limit = 65535;
  BuildOptions options;
  options.measure = gnomon::test::every_measure()[2].second;
  REQUIRE_THROWS_WITH(gnomon::build_memory(limited, 1000, options), Catch::Contains("pah-window"));
}

TEST_CASE("the published leaf rule ends where it says", "[unlimited]") {
  const auto triangles = gnomon::test::soup(400, 94);
  BuildOptions options;
  options.axes = AxisPolicy::kLsph;
  options.measure.area_share = 0.0F;
  options.policy.repaired = false;
  options.policy.quality_threshold = 0.99F;
  options.published_leaves.on = true;
  options.bins = 40;
  const std::string plain = same_tree(triangles, options);
  const auto stats = gnomon::stats_of(gnomon::build_reference(triangles, options), options);
  REQUIRE(stats.leaves > 300);  // down to single triangles
  const auto with = [&](auto set) {
    BuildOptions changed = options;
    set(changed.published_leaves);
    return same_tree(triangles, changed);
  };
  REQUIRE(with([](auto& leaves) { leaves.min_split = 6; }) != plain);
  REQUIRE(with([](auto& leaves) { leaves.max_depth = 5; }) != plain);
  REQUIRE(with([](auto& leaves) { leaves.max_cost = 0.05F; }) != plain);
  REQUIRE(with([](auto& leaves) { leaves.max_probability = 0.02F; }) != plain);
  REQUIRE(with([](auto& leaves) { leaves.max_area = 10.0F; }) != plain);
  // The children's probabilities reach them where all three axes are tried, too.
  options.axes = AxisPolicy::kAll;
  const std::string all_axes = same_tree(triangles, options);
  REQUIRE(with([](auto& leaves) { leaves.max_probability = 0.02F; }) != all_axes);
}
