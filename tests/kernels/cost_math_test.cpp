// kernels/shared/cost_math.h and axis_policy.h on the host: the arithmetic every tree is decided by.
#include "gnomon/shared/axis_policy.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/tree/build_options.h"
#include "support/shapes.h"

using gnomon::test::Random;

TEST_CASE("the division-free reciprocal is right within two ulp and scales exactly by powers of two") {
  Random random(31);
  for (int i = 0; i < 200000; ++i) {
    const float x = random.between(1.0F, 2.0F);
    CAPTURE(x);
    const float r = gn_reciprocal(x);
    REQUIRE(std::fabs(static_cast<double>(r) * x - 1.0) <= 2.4e-7);
    for (const int exponent : {-90, -40, 40, 90}) {
      REQUIRE(gn_reciprocal(std::ldexp(x, exponent)) == std::ldexp(r, -exponent));
    }
  }
}

TEST_CASE("bins are monotone, start at zero and end at the last") {
  Random random(32);
  for (int i = 0; i < 20000; ++i) {
    const float lo = random.between(-1e5F, 1e5F);
    const float hi = lo + random.between(1e-3F, 1e5F);
    const std::uint32_t bins = 2 + random.below(63);
    const float scale = gn_bin_scale(lo, hi, bins);
    CAPTURE(lo, hi, bins);
    REQUIRE(gn_bin_of(lo, lo, scale, bins) == 0);
    REQUIRE(gn_bin_of(hi, lo, scale, bins) == bins - 1);
    std::uint32_t before = 0;
    for (int step = 0; step <= 20; ++step) {
      const float x = std::min(hi, lo + (hi - lo) * static_cast<float>(step) / 20.0F);
      const std::uint32_t bin = gn_bin_of(x, lo, scale, bins);
      REQUIRE(bin >= before);
      REQUIRE(bin < bins);
      before = bin;
    }
  }
}

TEST_CASE("an axis without extent offers no split") {
  REQUIRE(gn_bin_scale(3.0F, 3.0F, 16) == 0.0F);
  REQUIRE(gn_bin_scale(0.0F, 1e-38F, 16) == 0.0F);
}

TEST_CASE("of equally cheap splits the more even one wins, then the first") {
  const auto split = [](float cost, std::uint32_t axis, std::uint32_t plane, std::uint32_t left,
                        float tie = 0.0F) { return GnSplit{cost, axis, plane, left, tie, 0.0F, 0.0F, 0}; };
  const GnSplit uneven = split(1.0F, 0, 0, 1);
  const GnSplit even = split(1.0F, 0, 3, 5);
  const GnSplit later = split(1.0F, 2, 7, 5);
  REQUIRE(gn_split_is_better(&even, &uneven, 10) != 0);
  REQUIRE(gn_split_is_better(&uneven, &even, 10) == 0);
  REQUIRE(gn_split_is_better(&later, &even, 10) == 0);
  const GnSplit cheap = split(0.5F, 0, 0, 1);
  REQUIRE(gn_split_is_better(&cheap, &even, 10) != 0);
  const GnSplit small = split(1.0F, 0, 0, 1, 3.0F);
  const GnSplit large = split(1.0F, 0, 3, 5, 4.0F);
  REQUIRE(gn_split_is_better(&small, &large, 10) != 0);
  REQUIRE(gn_split_is_better(&large, &small, 10) == 0);
}

TEST_CASE("the measure is half the surface area") {
  const float lo[3] = {1, 2, 3};
  const float hi[3] = {2, 4, 6};
  REQUIRE(gn_surface_measure(lo, hi) == 11.0F);
  const GnMeasure measure = gnomon::surface_area_measure();
  REQUIRE(gn_box_measure(&measure, 0, lo, hi) == 11.0F);
}

// What CONTRIBUTING and the note on heuristics point to: a measure of one's own is one function.
TEST_CASE("the custom measure's example is Steiner's: the surface of the box grown by a ball, halved") {
  GnMeasure measure = gnomon::surface_area_measure();
  std::fill_n(measure.weights, 3, 0.0F);
  measure.kind = GN_MEASURE_CUSTOM;
  measure.half_width = 0.5F;
  const float lo[3] = {1, 2, 3};
  const float hi[3] = {2, 4, 6};
  const double pi = std::acos(-1.0);
  const double grown = 11.0 + pi * 0.5 * 6.0 + 2.0 * pi * 0.25;
  REQUIRE(gn_measure_how(&measure, lo, hi) == 0);
  REQUIRE(gn_box_measure(&measure, 0, lo, hi) == Approx(grown).epsilon(1e-6));
  REQUIRE(gn_box_measure(&measure, 0, lo, lo) == Approx(2.0 * pi * 0.25).epsilon(1e-6));  // a point is a ball
}

TEST_CASE("a node's rating by its parent's split decides a leaf only where it is the node's own measure") {
  GnHeuristic h{};
  for (float& weight : h.measure.weights) weight = 1.0F;
  h.rules.max_leaf_size = 8;
  h.rules.cost_traversal = 1.0F;
  h.rules.cost_triangle = 1.0F;
  GnSplit split = gn_no_split();
  split.axis = 0;
  split.cost = 2.5F;
  // A leaf costs two triangles, a split one step more than 2.5: by the unit cube's measure, 3, the split is
  // better, by 1 the leaf.
  GnNodeView node{{0, 0, 0}, {1, 1, 1}, 1.0F, 2, 5, 7, GN_SEEN_ONE_STEP};
  REQUIRE(gn_becomes_leaf(&h, GN_SEEN_ONE_STEP, &node, &split) == 1);
  REQUIRE(gn_becomes_leaf(&h, GN_SEEN_FEW_STEPS, &node, &split) == 0);  // rated in another way
  h.rules.axes = GN_AXES_SPFH;  // whose fallback rates by surface area
  REQUIRE(gn_becomes_leaf(&h, GN_SEEN_ONE_STEP, &node, &split) == 0);
  h.rules.axes = GN_AXES_ALL;
  node.probability = GN_FLOAT_MAX;  // nothing rated it
  REQUIRE(gn_becomes_leaf(&h, GN_SEEN_ONE_STEP, &node, &split) == 0);
}
