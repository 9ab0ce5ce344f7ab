// Reinsertion by sampled rays: sound trees, weights that are what they say, less work for the rays.
#include "gnomon/plan/optimise_for_rays.h"

#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/shared/hit_math.h"
#include "gnomon/shared/measure_math.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/optimise.h"
#include "support/bundles.h"
#include "support/shapes.h"

using gnomon::Bvh;
using gnomon::optimise_for_rays;
using gnomon::OptimiseOptions;
using gnomon::SampledOptions;
using gnomon::SampledTree;
using gnomon::SampleMeasure;

namespace {

gnomon::BuildOptions single_leaves() {
  gnomon::BuildOptions options;
  options.max_leaf_size = 1;
  return options;
}

OptimiseOptions every_node() {
  OptimiseOptions options;
  options.share = 1.0F;
  options.max_passes = 20;
  options.least_gain = 0.0F;
  return options;
}

// Each node that a segment meets, and each move that brings anything.
SampledOptions every_move() {
  SampledOptions options;
  options.least_met = 1;
  options.least_saved = 0.0F;
  return options;
}

// Each box against each segment, without masks.
std::vector<float> plain_measures(const Bvh& bvh, const std::vector<GnRay>& segments,
                                  const SampleMeasure& measure) {
  std::vector<float> out;
  const auto linear = [&](const gnomon::Node& node) {
    return gn_linear_measure(measure.face_weights.data(), node.lo, node.hi);
  };
  for (const gnomon::Node& node : bvh.nodes) {
    std::uint32_t met = 0;
    for (const GnRay& ray : segments) {
      const GnRayFrame frame = gn_ray_frame(&ray);
      const float entry =
          gn_box_entry(&frame, node.lo, node.hi, ray.tmin, gn_slab_limit(gn_finite_tmax(ray.tmax)));
      met += entry < GN_INFINITY ? 1 : 0;
    }
    out.push_back(static_cast<float>(met) / static_cast<float>(segments.size()) +
                  measure.prior_share * linear(node) / linear(bvh.nodes[0]));
  }
  return out;
}

double weight_of(const Bvh& bvh, const std::vector<float>& measures) {
  double sum = 0.0;
  for (std::size_t i = 0; i < measures.size(); ++i)
    sum += bvh.nodes[i].count == 0 ? double{measures[i]} : 0.0;
  return sum;
}

}  // namespace

TEST_CASE("trees optimised for rays are sound, whatever the input") {
  const auto segments = gnomon::test::random_rays(100, 61);
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    CAPTURE(name);
    const Bvh before = gnomon::build_reference(triangles, single_leaves());
    SampledOptions options = every_move();
    options.max_depth = single_leaves().median_depth + 2;
    const SampledTree after = optimise_for_rays(before, segments, {}, options);
    if (const auto fault = gnomon::check_bvh(after.bvh, triangles, single_leaves())) FAIL(fault->what);
    REQUIRE(after.measures.size() == after.bvh.nodes.size());
  }
}

TEST_CASE("a node weighs the share of segments that meet it and its part of the areas") {
  const auto triangles = gnomon::test::soup(600, 62);
  const Bvh before = gnomon::build_reference(triangles, single_leaves());
  for (const std::uint32_t count : {1U, 64U, 65U, 300U}) {
    CAPTURE(count);
    const auto segments = gnomon::test::random_rays(count, 63);
    const SampleMeasure measure{{0.2F, 1.0F, 3.0F}, 0.25F};
    const SampledTree after = optimise_for_rays(before, segments, measure, every_move());
    const auto expected = plain_measures(after.bvh, segments, measure);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CAPTURE(i);
      REQUIRE(after.measures[i] == Approx(expected[i]).epsilon(1e-5));
    }
    // What is minimised falls, as much as is said, and by more than reinsertion by the areas alone brings.
    OptimiseOptions by_areas = every_node();
    by_areas.face_weights = measure.face_weights;
    const Bvh other = gnomon::optimise_reference(before, by_areas);
    const double reached = weight_of(after.bvh, after.measures);
    const double start = weight_of(before, plain_measures(before, segments, measure));
    REQUIRE(reached < 0.98 * start);
    REQUIRE(reached < weight_of(other, plain_measures(other, segments, measure)));
    REQUIRE(weight_of(after.bvh, expected) == Approx(reached).epsilon(1e-5));
  }
}

