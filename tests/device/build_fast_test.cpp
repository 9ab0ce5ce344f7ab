// The fast builder on the device against its reference: the same bytes, whatever the device, flavour or cut.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/oracle.h"
#include "support/device.h"
#include "support/same_tree.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::Bvh;
using gnomon::test::context;
using gnomon::test::require_same;

namespace {

BuildOptions fast(std::uint32_t work_group_size, std::uint32_t chunk_size = 0) {
  BuildOptions options;
  options.builder = gnomon::Builder::kFast;
  options.work_group_size = work_group_size;
  options.chunk_size = chunk_size;
  return options;
}

}  // namespace

TEST_CASE("the serial flavour builds the fast reference's tree from every awkward input",
          "[portable][fast]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, fast(1));
    require_same(triangles, fast(1, 64));
  }
}

TEST_CASE("the cooperative flavour builds the same fast tree, of several segments too",
          "[serial][portable][fast]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, fast(16, 64));
  }
  for (const std::uint32_t count : {511U, 512U, 513U, 1500U, 4000U}) {
    CAPTURE(count);
    require_same(gnomon::test::soup(count, 51), fast(1, 200));
    require_same(gnomon::test::soup(count, 51), fast(16, 200));
  }
}

// Few triangles: the simulator that watches every access takes its time.
TEST_CASE("small fast trees in both flavours keep to their buffers", "[memcheck][fast]") {
  require_same(gnomon::test::soup(70, 58), fast(1, 64));
  require_same(gnomon::test::soup(70, 58), fast(8, 64));
  require_same(gnomon::test::repeated(gnomon::test::soup(1, 59)[0], 40), fast(8));
  require_same(gnomon::test::soup(1, 60), fast(8));
}

TEST_CASE("a segment in one cell makes the device sort by finer cells, as the reference does",
          "[portable][fast]") {
  auto crowd = gnomon::test::soup(1100, 61, 0.001F);
  for (GnTriangle& t : crowd) {
    for (float* v : {t.v0, t.v1, t.v2}) {
      for (std::size_t k = 0; k < 3; ++k) v[k] *= 1e-4F;
    }
  }
  crowd.push_back(gnomon::test::triangle({9, 9, 9}, {9, 9, 8}, {9, 8, 9}));
  require_same(crowd, fast(1));
  require_same(crowd, fast(16, 100));
}

TEST_CASE("the fast tree does not depend on how the work is cut", "[fast]") {
  const auto triangles = gnomon::test::soup(70000, 52);
  const std::string expected = gnomon::tree_hash(gnomon::build_reference(triangles, fast(1)));
  for (const BuildOptions& options : {fast(0), fast(1, 64), fast(1, 5000), fast(16, 4096), fast(64)}) {
    // A thousand chunks' counts are more than devices that end loops can add up.
    if (context().device().loop_limit != 0 && options.chunk_size == 64) continue;
    CAPTURE(options.work_group_size, options.chunk_size);
    const auto tree = gnomon::build_device(context(), triangles, options);
    REQUIRE(gnomon::tree_hash(gnomon::download_bvh(context(), tree)) == expected);
  }
}

TEST_CASE("leaf size, costs and bins mean the same on the device for fast trees", "[unlimited][fast]") {
  const auto triangles = gnomon::test::soup(3000, 53);
  for (const std::uint32_t leaf : {1U, 4U, 255U}) {
    for (const float triangle_cost : {0.25F, 1.0F, 4.0F}) {
      CAPTURE(leaf, triangle_cost);
      BuildOptions options = fast(leaf == 4 ? 16 : 1);
      options.max_leaf_size = leaf;
      options.cost_triangle = triangle_cost;
      options.bins = leaf == 4 ? 5 : 16;
      if (leaf == 255) options.cost_traversal = 1000.0F;
      require_same(triangles, options);
    }
  }
}

TEST_CASE("rays through fast trees hit what the oracle hits", "[portable][fast]") {
  const auto triangles = gnomon::test::soup(1200, 62, 1.0F);
  const auto rays = gnomon::test::random_rays(300, 63);
  const auto tree = gnomon::build_device(context(), triangles, fast(0));
  const auto hits = gnomon::Tracer(context(), tree).closest(rays).hits;
  std::size_t found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    const auto expected = gnomon::oracle_closest(rays[i], triangles);
    REQUIRE(hits[i].primitive == expected.primitive);
    found += expected.primitive != GN_NONE ? 1 : 0;
  }
  REQUIRE(found > 50);
}

TEST_CASE("a fast build reports its stages and a memory query that holds", "[fast]") {
  const auto triangles = gnomon::test::soup(30000, 54);
  gnomon::BuildReport report;
  const auto tree = gnomon::build_device(context(), triangles, fast(0), &report);
  REQUIRE(report.total_ms > 0.0);
  std::vector<std::string> names;
  for (const auto& [name, ms] : report.stages) names.push_back(name);
  if (context().profiles()) {
    REQUIRE(names ==
            std::vector<std::string>{"bound", "codes", "sort", "merge", "assemble", "tree over clusters"});
  }
  std::uint64_t stays = 0;
  std::uint64_t scratch = 0;
  bool clusters = false;
  for (const auto& need : gnomon::build_memory(context().device(), triangles.size(), fast(0))) {
    (need.scratch ? scratch : stays) += need.bytes;
    clusters |= need.name == "clusters: sparse_nodes" && need.bytes >= 64 * triangles.size() / 64;
  }
  REQUIRE(clusters);
  REQUIRE(tree.bytes() <= stays);
  REQUIRE(report.scratch_bytes == scratch);
}

TEST_CASE("the fast builder refuses on the device what its reference refuses", "[portable][fast]") {
  auto triangles = gnomon::test::soup(5000, 55);
  triangles[4000].v1[2] = std::nanf("");
  triangles[4500].v0[0] = INFINITY;
  REQUIRE_THROWS_WITH(gnomon::build_device(context(), triangles, fast(0)), Catch::Contains("triangle 4000"));
  BuildOptions options = fast(0);
  options.axes = gnomon::AxisPolicy::kLsph;
  REQUIRE_THROWS_WITH(gnomon::build_device(context(), triangles, options), Catch::Contains("builder fast"));
  try {
    static_cast<void>(gnomon::build_device(context(), gnomon::test::soup(2000, 56), fast(0), nullptr,
                                           [](auto, double) { return false; }));
    FAIL("was not cancelled");
  } catch (const gnomon::Error& error) {
    REQUIRE(error.code() == gnomon::ErrorCode::kCancelled);
  }
}

TEST_CASE("a device that ends loops builds small fast trees and refuses large ones", "[fast]") {
  gnomon::cl::DeviceInfo limited = context().device();
  limited.loop_limit = 65535;
  REQUIRE_FALSE(gnomon::build_memory(limited, 10000, fast(1)).empty());
  REQUIRE_THROWS_WITH(gnomon::build_memory(limited, 10'000'000, fast(1)),
                      Catch::Contains("ends loops") && Catch::Contains("builder balanced"));
}
