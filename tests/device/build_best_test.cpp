// The best builder on the device against its reference: the same bytes, whatever the device, flavour or cut.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/device/collapse_device.h"
#include "gnomon/device/refit_device.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/oracle.h"
#include "support/device.h"
#include "support/same_tree.h"
#include "support/shapes.h"

using gnomon::BuildOptions;
using gnomon::test::context;
using gnomon::test::require_same;

namespace {

using Triangles = std::vector<GnTriangle>;

BuildOptions best(std::uint32_t work_group_size, std::uint32_t chunk_size = 0) {
  BuildOptions options;
  options.builder = gnomon::Builder::kBest;
  options.work_group_size = work_group_size;
  options.chunk_size = chunk_size;
  return options;
}

// Small triangles and some that reach far: these are divided.
Triangles with_large_ones(std::uint32_t small, std::uint32_t large, std::uint32_t seed) {
  Triangles triangles = gnomon::test::soup(small, seed, 0.1F);
  const Triangles more = gnomon::test::soup(large, seed + 1, 5.0F);
  triangles.insert(triangles.end(), more.begin(), more.end());
  return triangles;
}

}  // namespace

TEST_CASE("both flavours build the best reference's tree from every awkward input", "[portable][best]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    require_same(triangles, best(1));
    require_same(triangles, best(16, 64));
  }
}

TEST_CASE("both flavours divide the same triangles", "[serial][portable][best]") {
  const Triangles triangles = with_large_ones(1500, 250, 231);
  require_same(triangles, best(1));
  require_same(triangles, best(16, 100));
  const auto tree = gnomon::build_device(context(), triangles, best(0));
  REQUIRE(tree.triangle_count > triangles.size());
}

TEST_CASE("corners in the planes that divide their triangles are in the device's parts", "[best]") {
  const Triangles triangles = gnomon::test::corners_in_planes(1500, 100, 233);
  require_same(triangles, best(16, 100));
  const auto tree = gnomon::build_device(context(), triangles, best(0));
  REQUIRE(tree.triangle_count > triangles.size());
}

// Few triangles: the simulator that watches every access takes its time.
TEST_CASE("small best trees in both flavours keep to their buffers", "[memcheck][best]") {
  const Triangles triangles = with_large_ones(60, 110, 232);
  REQUIRE(gnomon::build_reference(triangles, best(1)).primitives.size() > triangles.size());
  require_same(triangles, best(1, 64));
  require_same(triangles, best(8, 64));
  require_same(gnomon::test::soup(1, 234), best(8));
}

TEST_CASE("the best tree does not depend on how the work is cut", "[unlimited][best]") {
  const Triangles triangles = with_large_ones(30000, 800, 235);
  const std::string expected = gnomon::tree_hash(gnomon::build_reference(triangles, best(1)));
  for (const BuildOptions& options : {best(0), best(1, 64), best(16, 4096), best(64)}) {
    CAPTURE(options.work_group_size, options.chunk_size);
    const auto tree = gnomon::build_device(context(), triangles, options);
    REQUIRE(gnomon::tree_hash(gnomon::download_bvh(context(), tree)) == expected);
  }
}

TEST_CASE("leaf size, costs, bins and measures mean the same on the device for best trees",
          "[unlimited][best]") {
  const Triangles triangles = with_large_ones(3000, 400, 236);
  for (const std::uint32_t leaf : {1U, 4U, 255U}) {
    for (const float triangle_cost : {0.25F, 1.0F}) {
      CAPTURE(leaf, triangle_cost);
      BuildOptions options = best(leaf == 4 ? 16 : 1);
      options.max_leaf_size = leaf;
      options.cost_triangle = triangle_cost;
      options.bins = leaf == 4 ? 5 : 16;
      if (leaf == 4) options.measure.weights[1] = 3.0F;
      require_same(triangles, options);
    }
  }
}

