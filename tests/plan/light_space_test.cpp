// Boxes along oblique parallel rays in plans: proposed where totals say so, kept where probes do, with the
// hits of any other tree; refused where no such tree can be traced.
#include "gnomon/plan/light_space.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <nlohmann/json.hpp>

#include "gnomon/base/error.h"
#include "gnomon/plan/choose.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/bvh_check.h"
#include "support/framed.h"

using gnomon::light_space_of;
using gnomon::Plan;
using gnomon::PlanOptions;
using gnomon::PlanRays;
using gnomon::Query;
using gnomon::Ray;

namespace {

constexpr double kMany = 1e8;

// Parallel rays through a cube of side 10, from beyond it; `spread` of the direction's length to either side.
std::vector<Ray> sun(const std::array<float, 3>& direction, std::uint32_t count, std::uint32_t seed,
                     float spread = 0.0F) {
  gnomon::test::Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    for (std::size_t k = 0; k < 3; ++k) {
      ray.direction[k] = direction[k] + random.between(-spread, spread);
      ray.origin[k] = random.between(0.0F, 10.0F) - 20.0F * ray.direction[k];
    }
    ray.tmax = INFINITY;
  }
  return rays;
}

std::vector<PlanRays> sun_kinds(const std::array<float, 3>& direction, double expected = kMany) {
  std::vector<PlanRays> out;
  for (const Query query : {Query::kClosest, Query::kAny, Query::kEvery})
    out.push_back({to_string(query), query, sun(direction, 512, 1), sun(direction, 1024, 2), expected});
  return out;
}

Plan plan_of(const std::vector<GnTriangle>& triangles, const std::vector<PlanRays>& rays, bool light_space) {
  PlanOptions options;
  options.light_space = light_space;
  return gnomon::make_plan(triangles, rays, options);
}

double mean_cost(const gnomon::OrderedTree& tree, const std::vector<GnTriangle>& triangles,
                 const std::vector<Ray>& rays, Query query) {
  double sum = 0.0;
  for (const double cost : gnomon::ray_costs(tree, triangles, rays, query)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

}  // namespace

TEST_CASE("obliquity is what rays see of a cube beside what they see of one along them") {
  REQUIRE(light_space_of(sun({0, -1, 0}, 100, 1)).obliquity == Approx(1.0));
  REQUIRE(light_space_of(sun({1, 1, 0}, 100, 1)).obliquity == Approx(std::sqrt(2.0)).epsilon(1e-5));
  REQUIRE(light_space_of(sun({1, -1, 1}, 100, 1)).obliquity == Approx(std::sqrt(3.0)).epsilon(1e-5));
  // Both ways along a line is still along it.
  std::vector<Ray> both = sun({1, -1, 1}, 100, 1);
  for (std::size_t i = 0; i < both.size(); i += 2) {
    for (float& d : both[i].direction) d = -d;
  }
  REQUIRE(light_space_of(both).obliquity == Approx(std::sqrt(3.0)).epsilon(1e-5));
  // A sun's disc costs little of it, a wide lamp most.
  const double disc = light_space_of(sun({1, -1, 1}, 2000, 1, 0.005F)).obliquity;
  const double lamp = light_space_of(sun({1, -1, 1}, 2000, 1, 0.5F)).obliquity;
  REQUIRE(disc < std::sqrt(3.0));
  REQUIRE(disc > 1.7);
  REQUIRE(lamp < 1.4);
  REQUIRE(light_space_of({}).obliquity == 1.0);
  const auto scene = gnomon::generate_scene("random", 100, 1);
  REQUIRE(light_space_of(gnomon::random_rays(scene, 4000, 1)).obliquity == Approx(1.0).epsilon(0.1));
}

TEST_CASE("for a sun oblique to a soup the plan keeps boxes along its rays, and their hits are all others'") {
  const auto triangles = gnomon::test::soup(3000, 400, 0.3F);
  const auto rays = sun_kinds({1, -1, 1});
  const Plan with = plan_of(triangles, rays, true);
  const Plan without = plan_of(triangles, rays, false);
  const auto fresh = sun({1, -1, 1}, 2000, 3);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const gnomon::Decision& decision = with.decisions[i];
    CAPTURE(decision.rays, decision.reason, decision.framed_share, to_json(with));
    REQUIRE(decision.kept == "light-rays");
    REQUIRE(decision.obliquity == Approx(1.732).epsilon(0.01));
    REQUIRE(decision.framed_share > 0.3);
    REQUIRE(decision.framed_share < 0.9);
    REQUIRE_THAT(decision.reason, Catch::Contains("cheaper on probe rays"));
    const gnomon::OrderedTree& tree = with.trees[decision.tree].tree;
    REQUIRE(tree.bvh.frame);
    gnomon::BuildOptions options;
    options.max_leaf_size = 4;
    if (const auto fault = gnomon::check_bvh(tree.bvh, triangles, options)) FAIL(fault->what);
    const gnomon::OrderedTree& other = without.trees[without.decisions[i].tree].tree;
    REQUIRE_FALSE(other.bvh.frame);
    const double share =
        mean_cost(tree, triangles, fresh, rays[i].query) / mean_cost(other, triangles, fresh, rays[i].query);
    CAPTURE(share);
    REQUIRE(share < 0.75);
    const bool any = rays[i].query == Query::kAny;
    const auto hits = gnomon::trace_reference(tree.bvh, triangles, fresh, any, tree.ranks).hits;
    const auto expected = gnomon::trace_reference(other.bvh, triangles, fresh, any, other.ranks).hits;
    std::size_t met = 0;
    for (std::size_t r = 0; r < fresh.size(); ++r) {
      CAPTURE(r);
      REQUIRE((hits[r].primitive == GN_NONE) == (expected[r].primitive == GN_NONE));
      if (!any) REQUIRE(std::memcmp(&hits[r], &expected[r], sizeof(GnHit)) == 0);
      met += hits[r].primitive != GN_NONE ? 1 : 0;
    }
    REQUIRE(met > 500);
  }
  // Kept trees alone are handed over, each decision's where it says.
  REQUIRE(with.trees.size() == 4);
  for (const gnomon::Decision& decision : with.decisions)
    REQUIRE(with.trees[decision.tree].name == decision.kept);
}

