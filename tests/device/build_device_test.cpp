// The device builder against the reference builder: the same bytes, whatever the device, flavour or cut of
// the work.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/device/build_device.h"
#include "gnomon/shared/cost_math.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "support/device.h"
#include "support/same_tree.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::test::context;
using gnomon::test::require_same;

namespace {

BuildOptions cut(std::uint32_t work_group_size, std::uint32_t subtree_size, std::uint32_t chunk_size) {
  BuildOptions options;
  options.work_group_size = work_group_size;
  options.subtree_size = subtree_size;
  options.chunk_size = chunk_size;
  return options;
}

}  // namespace

TEST_CASE("the serial flavour builds the reference's tree from every awkward input", "[serial][portable]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, cut(1, 0, 0));
    // Small subtrees and chunks send even these through the level loop.
    require_same(triangles, cut(1, 32, 64));
  }
}

TEST_CASE("the cooperative flavour builds the same tree", "[serial][portable]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, cut(16, 32, 64));
  }
  require_same(gnomon::test::soup(1500, 51), cut(16, 256, 200));
}

TEST_CASE("triangles whose middles lie on the planes between bins go to the side they were binned on",
          "[portable]") {
  // One middle per place k whose bin number comes out as k exactly; a rounding away from it would test
  // nothing.
  for (const float extent : {16.0F, 24.0F, 1.0F, 0.7F}) {
    CAPTURE(extent);
    const float scale = gn_bin_scale(0.0F, 2.0F * extent, 16);
    std::vector<GnTriangle> triangles;
    int on_planes = 0;
    for (int k = 0; k <= 16; ++k) {
      float x = static_cast<float>(k) * extent / 16.0F;
      for (int i = 0; i < 8 && 2.0F * x * scale < static_cast<float>(k); ++i)
        x = std::nextafter(x, 2.0F * extent);
      on_planes += k > 0 && k < 16 && 2.0F * x * scale == static_cast<float>(k) ? 1 : 0;
      if (k == 16) x = extent;
      for (int copy = 0; copy < 1 + k % 3; ++copy)
        triangles.push_back(gnomon::test::triangle({x, 0, 0}, {x, 1, 0}, {x, 0, 1}));
    }
    REQUIRE(on_planes >= 8);
    BuildOptions options = cut(1, 0, 0);
    options.max_leaf_size = 1;
    require_same(triangles, options);
    options = cut(1, 32, 64);
    options.max_leaf_size = 1;
    require_same(triangles, options);
  }
}

// Few triangles: the simulator that watches every access takes its time. 70 are two chunks, a level of large
// nodes, and subtrees.
TEST_CASE("of planes that cost the same the one that divides most evenly is taken", "[serial][portable]") {
  // Points on a line have no area: all planes between them cost nothing. Their places thin out, so that the
  // most even plane is neither the first nor the middle one.
  std::vector<GnTriangle> triangles;
  for (int i = 0; i < 120; ++i) {
    const auto x = static_cast<float>(i * i);
    triangles.push_back(gnomon::test::triangle({x, 0, 0}, {x, 0, 0}, {x, 0, 0}));
  }
  for (const std::uint32_t breaks_ties : {0U, 1U}) {
    for (const std::uint32_t group : {1U, 16U}) {
      CAPTURE(breaks_ties, group);
      BuildOptions options = cut(group, 0, 0);
      options.measure.breaks_ties = breaks_ties;
      options.max_leaf_size = 1;
      require_same(triangles, options);
    }
  }
}

TEST_CASE("the serial flavour builds the same trees from a part of every awkward input", "[memcheck]") {
  for (auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    std::vector<GnTriangle> part = triangles;
    part.resize(std::min<std::size_t>(part.size(), 70));
    require_same(part, cut(1, 32, 64));
  }
  require_same(gnomon::test::soup(70, 57), cut(1, 0, 0));
}

