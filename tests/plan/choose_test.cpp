// Plans: never dearer than the best surface-area tree on other rays, nothing where it cannot pay, and they
// say why.
#include "gnomon/plan/choose.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"

using gnomon::Plan;
using gnomon::PlanOptions;
using gnomon::PlanRays;
using gnomon::Query;
using gnomon::Ray;
using gnomon::Scene;

namespace {

constexpr double kMany = 1e8;

const Scene& cottage() {
  static const Scene scene = gnomon::generate_scene("cottage", 7000, 1);
  return scene;
}

std::vector<Ray> shadow(std::uint64_t count, std::uint64_t seed) {
  static const gnomon::Bvh bvh = gnomon::build_reference(cottage().triangles);
  const auto primary = gnomon::primary_rays(cottage(), 2 * count, seed);
  const auto hits = gnomon::trace_reference(bvh, cottage().triangles, primary, false).hits;
  return gnomon::shadow_rays(cottage(), primary, hits, count, seed);
}

std::vector<PlanRays> both_kinds(double expected) {
  return {{"primary", Query::kClosest, gnomon::primary_rays(cottage(), 512, 1),
           gnomon::primary_rays(cottage(), 1024, 2), expected},
          {"shadow", Query::kAny, shadow(512, 1), shadow(1024, 2), expected}};
}

double mean_cost(const gnomon::OrderedTree& tree, const std::vector<Ray>& rays, Query query) {
  double sum = 0.0;
  for (const double cost : gnomon::ray_costs(tree, cottage().triangles, rays, query)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

}  // namespace

TEST_CASE("what a plan keeps is cheaper on rays it has not seen, and sound") {
  const auto rays = both_kinds(kMany);
  const Plan plan = gnomon::make_plan(cottage().triangles, rays);
  REQUIRE(plan.decisions.size() == 2);
  REQUIRE(plan.trees[0].name == "sah");
  const std::vector<std::vector<Ray>> fresh{gnomon::primary_rays(cottage(), 2000, 3), shadow(2000, 3)};
  gnomon::BuildOptions options;
  options.max_leaf_size = 4;
  for (const gnomon::PlanTree& tree : plan.trees) {
    CAPTURE(tree.name);
    if (const auto fault = gnomon::check_bvh(tree.tree.bvh, cottage().triangles, options)) FAIL(fault->what);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const gnomon::Decision& decision = plan.decisions[i];
    CAPTURE(decision.rays, decision.kept, decision.reason);
    REQUIRE(decision.kept != "sah");
    REQUIRE(plan.trees[decision.tree].name == decision.kept);
    const double baseline = mean_cost(plan.trees[0].tree, fresh[i], decision.query);
    REQUIRE(mean_cost(plan.trees[decision.tree].tree, fresh[i], decision.query) < 0.97 * baseline);
    REQUIRE(decision.baseline_cost == Approx(baseline).epsilon(0.1));
    const auto& kept = *std::find_if(decision.trials.begin(), decision.trials.end(),
                                     [&](const gnomon::Trial& trial) { return trial.name == decision.kept; });
    REQUIRE(kept.standing.verdict == gnomon::Verdict::kBetter);
    REQUIRE(kept.saving > kept.price);
    REQUIRE(kept.tree == decision.tree);
  }
  REQUIRE_FALSE(plan.trees[plan.decisions[1].tree].tree.ranks.empty());
  REQUIRE(plan.trees[0].tree.weights.empty());
  for (std::size_t i = 1; i < plan.trees.size(); ++i) {
    const gnomon::OrderedTree& tree = plan.trees[i].tree;
    REQUIRE(tree.weights.size() == tree.bvh.nodes.size());
    // No child is met more often than its parent.
    for (std::size_t n = 0; n < tree.weights.size(); ++n) {
      const gnomon::Node& node = tree.bvh.nodes[n];
      REQUIRE(tree.weights[n] > 0.0F);
      if (node.count > 0) continue;
      const float most = std::max(tree.weights[node.first], tree.weights[node.first + 1]);
      REQUIRE(most <= tree.weights[n] * 1.0001F);
    }
  }
}

TEST_CASE("where few rays come nothing but the baseline is made") {
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(100.0));
  REQUIRE(plan.trees.size() == 1);
  REQUIRE(plan.planning_units < 0.02 * plan.baseline_units);  // totals alone
  REQUIRE(plan.kept_units == 0.0);
  for (const gnomon::Decision& decision : plan.decisions) {
    REQUIRE(decision.kept == "sah");
    REQUIRE(decision.trials.empty());
    REQUIRE_THAT(decision.reason, Catch::Contains("cannot repay"));
  }
}

TEST_CASE("a price that savings do not cover keeps the baseline") {
  PlanOptions options;
  options.prices.byte = 1e9;
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(kMany), options);
  REQUIRE(plan.trees.size() == 1);
  for (const gnomon::Decision& decision : plan.decisions) {
    CAPTURE(decision.rays);
    REQUIRE(decision.kept == "sah");
    REQUIRE_THAT(decision.reason, Catch::Contains("does not repay"));
  }
}

