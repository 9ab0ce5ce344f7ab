// The compact flavour's answers are the binary tree's bits and the oracle's, with as much work as the wide
// one's. That it agrees with every other flavour on every shape is in wide_device_test.cpp.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "support/flavours.h"

using gnomon::TraceFlavour;
using namespace gnomon::test;

namespace {

void require_equal_to_thread(const Triangles& triangles, const Rays& rays,
                             const gnomon::BuildOptions& build = {}) {
  const auto tree = gnomon::build_device(context(), triangles, build);
  const auto thread = trace(tree, rays, TraceFlavour::kThread);
  require_same_answers(thread, trace(tree, rays, TraceFlavour::kCompact));
  require_same_answers(thread, trace(tree, rays, TraceFlavour::kCompact, false, true));
}

}  // namespace

TEST_CASE("the compact flavour gives the thread flavour's bits on small scenes",
          "[serial][portable][memcheck]") {
  require_equal_to_thread(soup(60, 633, 1.0F), random_rays(20, 634));
  require_equal_to_thread(grid(5, 2.0F), random_rays(20, 635), leaves_of(1));
}

TEST_CASE("the compact flavour gives the thread flavour's bits where corners are shared", "[unlimited]") {
  for (const std::uint32_t leaf : {1U, 8U, 40U}) {
    CAPTURE(leaf);
    Triangles triangles = grid(30, 2.0F);
    const Triangles walls = scaled(grid(20, 2.0F), 0.37F, 1.0F);
    for (GnTriangle t : walls) {
      for (float* v : {t.v0, t.v1, t.v2}) std::swap(v[1], v[2]);
      triangles.push_back(t);
    }
    require_equal_to_thread(triangles, aimed_rays(triangles, 1500, 636), lazy_leaves_of(leaf));
    require_equal_to_thread(triangles, awkward_rays(1500, 637), leaves_of(leaf));
  }
}

TEST_CASE("the compact flavour loses nothing, judged by the oracle, near and far, large and small",
          "[unlimited]") {
  for (const float scale : {1e-6F, 1.0F, 1e6F}) {
    for (const float offset : {0.0F, 1000.0F}) {
      CAPTURE(scale, offset);
      const Triangles triangles = scaled(soup(400, 638, 1.0F), scale, offset * scale);
      Rays rays = aimed_rays(scaled(triangles, 1.0F / scale, 0.0F), 400, 639, offset);
      for (GnRay& r : rays)
        for (float& x : r.origin) x *= scale;
      const auto tree = gnomon::build_device(context(), triangles);
      const auto traced = trace(tree, rays, TraceFlavour::kCompact);
      gnomon::OracleOptions options;
      options.max_rays = rays.size();
      const auto report = gnomon::judge(triangles, rays, traced.closest.hits, traced.any.occluded, options);
      REQUIRE(report.rays_judged == rays.size());
      REQUIRE(report.lost == 0);
      REQUIRE(report.any_closest_disagree == 0);
      if (context().device().fp64) REQUIRE(report.mismatches() == 0);
    }
  }
}

TEST_CASE("a compact tree visits few boxes beyond the wide one's, the same with every work-group",
          "[unlimited]") {
  const Triangles triangles = soup(3000, 640, 0.3F);
  const Rays rays = random_rays(1000, 641);
  const auto tree = gnomon::build_device(context(), triangles);
  const auto wide = trace(tree, rays, TraceFlavour::kWide, false, true);
  const auto sum = [](const gnomon::TraceResult& result, std::uint32_t GnRayCounters::*what) {
    double all = 0.0;
    for (const GnRayCounters& c : result.counters) all += c.*what;
    return all;
  };
  gnomon::TraceOptions options;
  options.flavour = TraceFlavour::kCompact;
  options.counters = true;
  std::vector<GnRayCounters> first;
  for (const std::uint32_t size : {1U, 8U, 64U}) {
    CAPTURE(size);
    options.work_group_size = size;
    const gnomon::Tracer tracer(context(), tree, options);
    const auto closest = tracer.closest(rays);
    const auto any = tracer.any(rays);
    REQUIRE(sum(closest, &GnRayCounters::boxes) < 1.5 * sum(wide.closest, &GnRayCounters::boxes));
    REQUIRE(sum(closest, &GnRayCounters::triangles) < 1.5 * sum(wide.closest, &GnRayCounters::triangles));
    REQUIRE(sum(any, &GnRayCounters::boxes) < sum(closest, &GnRayCounters::boxes));
    if (first.empty()) first = closest.counters;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(closest.counters[i].boxes == first[i].boxes);
      REQUIRE(closest.counters[i].triangles == first[i].triangles);
    }
  }
}

TEST_CASE("a compact tree is traced by the compact flavour alone, sorted or not, and not in passes",
          "[portable]") {
  const auto triangles = soup(50, 642, 2.0F);
  const auto tree = gnomon::build_device(context(), triangles);
  const auto wide = collapse_device(context(), tree);
  const auto compact = compact_device(context(), wide);
  const Rays rays = random_rays(200, 643);
  gnomon::TraceOptions options;
  const auto hits = gnomon::Tracer(context(), compact, options).closest(rays).hits;
  REQUIRE(gnomon::Tracer(context(), compact).flavour() == TraceFlavour::kCompact);
  options.sort_rays = true;
  const auto sorted = gnomon::Tracer(context(), compact, options).closest(rays).hits;
  options.sort_rays = false;
  options.flavour = TraceFlavour::kCompact;
  const gnomon::Tracer from_wide(context(), wide, options);
  REQUIRE(from_wide.flavour() == TraceFlavour::kCompact);
  const auto again = from_wide.closest(rays).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(std::memcmp(&hits[i], &sorted[i], sizeof(GnHit)) == 0);
    REQUIRE(std::memcmp(&hits[i], &again[i], sizeof(GnHit)) == 0);
  }
  options.step_limit = 10;
  REQUIRE_THROWS_WITH(gnomon::Tracer(context(), compact, options), Catch::Contains("compact flavour"));
  options.step_limit = 0;
  for (const TraceFlavour other : {TraceFlavour::kThread, TraceFlavour::kWide, TraceFlavour::kPacket}) {
    options.flavour = other;
    REQUIRE_THROWS_WITH(gnomon::Tracer(context(), compact, options),
                        Catch::Contains("does not trace compact"));
  }
}

TEST_CASE("a device that ends loops is not asked for large compact trees", "[portable]") {
  const auto tree = gnomon::build_device(context(), soup(600, 645));
  gnomon::TraceOptions options;
  options.flavour = TraceFlavour::kCompact;
  if (context().device().loop_limit != 0) {
    REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, options), Catch::Contains("ends loops"));
  } else {
    REQUIRE(gnomon::Tracer(context(), tree, options).flavour() == TraceFlavour::kCompact);
  }
}