TEST_CASE("the cooperative flavour builds the same small trees", "[memcheck]") {
  require_same(gnomon::test::soup(70, 58), cut(16, 32, 64));
  require_same(gnomon::test::grid(4), cut(16, 32, 64));
  require_same(std::vector<GnTriangle>(40, gnomon::test::soup(1, 59)[0]), cut(16, 32, 64));
}

TEST_CASE("the tree does not depend on how the work is cut") {
  const bool limited = context().device().loop_limit != 0;  // llvmpipe, which compiles and builds slowly
  const auto triangles = gnomon::test::soup(limited ? 5000 : 20000, 52);
  for (const BuildOptions& options : {cut(0, 0, 0), cut(1, 64, 64), cut(1, 1000, 333), cut(1, 1048576, 8192),
                                      cut(2, 64, 128), cut(4, 512, 512), cut(16, 1024, 512)}) {
    if (limited && (options.work_group_size == 2 || options.work_group_size == 4)) continue;
    CAPTURE(options.work_group_size, options.subtree_size, options.chunk_size);
    require_same(triangles, options);
  }
}

// Leaves of 255 triangles with 64 bins are more than a device that ends long loops can build.
TEST_CASE("bins, leaf size, costs and median depth mean the same on the device", "[unlimited]") {
  const auto triangles = gnomon::test::soup(3000, 53);
  for (const std::uint32_t bins : {2U, 5U, 8U, 16U, 64U}) {
    for (const std::uint32_t leaf : {1U, 8U, 255U}) {
      BuildOptions options = cut(1, 512, 256);
      options.bins = bins;
      options.max_leaf_size = leaf;
      options.cost_traversal = leaf == 8 ? 2.5F : 1.0F;
      options.median_depth = bins == 2 ? 5 : 64;
      CAPTURE(bins, leaf);
      require_same(triangles, options);
    }
  }
}

TEST_CASE("a mesh of shared edges and flat boxes builds alike", "[portable]") {
  require_same(gnomon::test::grid(40), cut(0, 0, 0));
}

TEST_CASE("a build reports its stages and a memory query that holds") {
  const auto triangles = gnomon::test::soup(30000, 54);
  gnomon::BuildReport report;
  const auto tree = gnomon::build_device(context(), triangles, cut(0, 1024, 2048), &report);
  REQUIRE(report.total_ms > 0.0);
  std::vector<std::string> names;
  for (const auto& [name, ms] : report.stages) names.push_back(name);
  if (context().profiles()) {
    REQUIRE(names == std::vector<std::string>{"prepare", "bin", "split", "partition", "subtrees", "compact",
                                              "gather"});
  }
  std::uint64_t stays = 0;
  std::uint64_t scratch = 0;
  for (const auto& need : gnomon::build_memory(context().device(), triangles.size(), cut(0, 1024, 2048))) {
    (need.scratch ? scratch : stays) += need.bytes;
  }
  REQUIRE(tree.bytes() <= stays);
  REQUIRE(report.scratch_bytes == scratch);
}

TEST_CASE("bad coordinates are refused with the first triangle's number") {
  auto triangles = gnomon::test::soup(5000, 55);
  for (const float bad : {std::nanf(""), INFINITY, -1e15F}) {
    triangles[4000].v1[2] = bad;
    triangles[4500].v0[0] = bad;
    REQUIRE_THROWS_WITH(gnomon::build_device(context(), triangles), Catch::Contains("triangle 4000"));
  }
}

TEST_CASE("options out of range are refused before anything is allocated") {
  BuildOptions options;
  options.bins = 1000;
  REQUIRE_THROWS_WITH(gnomon::build_device(context(), gnomon::test::soup(3, 1), options),
                      Catch::Contains("bins"));
  options = {};
  options.work_group_size = 256;
  if (context().device().max_work_group < 256) {
    REQUIRE_THROWS_WITH(gnomon::build_device(context(), gnomon::test::soup(3, 1), options),
                        Catch::Contains("work_group_size"));
  }
}