TEST_CASE("a saved unit is worth what is said of it in time") {
  const std::vector<PlanRays> rays{both_kinds(kMany)[0]};
  PlanOptions options;
  options.prices.saved = 0.3;
  const Plan plan = gnomon::make_plan(cottage().triangles, rays, options);
  const gnomon::Trial& trial = plan.decisions[0].trials.at(0);
  REQUIRE(trial.saving == Approx(0.3 * kMany * (trial.standing.baseline - trial.standing.cost)));
  // Nothing to hope for: no candidate is made.
  options.prices.saved = 0.0;
  const Plan none = gnomon::make_plan(cottage().triangles, rays, options);
  REQUIRE(none.decisions[0].trials.empty());
  options.prices.saved = -1.0;
  REQUIRE_THROWS_WITH(gnomon::make_plan(cottage().triangles, rays, options), Catch::Contains("prices"));
}

TEST_CASE("rays that nothing can be done for keep the baseline") {
  // A soup seen from everywhere: surface area is what these rays are.
  const Scene soup = gnomon::generate_scene("random", 3000, 1);
  const std::vector<PlanRays> rays{{"random", Query::kEvery, gnomon::random_rays(soup, 512, 1),
                                    gnomon::random_rays(soup, 1024, 2), kMany}};
  const Plan plan = gnomon::make_plan(soup.triangles, rays);
  CAPTURE(to_json(plan));
  REQUIRE(plan.decisions[0].kept == "sah");
  REQUIRE_THAT(plan.decisions[0].reason,
               Catch::Contains("no candidate") || Catch::Contains("sampled rays save"));
  REQUIRE(plan.kept_units == 0.0);
}

TEST_CASE("planning takes no more than its shares of the baseline's build") {
  const auto rays = both_kinds(kMany);
  PlanOptions options;
  for (const double share : {0.0, 0.02, 0.5}) {
    CAPTURE(share);
    options.sample_share = share;
    const Plan plan = gnomon::make_plan(cottage().triangles, rays, options);
    REQUIRE(plan.kept_units <= plan.planning_units);
    const double beside = plan.planning_units - plan.kept_units;
    double probes = 0.0;
    for (const gnomon::Decision& decision : plan.decisions) probes += decision.probe_units;
    if (plan.decisions[0].kept != "sah" && plan.decisions[1].kept == "sah-rays")
      REQUIRE(beside - probes < 0.02 * plan.baseline_units);
    REQUIRE(plan.planning_units < (2.0 * share + 1.5) * plan.baseline_units);
  }
  // The fewest probes there may be.
  options.probe_share = 0.0;
  for (const gnomon::Decision& decision : gnomon::make_plan(cottage().triangles, rays, options).decisions)
    REQUIRE(decision.probes <= options.race.least);
}

TEST_CASE("where sampled rays bring nothing, any hit still gets its order") {
  PlanOptions options;
  options.sampled.least_saved = 1e6F;  // no move
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(kMany), options);
  REQUIRE(plan.decisions[0].kept == "sah");
  REQUIRE(plan.decisions[0].probes == 0);
  REQUIRE_THAT(plan.decisions[0].reason, Catch::Contains("sampled rays save"));
  REQUIRE(plan.decisions[1].kept == "sah-order");
  REQUIRE(plan.decisions[1].trials.size() == 2);
}

TEST_CASE(
    "rays that packets take together keep the baseline where too little would be left of what is saved") {
  auto rays = both_kinds(kMany);
  rays[0].together = true;
  PlanOptions options;
  options.packet_work = 10.0;
  REQUIRE(gnomon::make_plan(cottage().triangles, rays, options).decisions[0].kept != "sah");
  options.packets = true;
  const Plan plan = gnomon::make_plan(cottage().triangles, rays, options);
  REQUIRE(plan.decisions[0].kept == "sah");
  REQUIRE_THAT(plan.decisions[0].reason, Catch::Contains("packets"));
  REQUIRE(plan.decisions[1].kept != "sah");
  options.packet_work = 0.9;
  REQUIRE_THROWS_WITH(gnomon::make_plan(cottage().triangles, rays, options), Catch::Contains("packet_work"));
}

TEST_CASE("an order is learnt for what may be kept alone") {
  PlanOptions options;
  options.sampled.least_saved = 1e6F;  // no move
  options.keep_tried = true;
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(kMany), options);
  const auto& trials = plan.decisions[1].trials;
  REQUIRE(trials.size() == 2);
  REQUIRE(plan.trees[trials[0].tree].tree.ranks.empty());
  REQUIRE_FALSE(plan.trees[trials[1].tree].tree.ranks.empty());
}

