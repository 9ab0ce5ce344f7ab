// Depth maps say what an area's rays see of a box, and optimisation by areas makes what they meet cheaper.
#include "gnomon/tree/depth_map.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/optimise.h"
#include "support/areas_of_rays.h"
#include "support/shapes.h"

using gnomon::AreaCost;
using gnomon::Bvh;
using gnomon::DepthMap;
using gnomon::OptimiseOptions;
using gnomon::test::area_with_map;
using gnomon::test::point_measure;
using gnomon::test::window_measure;

namespace {

using Triangles = std::vector<GnTriangle>;

// Hides all that is behind z = 10 and left of the middle.
Triangles half_a_wall() {
  return {gnomon::test::triangle({0, -90, 10}, {0, 90, 10}, {-90, -90, 10}),
          gnomon::test::triangle({-90, 90, 10}, {0, 90, 10}, {-90, -90, 10})};
}

float share_of(const AreaCost& area, const GnBox& box) {
  return gn_unhidden_share(&area.measure, &area.map.shape, area.map.sums.data(), box.lo, box.hi);
}

double inner_cost(const Bvh& bvh, const OptimiseOptions& options) {
  const std::vector<float> costs = gnomon::box_costs(bvh, options);
  double sum = 0.0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (bvh.nodes[i].count == 0) sum += double{costs[i]};
  }
  return sum / double{costs.front()};
}

}  // namespace

TEST_CASE("what stands behind the first thing that parallel rays meet is hidden, and nothing else is") {
  const AreaCost area = area_with_map(window_measure(4.0F), 0.0F, 40.0F, half_a_wall());
  CHECK(share_of(area, {{-3, -3, 20}, {-1, 3, 22}}) == 0.0F);
  CHECK(share_of(area, {{-3, -3, 2}, {-1, 3, 22}}) == Approx(1.0));
  CHECK(share_of(area, {{1, -3, 20}, {3, 3, 22}}) == Approx(1.0));
  CHECK(share_of(area, {{-2, -3, 20}, {2, 3, 22}}) == Approx(0.5).margin(0.02));
  CHECK(share_of(area, {{-3, -3, 10}, {-1, 3, 10}}) == Approx(1.0));  // the wall itself
  CHECK(share_of(area, {{4.5F, 0, 1}, {5, 1, 2}}) == -1.0F);          // beside the window
  CHECK(share_of(area, {{-1, 0, -3}, {1, 1, -2}}) == -1.0F);          // before it
  CHECK(share_of(area, {{-9, -9, -9}, {9, 9, 90}}) == Approx(1.0));
}

TEST_CASE("rays from a point see past a wall what is beside its shadow") {
  const AreaCost area = area_with_map(point_measure(1.0F), 1.0F, 100.0F, half_a_wall());
  CHECK(share_of(area, {{-30, -3, 40}, {-10, 3, 42}}) == 0.0F);
  CHECK(share_of(area, {{10, -3, 40}, {30, 3, 42}}) == Approx(1.0));
  CHECK(share_of(area, {{-4, -3, 5}, {-1, 3, 6}}) == Approx(1.0));
  // Its front is its widest part, on both sides of the middle.
  CHECK(share_of(area, {{-1, -1, 20}, {1, 1, 80}}) == Approx(0.5).margin(0.02));
  CHECK(share_of(area, {{-1, -1, 20}, {9, 1, 90}}) == Approx(0.88).margin(0.03));
  CHECK(share_of(area, {{50, 0, 40}, {60, 1, 41}}) == -1.0F);
  CHECK(share_of(area, {{-3, -3, -9}, {3, 3, 0.5F}}) == -1.0F);
  CHECK(share_of(area, {{-300, -300, -9}, {300, 300, 300}}) == Approx(1.0));
}