TEST_CASE("JSON says what a plan thinks of boxes along the rays") {
  const auto triangles = gnomon::test::soup(500, 401, 0.3F);
  const auto json = nlohmann::json::parse(to_json(plan_of(triangles, sun_kinds({1, -1, 1}), true)));
  REQUIRE(json["decisions"][0]["light_space"]["obliquity"].get<double>() == Approx(1.732).epsilon(0.01));
  REQUIRE(json["decisions"][0]["light_space"]["framed_share"].get<double>() < 0.9);
  REQUIRE(json["decisions"][0]["trials"][0]["name"] == "light-rays");
  REQUIRE(json["trees"].back()["boxes_in_frame"] == true);
  REQUIRE(json["trees"][0]["boxes_in_frame"] == false);
  const auto along = nlohmann::json::parse(to_json(plan_of(triangles, sun_kinds({0.1F, -1, 0.1F}), true)));
  REQUIRE(along["decisions"][0]["light_space"]["framed_share"].is_null());
}

TEST_CASE("no frame is looked at for rays along an axis, for few rays, or where none can be traced") {
  const auto triangles = gnomon::test::soup(1000, 402, 0.3F);
  const auto untouched = [&](const Plan& plan) {
    for (const gnomon::Decision& decision : plan.decisions) {
      CAPTURE(decision.rays, decision.kept);
      REQUIRE(decision.framed_share == 0.0);
      for (const gnomon::Trial& trial : decision.trials) REQUIRE_FALSE(trial.name.starts_with("light"));
    }
    for (const gnomon::PlanTree& tree : plan.trees) REQUIRE_FALSE(tree.tree.bvh.frame);
  };
  untouched(plan_of(triangles, sun_kinds({0.1F, -1, 0.1F}), true));
  untouched(plan_of(triangles, sun_kinds({1, -1, 1}, 100.0), true));
  untouched(plan_of(triangles, sun_kinds({1, -1, 1}), false));
}

TEST_CASE("walls along the axes stay in the world's: totals say so before a tree is made") {
  // Tiled walls of the three orientations: in any other frame their boxes are fat.
  std::vector<GnTriangle> walls;
  for (std::size_t flat = 0; flat < 3; ++flat) {
    for (const float height : {0.0F, 3.0F, 7.0F, 10.0F}) {
      for (GnTriangle t : gnomon::test::grid(10, height)) {
        for (float* v : {t.v0, t.v1, t.v2}) std::swap(v[1], v[flat]);
        walls.push_back(t);
      }
    }
  }
  const Plan plan = plan_of(walls, sun_kinds({1, -1, 1}), true);
  for (const gnomon::Decision& decision : plan.decisions) {
    CAPTURE(decision.rays, decision.framed_share, decision.kept);
    REQUIRE(decision.framed_share > 1.1);
    REQUIRE_FALSE(decision.kept.starts_with("light"));
    for (const gnomon::Trial& trial : decision.trials) REQUIRE_FALSE(trial.name.starts_with("light"));
  }
}