TEST_CASE("a scene that does not fit is refused with the buffer's name and size") {
  gnomon::cl::DeviceInfo small = context().device();
  small.max_allocation = 100000;
  const auto needs = gnomon::build_memory(small, 100000, {});
  bool named = false;
  for (const auto& need : needs) {
    if (const auto reason = gnomon::cl::why_not_fit(small, need.name, need.bytes)) {
      REQUIRE(reason->find(need.name) != std::string::npos);
      REQUIRE(reason->find(std::to_string(need.bytes)) != std::string::npos);
      named = true;
    }
  }
  REQUIRE(named);
  REQUIRE_THROWS_WITH(gnomon::build_memory(small, 3000000000ULL, {}), Catch::Contains("2147483647"));
}

TEST_CASE("a device that ends long loops gets smaller pieces, or a refusal that says why") {
  gnomon::cl::DeviceInfo free = context().device();
  free.loop_limit = 0;
  gnomon::cl::DeviceInfo limited = free;
  limited.loop_limit = 65535;
  const auto bytes_of = [](const std::vector<gnomon::BufferNeed>& needs, const std::string& name) {
    for (const auto& need : needs) {
      if (need.name == name) return need.bytes;
    }
    return std::uint64_t{0};
  };
  const auto usual = gnomon::build_memory(free, 1'000'000, cut(1, 1024, 8192));
  const auto small = gnomon::build_memory(limited, 1'000'000, cut(1, 1024, 8192));
  REQUIRE(bytes_of(small, "tasks") > bytes_of(usual, "tasks"));
  BuildOptions options = cut(1, 0, 0);
  options.bins = 64;
  options.max_leaf_size = 255;
  REQUIRE_THROWS_WITH(gnomon::build_memory(limited, 1000, options),
                      Catch::Contains("ends loops") && Catch::Contains("42"));
}

TEST_CASE("cancelling stops a build with its own error code") {
  const auto triangles = gnomon::test::soup(2000, 56);
  try {
    static_cast<void>(
        gnomon::build_device(context(), triangles, {}, nullptr, [](auto, double) { return false; }));
    FAIL("was not cancelled");
  } catch (const gnomon::Error& error) {
    REQUIRE(error.code() == gnomon::ErrorCode::kCancelled);
  }
}

TEST_CASE("the caller's triangles may change as soon as a build has returned", "[portable]") {
  for (const auto builder : {gnomon::Builder::kBalanced, gnomon::Builder::kFast, gnomon::Builder::kBest}) {
    CAPTURE(to_string(builder));
    BuildOptions options;
    options.builder = builder;
    // Devices that end loops optimise only small trees.
    const auto original = gnomon::test::soup(builder == gnomon::Builder::kBest ? 1000 : 20000, 5);
    std::vector<GnTriangle> triangles = original;
    const auto tree = gnomon::build_device(context(), triangles, options);
    std::fill(triangles.begin(), triangles.end(), GnTriangle{});
    const auto order = context().download_values<std::uint32_t>(tree.order, tree.triangle_count);
    const auto leaves = context().download_values<GnLeafTriangle>(tree.leaf_triangles, tree.triangle_count);
    for (std::uint32_t i = 0; i < tree.triangle_count; ++i) {
      REQUIRE(leaves[i].primitive == order[i]);
      REQUIRE(std::equal(leaves[i].v1, leaves[i].v1 + 3, original[order[i]].v1));
    }
  }
}

TEST_CASE("a tree survives the way to the host and back") {
  const auto triangles = gnomon::test::soup(1000, 57);
  const Bvh bvh = gnomon::build_reference(triangles);
  const auto tree = gnomon::upload_bvh(context(), bvh, triangles);
  REQUIRE(gnomon::tree_hash(gnomon::download_bvh(context(), tree)) == gnomon::tree_hash(bvh));
  const Bvh nothing = gnomon::download_bvh(context(), gnomon::upload_bvh(context(), {}, {}));
  REQUIRE(nothing.nodes.empty());
}
