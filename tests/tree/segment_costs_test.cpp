// Sampled segments: how many meet a box, and optimisation by them makes what they meet cheaper.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/optimise.h"
#include "gnomon/tree/trace_reference.h"
#include "support/shapes.h"

using gnomon::Bvh;
using gnomon::OptimiseOptions;
using gnomon::test::Random;

namespace {

using Triangles = std::vector<GnTriangle>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::uint32_t met(const std::vector<GnRay>& segments, const GnBox& box) {
  const std::vector<float> planes = gnomon::segment_planes(segments);
  return gn_segments_met(planes.data(), static_cast<std::uint32_t>(segments.size()), box.lo, box.hi);
}

// By how much of the segment's own parameter it is inside the box; below 0 it misses. In double.
double length_inside(const GnRay& ray, const GnBox& box) {
  double near = ray.tmin;
  double far = ray.tmax;
  for (int k = 0; k < 3; ++k) {
    const double a = (double{box.lo[k]} - ray.origin[k]) / ray.direction[k];
    const double b = (double{box.hi[k]} - ray.origin[k]) / ray.direction[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return far - near;
}

double inner_cost(const Bvh& bvh, const OptimiseOptions& options) {
  const std::vector<float> costs = gnomon::box_costs(bvh, options);
  double sum = 0.0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (bvh.nodes[i].count == 0) sum += double{costs[i]};
  }
  return sum;
}

// Each ray as far as what it hits.
std::vector<GnRay> ended(const Bvh& bvh, const Triangles& triangles, std::vector<GnRay> rays) {
  const auto hits = gnomon::trace_reference(bvh, triangles, rays, false).hits;
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].tmax = std::min(rays[i].tmax, hits[i].t);
  return rays;
}

std::uint64_t boxes_tested(const Bvh& bvh, const Triangles& triangles, const std::vector<GnRay>& rays) {
  std::uint64_t sum = 0;
  for (const GnRayCounters& c : gnomon::trace_reference(bvh, triangles, rays, false).counters) sum += c.boxes;
  return sum;
}

}  // namespace

TEST_CASE("as many segments meet a box as have a part in it") {
  Random random(841);
  std::uint32_t inside = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<GnRay> segments = gnomon::test::random_rays(40, 842 + static_cast<std::uint32_t>(round));
    for (GnRay& ray : segments) {
      ray.tmin = random.between(-3.0F, 3.0F);
      ray.tmax = ray.tmin + random.between(0.0F, 20.0F);
    }
    GnBox box{};
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = random.between(0.0F, 8.0F);
      box.hi[k] = box.lo[k] + random.between(0.0F, 8.0F);
    }
    std::uint32_t surely = 0;
    std::uint32_t perhaps = 0;
    for (const GnRay& ray : segments) {
      const double length = length_inside(ray, box);
      surely += length > 1e-4 ? 1 : 0;
      perhaps += length > -1e-4 ? 1 : 0;
    }
    CAPTURE(round, surely, perhaps);
    REQUIRE(met(segments, box) >= surely);
    REQUIRE(met(segments, box) <= perhaps);
    inside += surely;
  }
  REQUIRE(inside > 500);
}

TEST_CASE("segments along an axis, without an end, inside a box or ending before it are told apart") {
  const GnBox box{{1, 1, 1}, {2, 2, 2}};
  const auto one = [&](std::array<float, 3> origin, std::array<float, 3> direction, float tmin, float tmax) {
    return met({gnomon::test::ray(origin, direction, tmin, tmax)}, box);
  };
  REQUIRE(one({0, 1.5F, 1.5F}, {1, 0, 0}, 0.0F, kInfinity) == 1);
  REQUIRE(one({0, 1.5F, 1.5F}, {-1, 0, 0}, 0.0F, kInfinity) == 0);
  REQUIRE(one({0, 1.5F, 1.5F}, {-1, 0, 0}, -kInfinity, 0.0F) == 1);
  REQUIRE(one({0, 2.5F, 1.5F}, {1, 0, 0}, 0.0F, kInfinity) == 0);
  REQUIRE(one({0, 1.5F, 1.5F}, {1, 0, 0}, 0.0F, 0.9F) == 0);
  REQUIRE(one({0, 1.5F, 1.5F}, {1, 0, 0}, 2.1F, 3.0F) == 0);
  REQUIRE(one({1.5F, 1.5F, 1.5F}, {0, 0, 1}, 0.0F, 0.1F) == 1);
  REQUIRE(met({}, box) == 0);
}

TEST_CASE("optimising by segments makes rays of their kind cheaper than optimising by areas does") {
  const Triangles triangles = gnomon::test::soup(3000, 843, 0.4F);
  const Bvh before = gnomon::build_reference(triangles);
  // From one place through a quarter of the scene.
  const auto look = [](std::uint32_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<GnRay> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float target[3] = {random.between(0.0F, 5.0F), random.between(0.0F, 5.0F), 10.0F};
      rays.push_back(gnomon::test::aimed({2, 2, -5}, target));
    }
    return rays;
  };
  OptimiseOptions plain;
  plain.share = 1.0F;
  plain.max_passes = 12;
  OptimiseOptions asked = plain;
  asked.segments = ended(before, triangles, look(300, 844));
  const Bvh by_areas = gnomon::optimise_reference(before, plain);
  const Bvh after = gnomon::optimise_reference(before, asked);
  if (const auto fault = gnomon::check_bvh(after, triangles, {})) FAIL(fault->what);
  REQUIRE(inner_cost(after, asked) < 0.95 * inner_cost(by_areas, asked));
  const std::vector<GnRay> fresh = look(2000, 845);
  REQUIRE(static_cast<double>(boxes_tested(after, triangles, fresh)) <
          0.95 * static_cast<double>(boxes_tested(by_areas, triangles, fresh)));
  asked.segments_share = 0.0F;
  REQUIRE(tree_hash(gnomon::optimise_reference(before, asked)) == tree_hash(by_areas));
}

TEST_CASE("the root costs its faces and, where all segments meet it, so many times these") {
  const Triangles triangles = gnomon::test::soup(40, 846);
  const Bvh bvh = gnomon::build_reference(triangles);
  OptimiseOptions options;
  const float faces = gnomon::box_costs(bvh, options)[0];
  for (std::uint32_t i = 0; i < 8; ++i) {
    GnRay ray = gnomon::test::random_rays(1, 847 + i)[0];
    std::copy(triangles[0].v0, triangles[0].v0 + 3, ray.origin);
    options.segments.push_back(ray);
  }
  options.segments_share = 3.0F;
  REQUIRE(gnomon::box_costs(bvh, options)[0] == Approx(4.0F * faces));
}

TEST_CASE("segments that cannot be traced or weighed are refused") {
  OptimiseOptions options;
  options.segments = gnomon::test::random_rays(2, 848);
  options.check();
  options.segments_share = -1.0F;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("segments_share"));
  options.segments_share = 1.0F;
  options.segments[1].direction[0] = NAN;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("cannot be traced"));
}