TEST_CASE("where time counts, work in a frame is worth more of it than other work") {
  const auto triangles = gnomon::test::soup(3000, 400, 0.3F);
  PlanOptions options;
  options.light_space = true;
  options.framed_work = 10.0;
  const Plan plan = gnomon::make_plan(triangles, sun_kinds({1, -1, 1}), options);
  for (const gnomon::Decision& decision : plan.decisions) {
    CAPTURE(decision.rays, decision.kept);
    REQUIRE(decision.kept.starts_with("light") == (decision.query == Query::kEvery));
  }
}

TEST_CASE("a tree that saves more takes the place of boxes along the rays, where these save little") {
  const auto triangles = gnomon::test::soup(3000, 404, 0.3F);
  // Through a part of the scene, and from within: there moves by sampled rays pay too.
  std::vector<PlanRays> rays{sun_kinds({1, -1, 1})[1]};
  for (std::vector<Ray>* const some : {&rays[0].fit, &rays[0].probe}) {
    for (Ray& ray : *some) {
      for (std::size_t k = 0; k < 3; ++k)
        ray.origin[k] = 4.0F + 0.2F * (ray.origin[k] + 20.0F * ray.direction[k]);
    }
  }
  PlanOptions options;
  options.light_space = true;
  // They save much: nothing else is made.
  const Plan alone = gnomon::make_plan(triangles, rays, options);
  REQUIRE(alone.decisions[0].kept == "light-rays");
  REQUIRE(alone.decisions[0].trials.size() == 1);
  const gnomon::Standing light = alone.decisions[0].trials[0].standing;
  // The same work, taken to be nearly the baseline's.
  options.framed_work = 0.97 * light.baseline / light.cost;
  for (const bool keep_tried : {false, true}) {
    options.keep_tried = keep_tried;
    const Plan plan = gnomon::make_plan(triangles, rays, options);
    const gnomon::Decision& decision = plan.decisions[0];
    CAPTURE(keep_tried, to_json(plan));
    REQUIRE(decision.trials.size() == 2);
    REQUIRE(decision.trials[0].name == "light-rays");
    REQUIRE(decision.trials[0].saving > decision.trials[0].price);
    REQUIRE(decision.kept == "sah-rays");
    REQUIRE(decision.trials[1].saving > decision.trials[0].saving);
    REQUIRE(plan.trees.size() == (keep_tried ? 3 : 2));
    REQUIRE(plan.trees[decision.tree].name == "sah-rays");
    for (const gnomon::Trial& trial : decision.trials) {
      if (trial.tree != 0) REQUIRE(plan.trees[trial.tree].name == trial.name);
      REQUIRE((trial.tree != 0) == (keep_tried || trial.name == "sah-rays"));
    }
  }
}

TEST_CASE("no tree is made along the rays where a few of them cost no less in the baseline put there") {
  const auto triangles = gnomon::test::soup(3000, 400, 0.3F);
  PlanOptions options;
  options.light_space = true;
  options.most_framed_cost = 0.1;
  const Plan plan = gnomon::make_plan(triangles, sun_kinds({1, -1, 1}), options);
  for (const gnomon::Decision& decision : plan.decisions) {
    CAPTURE(decision.rays, decision.kept);
    REQUIRE(decision.framed_share < 0.9);
    // Where every box is looked at, totals are the cost.
    REQUIRE(decision.kept.starts_with("light") == (decision.query == Query::kEvery));
    if (decision.query == Query::kEvery) continue;
    for (const gnomon::Trial& trial : decision.trials) REQUIRE_FALSE(trial.name.starts_with("light"));
  }
}

TEST_CASE("frames' options out of range are refused") {
  PlanOptions options;
  options.least_oblique = 0.5;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("least_oblique"));
  options = {};
  options.most_framed = NAN;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("most_framed"));
  options = {};
  options.framed_work = 0.5;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("framed_work"));
}
