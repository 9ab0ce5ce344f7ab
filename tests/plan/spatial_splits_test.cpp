// Plans for scenes whose large triangles are worth dividing: the best tree is the baseline, what is made of
// it is sound and answers alike, and elsewhere nothing more is made.
#include <catch2/catch.hpp>

#include "gnomon/plan/choose.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_best_reference.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/parts.h"
#include "support/shapes.h"

using gnomon::Plan;
using gnomon::PlanOptions;
using gnomon::PlanRays;
using gnomon::Query;
using gnomon::Ray;

namespace {

using Triangles = std::vector<GnTriangle>;

// Many small triangles among few large ones, so many of the cube's lattice that some meet its planes exactly.
const Triangles& divided() {
  static const Triangles triangles = gnomon::test::corners_in_planes(3000, 150, 91);
  return triangles;
}

// Out of a corner of the cube, into a cone: not what surface area expects.
std::vector<Ray> cone(std::uint32_t count, std::uint32_t seed) {
  gnomon::test::Random random(seed);
  std::vector<Ray> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    out.push_back(gnomon::test::ray({-1.0F, -1.0F, -1.0F},
                                    {1.0F, random.between(0.2F, 0.6F), random.between(0.1F, 0.4F)}));
  }
  return out;
}

std::vector<PlanRays> rays_of_all_queries(double expected = 1e8) {
  std::vector<PlanRays> out;
  for (const Query query : {Query::kClosest, Query::kAny, Query::kEvery})
    out.push_back({to_string(query), query, cone(512, 1), cone(1024, 2), expected});
  return out;
}

Plan plan_with(const std::string& choice, double expected = 1e8, bool keep = false) {
  PlanOptions options;
  options.choice = choice;
  options.keep_tried = keep;
  return gnomon::make_plan(divided(), rays_of_all_queries(expected), options);
}

double mean_cost(const gnomon::OrderedTree& tree, Query query) {
  const std::vector<Ray> rays = cone(2000, 3);
  double sum = 0.0;
  for (const double cost : gnomon::ray_costs(tree, divided(), rays, query)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

// Parts of leaves' triangles, each held once, cover them: of the best builder's promises all hold.
void require_sound(const gnomon::Bvh& bvh) {
  gnomon::BuildOptions options;
  options.builder = gnomon::Builder::kBest;
  options.max_leaf_size = 4;
  REQUIRE(bvh.primitives.size() > divided().size());
  if (const auto fault = gnomon::check_bvh(bvh, divided(), options)) FAIL(fault->what);
}

void require_same_hits(const gnomon::OrderedTree& tree, const gnomon::Bvh& plain) {
  std::vector<Ray> rays = cone(1000, 4);
  for (const Ray& ray : gnomon::test::random_rays(1000, 5, -2.0F, 18.0F)) rays.push_back(ray);
  const auto expected = gnomon::trace_reference(plain, divided(), rays, false).hits;
  const auto closest = gnomon::trace_reference(tree.bvh, divided(), rays, false).hits;
  const auto any = gnomon::trace_reference(tree.bvh, divided(), rays, true, tree.ranks).hits;
  std::size_t met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(closest[i].primitive == expected[i].primitive);
    REQUIRE((expected[i].primitive == GN_NONE || closest[i].t == expected[i].t));
    REQUIRE((any[i].primitive == GN_NONE) == (expected[i].primitive == GN_NONE));
    met += expected[i].primitive != GN_NONE ? 1 : 0;
  }
  REQUIRE(met > 500);
}

}  // namespace

