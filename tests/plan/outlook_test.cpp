// Whether planning can pay: by what the rays to come cost, and never for few.
#include "gnomon/plan/outlook.h"

#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"

using gnomon::Outlook;
using gnomon::OutlookOptions;
using gnomon::Query;
using gnomon::RaysToCome;

TEST_CASE("planning pays where its price is a small share of the rays' work") {
  const gnomon::Scene scene = gnomon::generate_scene("cottage", 7000, 1);
  const gnomon::Bvh tree = gnomon::build_reference(scene.triangles);
  const auto rays = gnomon::primary_rays(scene, 256, 1);
  double cost = 0.0;
  for (const double one : gnomon::ray_costs({tree, {}}, scene.triangles, rays, Query::kClosest))
    cost += one / 256.0;
  OutlookOptions options;
  options.baseline_start = 30'000.0;
  options.baseline_price = 100.0;
  options.kind_start = 50'000.0;
  options.kind_price = 400.0;
  options.most_share = 0.1;
  const auto triangles = static_cast<double>(scene.triangles.size());
  const auto outlook = [&](double expected) {
    const std::vector<RaysToCome> to_come{{Query::kClosest, rays, expected}};
    return outlook_of(tree, scene.triangles, to_come, options);
  };
  const double price = 80'000.0 + 500.0 * triangles;
  const double enough = 10.0 * price / cost;
  const Outlook little = outlook(0.99 * enough);
  const Outlook much = outlook(1.01 * enough);
  REQUIRE(little.price == Approx(price));
  REQUIRE(little.work == Approx(0.99 * enough * cost));
  REQUIRE_FALSE(little.pays);
  REQUIRE(much.pays);
  REQUIRE_FALSE(outlook(0.0).pays);
  // Two kinds: both works, and a price for each.
  const std::vector<RaysToCome> two{{Query::kClosest, rays, 1000.0}, {Query::kAny, rays, 0.0}};
  const Outlook both = outlook_of(tree, scene.triangles, two, options);
  REQUIRE(both.price == Approx(130'000.0 + 900.0 * triangles));
  REQUIRE(both.work == Approx(1000.0 * cost));
}

TEST_CASE("outlooks of nothing do not pay, and bad options are refused") {
  REQUIRE_FALSE(gnomon::outlook_of({}, {}, {}).pays);
  const gnomon::Scene scene = gnomon::generate_scene("cottage", 7000, 1);
  const gnomon::Bvh tree = gnomon::build_reference(scene.triangles);
  const std::vector<RaysToCome> none{{Query::kClosest, {}, 1e12}};
  REQUIRE_FALSE(outlook_of(tree, scene.triangles, none).pays);
  const std::vector<RaysToCome> bad{{Query::kClosest, {}, -1.0}};
  REQUIRE_THROWS_WITH(outlook_of(tree, scene.triangles, bad), Catch::Contains("expected"));
  OutlookOptions options;
  options.most_share = 0.0;
  REQUIRE_THROWS_WITH(outlook_of(tree, scene.triangles, none, options), Catch::Contains("most_share"));
  options = {};
  const std::pair<const char*, double OutlookOptions::*> prices[] = {
      {"baseline_start", &OutlookOptions::baseline_start},
      {"baseline_price", &OutlookOptions::baseline_price},
      {"kind_start", &OutlookOptions::kind_start},
      {"kind_price", &OutlookOptions::kind_price}};
  for (const auto& [name, price] : prices) {
    options = {};
    options.*price = -1.0;
    REQUIRE_THROWS_WITH(outlook_of(tree, scene.triangles, none, options), Catch::Contains(name));
  }
}