TEST_CASE("rays through best trees hit what the oracle hits, in every flavour", "[portable][best]") {
  const Triangles triangles = with_large_ones(1200, 250, 237);
  const auto rays = gnomon::test::random_rays(400, 238);
  const auto tree = gnomon::build_device(context(), triangles, best(0));
  REQUIRE(tree.triangle_count > triangles.size());
  std::vector<gnomon::TraceOptions> flavours(1);
  flavours[0].flavour = gnomon::TraceFlavour::kThread;
  if (context().device().loop_limit == 0) {
    flavours.resize(3);
    flavours[1].flavour = gnomon::TraceFlavour::kWide;
    flavours[2].flavour = gnomon::TraceFlavour::kPacket;
  }
  const auto plain = gnomon::Tracer(context(), gnomon::build_device(context(), triangles)).closest(rays).hits;
  for (const gnomon::TraceOptions& options : flavours) {
    const gnomon::Tracer tracer(context(), tree, options);
    const auto hits = tracer.closest(rays).hits;
    const auto any = tracer.any(rays).occluded;
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i);
      const auto expected = gnomon::oracle_closest(rays[i], triangles);
      REQUIRE(hits[i].primitive == expected.primitive);
      REQUIRE(any[i] == (expected.primitive != GN_NONE ? 1 : 0));
      REQUIRE(hits[i].t == plain[i].t);
      REQUIRE(hits[i].u == plain[i].u);
      REQUIRE(hits[i].v == plain[i].v);
      found += expected.primitive != GN_NONE ? 1 : 0;
    }
    REQUIRE(found > 50);
  }
}

TEST_CASE("a best tree becomes a sound wide tree", "[unlimited][best]") {
  const Triangles triangles = with_large_ones(3000, 400, 239);
  const auto tree = gnomon::build_device(context(), triangles, best(0));
  const auto wide = gnomon::download_wide(context(), gnomon::collapse_device(context(), tree));
  if (const auto fault = gnomon::check_wide(wide, triangles, gnomon::Repeats::kAllowed)) FAIL(fault->what);
  REQUIRE(tree_hash(wide) ==
          tree_hash(gnomon::collapse_reference(gnomon::download_bvh(context(), tree), triangles)));
}

TEST_CASE("a tree of parts is not refitted", "[best]") {
  const Triangles triangles = with_large_ones(1000, 250, 240);
  auto tree = gnomon::build_device(context(), triangles, best(0));
  REQUIRE_THROWS_WITH(gnomon::refit_device(context(), tree, triangles),
                      Catch::Contains("cannot be refitted"));
}

TEST_CASE("a best build reports its stages and a memory query that holds", "[best]") {
  const Triangles triangles = with_large_ones(3000, 400, 241);
  gnomon::BuildReport report;
  const auto tree = gnomon::build_device(context(), triangles, best(0), &report);
  REQUIRE(report.total_ms > 0.0);
  std::vector<std::string> names;
  for (const auto& [name, ms] : report.stages) names.push_back(name);
  if (context().profiles()) {
    for (const char* stage : {"parts", "subtrees", "search", "renumber"})
      REQUIRE(std::find(names.begin(), names.end(), stage) != names.end());
  }
  std::uint64_t stays = 0;
  std::uint64_t scratch = 0;
  for (const auto& need : gnomon::build_memory(context().device(), triangles.size(), best(0)))
    (need.scratch ? scratch : stays) += need.bytes;
  REQUIRE(tree.bytes() <= stays);
  REQUIRE(report.scratch_bytes == scratch);
}

TEST_CASE("the best builder refuses on the device what its reference refuses", "[portable][best]") {
  auto triangles = gnomon::test::soup(2000, 242);
  triangles[1400].v1[2] = std::nanf("");
  triangles[1500].v0[0] = INFINITY;
  REQUIRE_THROWS_WITH(gnomon::build_device(context(), triangles, best(0)), Catch::Contains("triangle 1400"));
  BuildOptions options = best(0);
  options.axes = gnomon::AxisPolicy::kLsph;
  REQUIRE_THROWS_WITH(gnomon::build_device(context(), triangles, options), Catch::Contains("builder best"));
  try {
    static_cast<void>(gnomon::build_device(context(), gnomon::test::soup(1000, 243), best(0), nullptr,
                                           [](auto, double) { return false; }));
    FAIL("was not cancelled");
  } catch (const gnomon::Error& error) {
    REQUIRE(error.code() == gnomon::ErrorCode::kCancelled);
  }
  gnomon::cl::DeviceInfo limited = context().device();
  limited.loop_limit = 65535;
  REQUIRE_THROWS_WITH(gnomon::build_memory(limited, 1'000'000, best(1)), Catch::Contains("ends loops"));
}