TEST_CASE("where spatial splits pay the best tree is the baseline, and sampled rays go on from it") {
  REQUIRE(gnomon::divides_any(divided(), gnomon::kPartBudget));
  const gnomon::Bvh plain = gnomon::build_reference(divided());
  const Plan plan = plan_with("auto", 1e8, true);
  const Plan sah = plan_with("sah");
  REQUIRE(plan.trees[0].name == "best");
  REQUIRE(sah.trees[0].name == "sah");
  REQUIRE(plan.baseline_units > sah.baseline_units);
  for (const gnomon::PlanTree& tree : plan.trees) {
    CAPTURE(tree.name);
    require_sound(tree.tree.bvh);
    require_same_hits(tree.tree, plain);
  }
  for (const gnomon::Decision& decision : plan.decisions) {
    CAPTURE(decision.rays, decision.kept, decision.reason);
    REQUIRE(decision.kept == "best-rays");
    REQUIRE(decision.trials.at(0).name == "best-rays");
    const double best = mean_cost(plan.trees[0].tree, decision.query);
    REQUIRE(best < 0.95 * mean_cost(sah.trees[0].tree, decision.query));
    REQUIRE(mean_cost(plan.trees[decision.tree].tree, decision.query) < 0.98 * best);
    REQUIRE(decision.baseline_cost == Approx(best).epsilon(0.1));
  }
  REQUIRE(plan.trees[plan.decisions[1].tree].tree.ranks.size() ==
          plan.trees[plan.decisions[1].tree].tree.bvh.nodes.size());
  REQUIRE(to_json(plan) == to_json(plan_with("auto", 1e8, true)));
}

TEST_CASE("the best tree serves few rays too, and its order is learnt where moves bring nothing") {
  const Plan few = plan_with("auto", 10.0);
  REQUIRE(few.trees.size() == 1);
  for (const gnomon::Decision& decision : few.decisions) {
    CAPTURE(decision.rays);
    REQUIRE(decision.kept == "best");
    REQUIRE(decision.trials.empty());
  }
  PlanOptions options;
  options.sampled.least_saved = 1e6F;  // no move
  const Plan still = gnomon::make_plan(divided(), rays_of_all_queries(), options);
  REQUIRE(still.decisions[0].kept == "best");
  REQUIRE_THAT(still.decisions[0].reason, Catch::Contains("sampled rays save"));
  REQUIRE(still.decisions[1].kept == "best-order");
}

TEST_CASE("no boxes along the rays are tried beside a tree of parts") {
  PlanOptions options;
  options.light_space = true;
  std::vector<Ray> sun = cone(512, 6);
  for (Ray& ray : sun) std::fill_n(ray.direction, 3, 1.0F);
  const std::vector<PlanRays> rays{{"sun", Query::kEvery, sun, sun, 1e8}};
  const Plan plan = gnomon::make_plan(divided(), rays, options);
  REQUIRE(plan.decisions[0].obliquity > 1.7);
  REQUIRE(plan.decisions[0].framed_share == 0.0);
  for (const gnomon::Trial& trial : plan.decisions[0].trials) REQUIRE(trial.name != "light-rays");
}

TEST_CASE("where no triangle is divided best is sah by another name, asked for by name alone") {
  const auto scene = gnomon::generate_scene("cottage", 7000, 1);
  REQUIRE_FALSE(gnomon::divides_any(scene.triangles, gnomon::kPartBudget));
  const std::vector<PlanRays> rays{{"primary", Query::kClosest, gnomon::primary_rays(scene, 512, 1),
                                    gnomon::primary_rays(scene, 1024, 2), 1e8}};
  const auto plan = [&](const std::string& choice) {
    PlanOptions options;
    options.choice = choice;
    return gnomon::make_plan(scene.triangles, rays, options);
  };
  for (const std::string way : {"", "-rays"}) {
    CAPTURE(way);
    const Plan sah = plan("sah" + way);
    const Plan best = plan("best" + way);
    REQUIRE(best.trees.back().name == "best" + way);
    REQUIRE(tree_hash(best.trees.back().tree.bvh) == tree_hash(sah.trees.back().tree.bvh));
    REQUIRE(best.baseline_units == sah.baseline_units);
  }
  REQUIRE(plan("auto").trees[0].name == "sah");
}
