// Fast accuracy: right but for rays at edges, on every flavour that has it; refused where it is not to be
// had.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/tree/hit_difference.h"
#include "support/bundles.h"
#include "support/flavours.h"

using gnomon::Accuracy;
using gnomon::HitDifference;
using gnomon::TraceFlavour;
using gnomon::test::context;
using gnomon::test::Rays;
using gnomon::test::Triangles;

namespace {

struct Costs {
  HitDifference closest;
  HitDifference any;
};

// What fast accuracy costs a flavour on these rays.
Costs costs_of(const Triangles& triangles, const Rays& rays, TraceFlavour flavour, bool portable) {
  const auto tree = gnomon::build_device(context(), triangles);
  gnomon::TraceOptions options;
  options.flavour = flavour;
  options.portable = portable;
  const gnomon::Tracer exact(context(), tree, options);
  options.accuracy = Accuracy::kFast;
  const gnomon::Tracer fast(context(), tree, options);
  return {gnomon::difference_of(exact.closest(rays).hits, fast.closest(rays).hits),
          gnomon::difference_of(exact.any(rays).occluded, fast.any(rays).occluded)};
}

}  // namespace

TEST_CASE("fast hits are the exact ones but for a few, and t is nearly right", "[unlimited]") {
  const Triangles triangles = gnomon::test::soup(2000, 401, 0.5F);
  Rays rays = gnomon::test::random_rays(4000, 402);
  for (const auto& [name, bundle] : gnomon::test::bundles(4))
    rays.insert(rays.end(), bundle.begin(), bundle.end());
  for (const TraceFlavour flavour : {TraceFlavour::kWide, TraceFlavour::kPacket}) {
    for (const bool portable : {false, true}) {
      const Costs costs = costs_of(triangles, rays, flavour, portable);
      CAPTURE(to_string(flavour), portable, costs.closest.lost, costs.closest.added, costs.any.lost,
              costs.any.added);
      REQUIRE(costs.closest.hits > 2000);
      REQUIRE(costs.closest.wrong() * 1000 < costs.closest.rays);
      REQUIRE(costs.any.wrong() * 1000 < costs.any.rays);
      REQUIRE(costs.closest.max_t_ulp > 1.0);  // else these are not the fast kernels
    }
  }
}

TEST_CASE("fast accuracy loses hits at shared corners, which is what it is said to cost", "[unlimited]") {
  const Triangles triangles = gnomon::test::soup(500, 403, 0.5F);
  const Rays rays = gnomon::test::aimed_rays(triangles, 3000, 404);
  const Costs costs = costs_of(triangles, rays, TraceFlavour::kWide, false);
  CAPTURE(costs.closest.lost, costs.closest.added);
  REQUIRE(costs.closest.wrong() > 10);
}

TEST_CASE("the binary tree's flavour is always watertight, and says so", "[portable]") {
  const auto tree = gnomon::build_device(context(), gnomon::test::soup(50, 405));
  gnomon::TraceOptions options;
  options.flavour = TraceFlavour::kThread;
  options.accuracy = Accuracy::kFast;
  REQUIRE_THROWS_WITH(gnomon::Tracer(context(), tree, options), Catch::Contains("wide and packet"));
}