TEST_CASE("a choice by name is kept without a test") {
  PlanOptions options;
  options.light_space = true;
  for (const std::string& name : gnomon::candidate_names()) {
    CAPTURE(name);
    if (name == "local-rays") continue;  // local_trees_test.cpp
    options.choice = name;
    const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(1.0), options);
    REQUIRE(plan.decisions[0].kept ==
            (name == "sah-order" || name == "best-order" ? name.substr(0, name.size() - 6) : name));
    REQUIRE(plan.decisions[1].kept == name);
    REQUIRE(plan.trees[plan.decisions[1].tree].tree.ranks.empty() == (name == "sah" || name == "best"));
    REQUIRE(plan.decisions[1].probes == 0);
    REQUIRE(plan.trees[plan.decisions[1].tree].tree.bvh.frame.has_value() == name.starts_with("light"));
  }
  options = {};
  options.choice = "light-rays";
  REQUIRE_THROWS_WITH(gnomon::make_plan(cottage().triangles, both_kinds(1.0), options),
                      Catch::Contains("light_space"));
  options.choice = "finest";
  REQUIRE_THROWS_WITH(gnomon::make_plan(cottage().triangles, both_kinds(1.0), options),
                      Catch::Contains("finest") && Catch::Contains("mix-rays"));
}

TEST_CASE("boxes that areas see make camera rays cheaper, and diffuse rays have no areas") {
  PlanOptions options;
  options.choice = "sah-seen";
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(1.0), options);
  const auto fresh = gnomon::primary_rays(cottage(), 2000, 3);
  const gnomon::OrderedTree& seen = plan.trees[plan.decisions[0].tree].tree;
  REQUIRE(mean_cost(seen, fresh, Query::kClosest) <
          0.95 * mean_cost(plan.trees[0].tree, fresh, Query::kClosest));
  REQUIRE(plan.trees[plan.decisions[0].tree].build_units > 0.0);
  const std::vector<PlanRays> diffuse{{"random", Query::kClosest, gnomon::random_rays(cottage(), 512, 1),
                                       gnomon::random_rays(cottage(), 1024, 2), 1.0}};
  const Plan none = gnomon::make_plan(cottage().triangles, diffuse, options);
  REQUIRE(tree_hash(none.trees[none.decisions[0].tree].tree.bvh) == tree_hash(none.trees[0].tree.bvh));
}

TEST_CASE("many moves at once by sampled segments make fresh rays of the same kind cheaper") {
  PlanOptions options;
  options.choice = "sah-segments";
  const Plan plan = gnomon::make_plan(cottage().triangles, both_kinds(1.0), options);
  const auto fresh = gnomon::primary_rays(cottage(), 2000, 3);
  const gnomon::PlanTree& moved = plan.trees[plan.decisions[0].tree];
  REQUIRE(mean_cost(moved.tree, fresh, Query::kClosest) <
          0.95 * mean_cost(plan.trees[0].tree, fresh, Query::kClosest));
  REQUIRE(moved.build_units > 0.0);
  REQUIRE(moved.tree.weights.size() == moved.tree.bvh.nodes.size());
}

TEST_CASE("plans are the same again, and JSON tells all of them") {
  const auto rays = both_kinds(kMany);
  PlanOptions options;
  options.keep_tried = true;
  const Plan plan = gnomon::make_plan(cottage().triangles, rays, options);
  const std::string text = to_json(plan);
  REQUIRE(to_json(gnomon::make_plan(cottage().triangles, rays, options)) == text);
  const auto json = nlohmann::json::parse(text);
  REQUIRE(json["trees"].size() == plan.trees.size());
  REQUIRE(json["trees"].size() == 1 + 1 + 1);
  REQUIRE(json["kept_units"].get<double>() == Approx(plan.kept_units));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& decision = json["decisions"][i];
    REQUIRE(decision["kept"] == plan.decisions[i].kept);
    REQUIRE(decision["reason"] == plan.decisions[i].reason);
    REQUIRE(decision["trials"].size() == 1);
    REQUIRE(decision["trials"][0]["probes"].get<std::uint64_t>() >= 128);
  }
}

TEST_CASE("plans without rays or triangles") {
  const Plan none = gnomon::make_plan(cottage().triangles, {});
  REQUIRE(none.trees.size() == 1);
  REQUIRE(none.decisions.empty());
  const Plan empty = gnomon::make_plan({}, both_kinds(kMany));
  REQUIRE(empty.trees.size() == 1);
  REQUIRE(empty.decisions[0].kept == "sah");
  const std::vector<PlanRays> few{{"few", Query::kClosest, gnomon::primary_rays(cottage(), 512, 1),
                                   gnomon::primary_rays(cottage(), 20, 2), kMany}};
  REQUIRE_THAT(gnomon::make_plan(cottage().triangles, few).decisions[0].reason, Catch::Contains("20 probes"));
}

TEST_CASE("plan options out of range are refused") {
  PlanOptions options;
  options.fit_rays = 2000;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("fit_rays"));
  options = {};
  options.mixture_share = -1.0F;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("mixture_share"));
  options = {};
  options.sample_share = -1.0;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("sample_share"));
  options = {};
  options.prices.trace = -1.0;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("prices"));
  auto rays = both_kinds(-1.0);
  REQUIRE_THROWS_WITH(gnomon::make_plan(cottage().triangles, rays),
                      Catch::Contains("expected rays of primary"));
}