TEST_CASE("moves save what they say, and the dearest go first") {
  const auto triangles = gnomon::test::soup(800, 67);
  const Bvh before = gnomon::build_reference(triangles, single_leaves());
  const auto segments = gnomon::test::random_rays(200, 68);
  const SampleMeasure measure{{1.0F, 2.0F, 0.5F}, 0.5F};
  const auto weight = [&](const Bvh& bvh) { return weight_of(bvh, plain_measures(bvh, segments, measure)); };
  const double start = weight(before);
  double saved = -1.0;
  double work = -1.0;
  for (const double share : {0.0, 0.6, 0.8, 1.0}) {
    CAPTURE(share);
    SampledOptions options = every_move();
    const double whole = optimise_for_rays(before, segments, measure, options).work;
    options.most_work = share * whole;
    const SampledTree after = optimise_for_rays(before, segments, measure, options);
    // Below the nodes that no segment meets weights are areas', which moves do not touch.
    REQUIRE(start - weight(after.bvh) == Approx(after.saved * start).margin(0.02 * start));
    REQUIRE(after.saved > saved);
    REQUIRE(after.work > work);
    REQUIRE(after.work < 1.05 * whole);
    saved = after.saved;
    work = after.work;
    if (const auto fault = gnomon::check_bvh(after.bvh, triangles, single_leaves())) FAIL(fault->what);
  }
  REQUIRE(saved > 0.02);
}

TEST_CASE("nodes that few segments meet stay as they are") {
  const auto triangles = gnomon::test::soup(500, 69);
  const Bvh before = gnomon::build_reference(triangles, single_leaves());
  const auto segments = gnomon::test::random_rays(64, 70);
  SampledOptions options = every_move();
  options.least_met = 65;
  REQUIRE(gnomon::tree_hash(optimise_for_rays(before, segments, {}, options).bvh) ==
          gnomon::tree_hash(before));
  options = every_move();
  options.least_saved = 1e6F;
  REQUIRE(gnomon::tree_hash(optimise_for_rays(before, segments, {}, options).bvh) ==
          gnomon::tree_hash(before));
  REQUIRE(gnomon::tree_hash(optimise_for_rays(before, {}, {}, every_move()).bvh) ==
          gnomon::tree_hash(before));
  REQUIRE(gnomon::tree_hash(optimise_for_rays(before, segments, {}, every_move()).bvh) !=
          gnomon::tree_hash(before));
}

TEST_CASE("a tree that would become too deep stays as it is") {
  const auto triangles = gnomon::test::soup(400, 71);
  const Bvh before = gnomon::build_reference(triangles, single_leaves());
  const auto segments = gnomon::test::random_rays(128, 72);
  const auto depth = [](const Bvh& bvh) { return gnomon::stats_of(bvh, single_leaves()).max_depth; };
  const SampledTree free = optimise_for_rays(before, segments, {}, every_move());
  REQUIRE(depth(free.bvh) > depth(before));
  SampledOptions options = every_move();
  options.max_depth = depth(before);
  const SampledTree held = optimise_for_rays(before, segments, {}, options);
  REQUIRE(gnomon::tree_hash(held.bvh) == gnomon::tree_hash(before));
  REQUIRE(held.saved == 0.0);
  options.max_depth = depth(free.bvh);
  REQUIRE(gnomon::tree_hash(optimise_for_rays(before, segments, {}, options).bvh) ==
          gnomon::tree_hash(free.bvh));
}

