// Batches and rays that one launch does not finish.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/device/trace_device.h"
#include "support/device.h"
#include "support/shapes.h"

using gnomon::test::context;
using gnomon::test::ray;

namespace {

// `count` triangles behind one another whose boxes a ray along (0.8, 0.8, z) meets, though not the triangles,
// and behind them all one that it hits.
std::vector<GnTriangle> corridor(std::uint32_t count) {
  std::vector<GnTriangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto z = static_cast<float>(i);
    triangles.push_back(gnomon::test::triangle({0, 0, z}, {1, 0, z}, {0, 1, z}));
  }
  triangles.push_back(gnomon::test::triangle({0, 0, 5000}, {2, 0, 5000}, {0, 2, 5000}));
  return triangles;
}

void require_the_end_of_the_corridor_found(std::uint32_t count, std::uint32_t step_limit) {
  CAPTURE(count, step_limit);
  const std::vector<GnTriangle> triangles = corridor(count);
  const std::vector<GnRay> rays = {
      ray({0.8F, 0.8F, -1}, {0, 0, 1}), ray({0.8F, 0.8F, -1}, {0, 0, 1}, 0, 4000),
      ray({0.1F, 0.1F, -1}, {0, 0, 1}), ray({std::nanf(""), 0.1F, -1}, {0, 0, 1}),
      ray({0.7F, 0.7F, -1}, {0, 0, 1})};
  const auto tree = gnomon::build_device(context(), triangles);
  gnomon::TraceOptions options;
  options.step_limit = step_limit;
  options.counters = true;
  const gnomon::Tracer tracer(context(), tree, options);
  const auto closest = tracer.closest(rays);
  const auto any = tracer.any(rays);
  for (const std::size_t through : {0U, 4U}) {
    REQUIRE(closest.hits[through].t == 5001.0F);
    REQUIRE(closest.hits[through].primitive == count);
    REQUIRE(closest.counters[through].triangles == count + 1);
    REQUIRE(any.occluded[through] == 1);
  }
  REQUIRE(closest.hits[1].primitive == GN_NONE);
  REQUIRE(any.occluded[1] == 0);
  REQUIRE(closest.hits[2].primitive == 0);
  REQUIRE(closest.invalid_rays == 1);
  REQUIRE(any.invalid_rays == 1);
}

}  // namespace

TEST_CASE("a ray that passes thousands of triangles before its hit finds it, in one go and in passes",
          "[serial][portable]") {
  for (const std::uint32_t step_limit : {0U, 1U << 20U, 700U, 100U})
    require_the_end_of_the_corridor_found(3000, step_limit);
}

TEST_CASE("passes keep to their buffers", "[memcheck]") {
  require_the_end_of_the_corridor_found(60, 25);
}

TEST_CASE("batches larger than one launch are traced whole") {
  const auto triangles = gnomon::test::grid(1, 0.0F);
  std::vector<GnRay> rays((1U << 20U) + 1000U, ray({0.3F, 1, 0.6F}, {0, -1, 0}));
  rays.back() = ray({0.3F, 4, 0.6F}, {0, -1, 0});
  const auto tree = gnomon::build_device(context(), triangles);
  const gnomon::Tracer tracer(context(), tree, {});
  const auto result = tracer.closest(rays);
  REQUIRE(result.hits.front().t == 1.0F);
  REQUIRE(result.hits[1U << 20U].t == 1.0F);
  REQUIRE(result.hits.back().t == 4.0F);
}