// By counting cells one by one.
TEST_CASE("shares are those of the cells a box covers") {
  const Triangles triangles = gnomon::test::soup(200, 801, 2.0F);
  GnMeasure measure = window_measure(6.0F);
  measure.origin[0] = measure.origin[1] = 5.0F;
  measure.origin[2] = -10.0F;
  const auto looks = gnomon::depth_rays(measure, 0.0F, 60.0F);
  const auto hits = gnomon::trace_reference(gnomon::build_reference(triangles), triangles, looks, false).hits;
  const AreaCost area{measure, gnomon::depth_map_of(measure, 0.0F, 60.0F, hits)};
  gnomon::test::Random random(802);
  int some = 0;
  for (int i = 0; i < 500; ++i) {
    GnBox box{};
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = random.between(-2.0F, 10.0F);
      box.hi[k] = box.lo[k] + random.between(0.0F, 4.0F);
    }
    const float share = share_of(area, box);
    const float to_cells = area.map.shape.to_cells[0];
    const float slice = 1.0F / area.map.shape.to_slices;
    const auto cell = [&](float at) {
      return static_cast<int>(std::floor((at - 5.0F) * to_cells)) + static_cast<int>(GN_MAP_CELLS) / 2;
    };
    if (cell(box.lo[0]) < 0 || cell(box.lo[1]) < 0) continue;
    if (std::max(cell(box.hi[0]), cell(box.hi[1])) >= static_cast<int>(GN_MAP_CELLS)) continue;
    int covered = 0;
    int surely = 0;
    int perhaps = 0;  // depths within a slice may count either way
    for (int row = cell(box.lo[1]); row <= cell(box.hi[1]); ++row) {
      for (int column = cell(box.lo[0]); column <= cell(box.hi[0]); ++column) {
        const auto& hit =
            hits[static_cast<std::size_t>(row) * GN_MAP_CELLS + static_cast<std::size_t>(column)];
        const float front = box.lo[2] + 10.0F;
        covered += 1;
        surely += hit.primitive == GN_NONE || hit.t > front ? 1 : 0;
        perhaps += hit.primitive == GN_NONE || hit.t + slice > front ? 1 : 0;
      }
    }
    CAPTURE(i, covered, surely, perhaps);
    REQUIRE(static_cast<double>(share) >= static_cast<double>(surely) / covered - 1e-4);
    REQUIRE(static_cast<double>(share) <= static_cast<double>(perhaps) / covered + 1e-4);
    some += surely > 0 && perhaps < covered ? 1 : 0;
  }
  REQUIRE(some > 50);
}

TEST_CASE("optimising by areas brings down what it is asked to, and by no areas what it always did") {
  const Triangles triangles = gnomon::test::soup(800, 803, 0.5F);
  const Bvh before = gnomon::build_reference(triangles);
  OptimiseOptions plain;
  plain.share = 1.0F;
  OptimiseOptions asked = plain;
  asked.areas = gnomon::test::areas_around(triangles);
  REQUIRE(asked.areas.size() == 3);
  const Bvh after = gnomon::optimise_reference(before, asked);
  REQUIRE(inner_cost(after, asked) < 0.97 * inner_cost(before, asked));
  REQUIRE(inner_cost(after, asked) < inner_cost(gnomon::optimise_reference(before, plain), asked));
  if (const auto fault = gnomon::check_bvh(after, triangles, {})) FAIL(fault->what);
  for (AreaCost& area : asked.areas) area.share = 0.0F;
  REQUIRE(tree_hash(gnomon::optimise_reference(before, asked)) ==
          tree_hash(gnomon::optimise_reference(before, plain)));
}

TEST_CASE("what cannot be mapped or weighed is refused") {
  GnMeasure linear = window_measure(1.0F);
  linear.kind = GN_MEASURE_LINEAR;
  REQUIRE_THROWS_WITH(gnomon::depth_rays(linear, 0.0F, 1.0F), Catch::Contains("window"));
  REQUIRE_THROWS_WITH(gnomon::depth_rays(window_measure(1.0F), 2.0F, 1.0F), Catch::Contains("below far"));
  REQUIRE_THROWS_WITH(gnomon::depth_rays(point_measure(1.0F), 0.0F, 1.0F), Catch::Contains("begin there"));
  REQUIRE_THROWS_WITH(gnomon::depth_map_of(window_measure(1.0F), 0.0F, 1.0F, {}), Catch::Contains("0 hits"));
  OptimiseOptions options;
  options.areas.resize(GN_MOST_COST_AREAS + 1);
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("5 of them"));
  options.areas.resize(1);
  options.areas[0].share = -1.0F;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("share"));
  options.areas[0].share = 1.0F;
  options.areas[0].map.sums.resize(7);
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("sums"));
}