TEST_CASE("the rays a tree was optimised for have less to do, and hit the same") {
  const auto triangles = gnomon::test::soup(2000, 64, 0.3F);
  std::vector<GnRay> rays;
  for (GnRay ray : gnomon::test::random_rays(512, 65)) {
    // A narrow beam: areas of boxes alone would not know.
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = 4.0F + 0.2F * ray.origin[k];
      ray.direction[k] = (k == 1 ? 1.0F : 0.05F) * ray.direction[k];
    }
    rays.push_back(ray);
  }
  const Bvh before =
      gnomon::optimise_reference(gnomon::build_reference(triangles, single_leaves()), every_node());
  const auto segments = gnomon::segments_of(before, triangles, rays, gnomon::Query::kClosest);
  const SampledTree after = optimise_for_rays(before, segments, {}, every_move());
  const auto sum = [&](const Bvh& bvh) {
    double all = 0.0;
    for (const double cost : gnomon::ray_costs({bvh, {}}, triangles, rays, gnomon::Query::kClosest))
      all += cost;
    return all;
  };
  REQUIRE(sum(after.bvh) < 0.9 * sum(before));
  const auto expected = gnomon::trace_reference(before, triangles, rays, false).hits;
  const auto got = gnomon::trace_reference(after.bvh, triangles, rays, false).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(got[i].primitive == expected[i].primitive);
    REQUIRE(got[i].t == expected[i].t);
  }
}

TEST_CASE("segments end where their query stops looking") {
  const std::vector<GnTriangle> roof{gnomon::test::triangle({-9, 2, -9}, {9, 2, -9}, {0, 2, 20})};
  const Bvh bvh = gnomon::build_reference(roof);
  const std::vector<GnRay> rays{gnomon::test::ray({0, 0, 0}, {0, 1, 0}),
                                gnomon::test::ray({0, 0, 0}, {0, -1, 0}),
                                gnomon::test::ray({0, NAN, 0}, {0, 1, 0})};
  const auto closest = gnomon::segments_of(bvh, roof, rays, gnomon::Query::kClosest);
  REQUIRE(closest.size() == 2);
  REQUIRE(closest[0].tmax == 2.0F);
  REQUIRE(closest[1].tmax > 1e38F);
  for (const gnomon::Query query : {gnomon::Query::kAny, gnomon::Query::kEvery}) {
    CAPTURE(to_string(query));
    const auto whole = gnomon::segments_of(bvh, roof, rays, query);
    REQUIRE(whole.size() == 2);
    REQUIRE(whole[0].tmax > 1e38F);
  }
}

TEST_CASE("mixtures of the rays' own measure and surface area") {
  const std::vector<GnRay> down(10, gnomon::test::ray({0, 0, 0}, {0, -7, 0}));
  REQUIRE(gnomon::mixed_weights(down, 1.0F) == std::array<float, 3>{0.0F, 3.0F, 0.0F});
  REQUIRE(gnomon::mixed_weights(down, 0.0F) == std::array<float, 3>{1.0F, 1.0F, 1.0F});
  REQUIRE(gnomon::mixed_weights(down, 0.5F) == std::array<float, 3>{0.5F, 2.0F, 0.5F});
  REQUIRE(gnomon::mixed_weights({}, 0.5F) == std::array<float, 3>{1.0F, 1.0F, 1.0F});
  REQUIRE_THROWS_WITH(gnomon::mixed_weights(down, 1.5F), Catch::Contains("1.5"));
}

TEST_CASE("thinning takes rays evenly") {
  std::vector<GnRay> rays(10, gnomon::test::ray({0, 0, 0}, {0, 1, 0}));
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].origin[0] = static_cast<float>(i);
  const auto few = gnomon::thinned(rays, 2);
  REQUIRE(few.size() == 2);
  REQUIRE(few[0].origin[0] == 2.0F);
  REQUIRE(few[1].origin[0] == 7.0F);
  REQUIRE(gnomon::thinned(rays, 10).size() == 10);
  REQUIRE(gnomon::thinned({}, 5).empty());
}

TEST_CASE("sample measures out of range are refused") {
  const Bvh bvh = gnomon::build_reference(gnomon::test::soup(10, 66));
  REQUIRE_THROWS_WITH(optimise_for_rays(bvh, {}, {{1, 1, 1}, 0.0F}), Catch::Contains("prior_share"));
  REQUIRE_THROWS_WITH(optimise_for_rays(bvh, {}, {{1, -1, 1}, 1.0F}), Catch::Contains("face_weights"));
  SampledOptions options;
  options.least_met = 0;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("least_met"));
  options = {};
  options.least_saved = -1.0F;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("least_saved"));
  options = {};
  options.most_work = NAN;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("most_work"));
  options = {};
  options.max_depth = 129;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("max_depth"));
  REQUIRE(optimise_for_rays({}, {}, {}).bvh.nodes.empty());
}
