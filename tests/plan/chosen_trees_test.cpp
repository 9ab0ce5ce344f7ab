// Which of a plan's trees are taken: what costs probes least, never what costs them more than the tree at
// hand, unless a tree was asked for.
#include "gnomon/plan/chosen_trees.h"

#include <catch2/catch.hpp>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"

using gnomon::Bvh;
using gnomon::choose_trees;
using gnomon::ChosenTree;
using gnomon::Plan;
using gnomon::PlanRays;
using gnomon::Query;
using gnomon::Ray;
using gnomon::TreesWanted;

namespace {

const gnomon::Scene& cottage() {
  static const gnomon::Scene scene = gnomon::generate_scene("cottage", 7000, 1);
  return scene;
}

// Halved by count: dear to trace.
Bvh poor() {
  gnomon::BuildOptions options;
  options.median_depth = 1;
  return gnomon::build_reference(cottage().triangles, options);
}

Bvh plain() {
  return gnomon::build_reference(cottage().triangles);
}

// By the area that rays along one axis see.
Bvh for_axis(std::size_t axis) {
  gnomon::BuildOptions options;
  for (std::size_t k = 0; k < 3; ++k) options.measure.weights[k] = k == axis ? 1.0F : 0.01F;
  return gnomon::build_reference(cottage().triangles, options);
}

std::vector<Ray> along(std::size_t axis, std::uint64_t seed) {
  std::vector<Ray> rays = gnomon::random_rays(cottage(), 400, seed);
  for (Ray& ray : rays) {
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = k == axis ? 1.0F : 1e-3F;
  }
  return rays;
}

double cost_in(const Bvh& bvh, const std::vector<Ray>& rays, Query query = Query::kEvery) {
  double sum = 0.0;
  for (const double cost : gnomon::ray_costs({bvh, {}}, cottage().triangles, rays, query)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

// A plan that has these trees and keeps kept[i] for kind i.
Plan plan_of(const std::vector<Bvh>& trees, const std::vector<std::size_t>& kept) {
  Plan plan;
  for (std::size_t i = 0; i < trees.size(); ++i)
    plan.trees.push_back({"tree " + std::to_string(i), {trees[i], {}}, 0.0, 0});
  for (const std::size_t tree : kept) {
    gnomon::Decision decision;
    decision.rays = "kind " + std::to_string(plan.decisions.size());
    decision.tree = tree;
    plan.decisions.push_back(decision);
  }
  return plan;
}

std::vector<ChosenTree> chosen(const Plan& plan, const std::vector<PlanRays>& rays, TreesWanted wanted,
                               bool or_plain, const Bvh& at_hand) {
  return choose_trees(plan, rays, cottage().triangles, at_hand, wanted, or_plain);
}

}  // namespace

TEST_CASE("a plan's tree is taken where it costs probes less than the tree at hand, or by name") {
  const std::vector<PlanRays> rays{{"random", Query::kClosest, gnomon::random_rays(cottage(), 300, 1),
                                    gnomon::primary_rays(cottage(), 300, 2), 1e6}};
  const Bvh good = plain();
  const Bvh bad = poor();
  const auto one = [&](const Bvh& kept, const Bvh& at_hand, TreesWanted wanted, bool or_plain) {
    return chosen(plan_of({kept}, {0}), rays, wanted, or_plain, at_hand).at(0);
  };
  for (const TreesWanted wanted : {TreesWanted::kOneEach, TreesWanted::kOneForAll}) {
    const ChosenTree better = one(good, bad, wanted, true);
    REQUIRE(better.tree == std::optional<std::size_t>(0));
    REQUIRE(better.name == "tree 0");
    REQUIRE(better.rays == (wanted == TreesWanted::kOneForAll ? "all" : "kind 0"));
    // Each by its own rays.
    const auto saved = [&](const std::vector<Ray>& some) {
      return 1.0 - cost_in(good, some, Query::kClosest) / cost_in(bad, some, Query::kClosest);
    };
    REQUIRE(better.predicted == Approx(saved(rays[0].fit)));
    REQUIRE(better.measured == Approx(saved(rays[0].probe)));
    REQUIRE(better.measured != Approx(better.predicted));
    const ChosenTree worse = one(bad, good, wanted, true);
    REQUIRE_FALSE(worse.tree);
    REQUIRE(worse.name == "plain");
    REQUIRE(worse.measured == 0.0);
    const ChosenTree asked = one(bad, good, wanted, false);
    REQUIRE(asked.tree == std::optional<std::size_t>(0));
    REQUIRE(asked.measured < 0.0);
    REQUIRE_FALSE(one(good, good, wanted, true).tree);
  }
}

TEST_CASE("each kind of rays gets what the plan keeps for it") {
  const std::vector<PlanRays> rays{{"kind 0", Query::kEvery, along(0, 1), along(0, 2), 1e6},
                                   {"kind 1", Query::kEvery, along(2, 1), along(2, 2), 1e6}};
  const Plan plan = plan_of({plain(), for_axis(0), for_axis(2)}, {2, 1});
  const auto each = chosen(plan, rays, TreesWanted::kOneEach, false, poor());
  REQUIRE(each.size() == 2);
  REQUIRE(each[0].tree == std::optional<std::size_t>(2));
  REQUIRE(each[1].tree == std::optional<std::size_t>(1));
  REQUIRE(each[1].rays == "kind 1");
}

TEST_CASE("one tree for all is the one that the rays to come cost least in together") {
  const Bvh x = for_axis(0);
  const Bvh z = for_axis(2);
  std::vector<PlanRays> rays{{"x", Query::kEvery, along(0, 1), along(0, 2), 1.0},
                             {"z", Query::kEvery, along(2, 1), along(2, 2), 1.0}};
  REQUIRE(cost_in(x, rays[0].probe) < cost_in(z, rays[0].probe));
  REQUIRE(cost_in(z, rays[1].probe) < cost_in(x, rays[1].probe));
  const Plan plan = plan_of({poor(), x, z}, {1, 2});
  for (const std::size_t many : {0U, 1U}) {
    rays[many].expected = 1e6;
    rays[1 - many].expected = 1.0;
    const auto all = chosen(plan, rays, TreesWanted::kOneForAll, true, poor());
    REQUIRE(all.size() == 1);
    REQUIRE(all[0].tree == std::optional<std::size_t>(1 + many));
  }
  // By name the baseline is not taken where there is another tree, though it costs less.
  const Plan named = plan_of({plain(), poor()}, {1, 1});
  const auto asked = chosen(named, rays, TreesWanted::kOneForAll, false, plain());
  REQUIRE(asked[0].tree == std::optional<std::size_t>(1));
}

TEST_CASE("one tree for all has no order, trees for each kind have theirs") {
  const std::vector<PlanRays> rays{{"any", Query::kAny, gnomon::random_rays(cottage(), 300, 1),
                                    gnomon::random_rays(cottage(), 300, 2), 1e6}};
  Plan plan = plan_of({plain()}, {0});
  plan.trees[0].tree.ranks.assign(plan.trees[0].tree.bvh.nodes.size(), 1.0F);
  const auto cost_of = [&](const gnomon::OrderedTree& tree) {
    double sum = 0.0;
    for (const double cost : gnomon::ray_costs(tree, cottage().triangles, rays[0].probe, Query::kAny))
      sum += cost;
    return sum;
  };
  const double before = cost_of({poor(), {}});
  const double ordered = cost_of(plan.trees[0].tree);
  const double unordered = cost_of({plain(), {}});
  REQUIRE(ordered != Approx(unordered));
  const auto measured = [&](TreesWanted wanted) {
    return chosen(plan, rays, wanted, false, poor())[0].measured;
  };
  REQUIRE(measured(TreesWanted::kOneForAll) == Approx(1.0 - unordered / before));
  REQUIRE(measured(TreesWanted::kOneEach) == Approx(1.0 - ordered / before));
}
