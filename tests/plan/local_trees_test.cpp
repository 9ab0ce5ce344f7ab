// Local trees in plans: which regions they are for, kept where they pay and nowhere else, with the hits of
// any other tree; refused where none can be traced.
#include <catch2/catch.hpp>
#include <cstring>
#include <nlohmann/json.hpp>

#include "gnomon/areas/area_rays.h"
#include "gnomon/base/error.h"
#include "gnomon/plan/choose.h"
#include "gnomon/plan/local_sets.h"
#include "support/region_trees.h"

using gnomon::build_reference;
using gnomon::Decision;
using gnomon::InfluenceArea;
using gnomon::local_sets;
using gnomon::LocalSets;
using gnomon::OrderedTree;
using gnomon::Plan;
using gnomon::PlanOptions;
using gnomon::PlanRays;
using gnomon::Query;
using gnomon::Ray;
using Triangles = std::vector<GnTriangle>;

namespace {

constexpr double kMany = 1e9;

// A spot above a cube of side 10 that lights a part of it.
InfluenceArea spot(double x, double fov) {
  gnomon::PointView view;
  view.eye = {x, 14, 5};
  view.direction = {0, -1, 0};
  view.up = {0, 0, 1};
  view.fov_x = view.fov_y = fov;
  view.near_distance = 0.01;
  view.far_distance = 18.0;
  return InfluenceArea::point(view);
}

// Rays of the lamps in turn, up to the scene's floor or on.
std::vector<Ray> rays_of(const std::vector<InfluenceArea>& lamps, std::uint64_t count, std::uint64_t seed) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < lamps.size(); ++i) {
    const auto own = area_rays(lamps[i], gnomon::RayMeasure::kSolidAngle, count / lamps.size(), seed + i);
    rays.insert(rays.end(), own.begin(), own.end());
  }
  return rays;
}

PlanRays kind_of(const std::vector<InfluenceArea>& lamps, Query query, double expected = kMany) {
  PlanRays out{to_string(query), query, rays_of(lamps, 600, 1), rays_of(lamps, 1200, 100), expected};
  out.regions = lamps;
  return out;
}

Plan plan_of(const Triangles& triangles, const PlanRays& rays, const std::string& choice = "auto",
             bool local_trees = true) {
  PlanOptions options;
  options.local_trees = local_trees;
  options.choice = choice;
  return make_plan(triangles, std::span(&rays, 1), options);
}

const OrderedTree& kept_by(const Plan& plan) {
  return plan.trees[plan.decisions.front().tree].tree;
}

double mean_cost(const OrderedTree& tree, const Triangles& triangles, const std::vector<Ray>& rays,
                 Query query) {
  double sum = 0.0;
  for (const double cost : ray_costs(tree, triangles, rays, query)) sum += cost;
  return sum / static_cast<double>(rays.size());
}

void require_same_hits(const OrderedTree& tree, const OrderedTree& other, const Triangles& triangles,
                       const std::vector<Ray>& rays) {
  for (const bool any : {false, true}) {
    const auto hits = trace_ordered(tree, triangles, rays, any).hits;
    const auto expected = trace_reference(other.bvh, triangles, rays, any, other.ranks).hits;
    REQUIRE(hits.size() == expected.size());
    for (std::size_t i = 0; i < hits.size(); ++i) {
      CAPTURE(any, i);
      REQUIRE((hits[i].primitive == GN_NONE) == (expected[i].primitive == GN_NONE));
      if (!any) REQUIRE(std::memcmp(&hits[i], &expected[i], sizeof(GnHit)) == 0);
    }
  }
}

bool tried(const Decision& decision) {
  return std::any_of(decision.trials.begin(), decision.trials.end(),
                     [](const gnomon::Trial& trial) { return trial.name == "local-rays"; });
}

}  // namespace

TEST_CASE("walking a tree finds the triangles of a region that looking at each one finds") {
  gnomon::BuildOptions in_parts;
  in_parts.builder = gnomon::Builder::kBest;
  const Triangles soup = gnomon::test::soup(1500, 700, 1.0F);
  Triangles needles = gnomon::test::soup(300, 701, 9.0F);
  for (GnTriangle& t : needles) {
    for (std::size_t k = 0; k < 3; ++k) t.v2[k] = t.v1[k] + 0.01F * (t.v2[k] - t.v1[k]);
  }
  gnomon::LocalLimits limits;
  limits.least_share = 0.0;
  limits.most_members = 1.0;
  std::size_t some = 0;
  for (const Triangles& triangles :
       {gnomon::test::scaled(soup, 1.0F, -5.0F), gnomon::test::scaled(needles, 1.0F, -5.0F)}) {
    for (const bool parts : {false, true}) {
      const auto tree = build_reference(triangles, parts ? in_parts : gnomon::test::leaves_of(1));
      if (parts && triangles.size() < 1000) REQUIRE(tree.primitives.size() > triangles.size());
      for (const auto& [name, area] : gnomon::test::areas_of_every_kind()) {
        CAPTURE(name, parts, triangles.size());
        const auto rays = gnomon::test::rays_in(area, 60, 702);
        const LocalSets found = local_sets(tree, triangles, rays, std::span(&area, 1), limits);
        if (found.sets.empty()) continue;
        REQUIRE(found.sets[0].members == members(found.sets[0].area, triangles));
        some += 1;
        // One fewer may be: it is not taken.
        gnomon::LocalLimits tight = limits;
        tight.most_members =
            (static_cast<double>(found.sets[0].members.size()) - 0.5) / static_cast<double>(triangles.size());
        const LocalSets none = local_sets(tree, triangles, rays, std::span(&area, 1), tight);
        REQUIRE(none.looked_at >= 1);
        REQUIRE((none.sets.empty() || none.sets[0].members.size() < found.sets[0].members.size()));
      }
    }
  }
  REQUIRE(some > 20);
}

TEST_CASE("rays are counted for the first region that has them, and regions of few rays are left out") {
  const Triangles triangles = gnomon::test::soup(2000, 710, 0.3F);
  const auto tree = build_reference(triangles);
  const std::vector<InfluenceArea> lamps{spot(3, 0.2), spot(8, 0.2)};
  const std::vector<Ray> both = rays_of(lamps, 1000, 711);
  const LocalSets sets = local_sets(tree, triangles, both, lamps);
  REQUIRE(sets.looked_at == 2);
  REQUIRE(sets.sets.size() == 2);
  REQUIRE(sets.work > 0.0);
  for (const gnomon::LocalSet& set : sets.sets) {
    REQUIRE(set.share == Approx(0.5).margin(0.01));
    REQUIRE(set.members.size() < triangles.size() / 4);
  }
  // The second has none left, and of the third there are a few.
  const std::vector<InfluenceArea> twice{spot(3, 0.2), spot(3, 0.2), spot(8, 0.2)};
  std::vector<Ray> mostly = rays_of({spot(3, 0.2)}, 1000, 712);
  const std::vector<Ray> few = rays_of({spot(8, 0.2)}, 50, 713);
  mostly.insert(mostly.end(), few.begin(), few.end());
  const LocalSets one = local_sets(tree, triangles, mostly, twice);
  REQUIRE(one.looked_at == 1);
  REQUIRE(one.sets.size() == 1);
  REQUIRE(one.sets[0].share == Approx(1000.0 / 1050.0).margin(0.01));
  REQUIRE(local_sets(tree, triangles, {}, lamps).sets.empty());
  REQUIRE(local_sets({}, {}, both, lamps).sets.empty());
}

TEST_CASE("a region is found for rays that are one pencil or bundle, and none for others") {
  const Triangles triangles = gnomon::test::soup(2000, 720, 0.3F);
  const auto tree = build_reference(triangles);
  gnomon::test::Random random(721);
  std::vector<Ray> camera, sun, shadow, any;
  for (int i = 0; i < 400; ++i) {
    const auto off = [&] { return random.between(-1.0F, 1.0F); };
    camera.push_back(gnomon::test::ray({5, 14, 5}, {0.1F * off(), -1, 0.1F * off()}));
    sun.push_back(gnomon::test::ray({5 + off(), 14, 5 + off()}, {0.3F, -1, 0.1F}));
    const float x = 5 + off();
    const float z = 5 + off();
    shadow.push_back(gnomon::test::ray({x, 0, z}, {5 - x, 14, 5 - z}, 0.0F, 0.999F));
    any.push_back(gnomon::test::ray({5 + 5 * off(), 5 + 5 * off(), 5 + 5 * off()}, {off(), off(), off()}));
  }
  for (const std::vector<Ray>* const rays : {&camera, &sun}) {
    const LocalSets found = local_sets(tree, triangles, *rays, {});
    REQUIRE(found.sets.size() == 1);
    REQUIRE(found.sets[0].share > 0.95);
    REQUIRE(found.least_members < 0.3);
  }
  // They end in front of the lamp, each by as much as it is long: near enough to a point or not, no ray is
  // said to be within that is not.
  for (const gnomon::LocalSet& set : local_sets(tree, triangles, shadow, {}).sets) REQUIRE(set.share <= 1.0);
  REQUIRE(local_sets(tree, triangles, any, {}).looked_at == 0);
}

TEST_CASE("a spot that lights little of a scene has a tree of its own, and its rays all others' hits") {
  const Triangles triangles = gnomon::test::soup(6000, 730, 0.25F);
  const std::vector<InfluenceArea> lamps{spot(4, 0.15), spot(7, 0.15)};
  std::vector<Ray> fresh = rays_of(lamps, 1500, 731);
  const Query query = GENERATE(Query::kClosest, Query::kAny, Query::kEvery);
  CAPTURE(to_string(query));
  const PlanRays rays = kind_of(lamps, query);
  const Plan with = plan_of(triangles, rays);
  const Plan without = plan_of(triangles, rays, "auto", false);
  const Decision& decision = with.decisions.front();
  CAPTURE(decision.reason, to_json(with));
  REQUIRE(decision.kept == "local-rays");
  REQUIRE(decision.regions == 2);
  REQUIRE(decision.local.size() == 2);
  for (const gnomon::LocalUse& use : decision.local) {
    REQUIRE(use.share == Approx(0.5).margin(0.02));
    REQUIRE(use.triangles < triangles.size() / 5);
  }
  const OrderedTree& tree = kept_by(with);
  REQUIRE(tree.local.size() == 2);
  REQUIRE(kept_by(without).local.empty());
  REQUIRE(mean_cost(tree, triangles, fresh, query) <
          0.95 * mean_cost(kept_by(without), triangles, fresh, query));
  // Others go through the tree of all.
  const auto parts = rays_by_tree(tree, fresh);
  REQUIRE(parts.size() == 3);
  REQUIRE(20 * (parts[1].size() + parts[2].size()) > 19 * fresh.size());
  const auto others = gnomon::test::random_rays(500, 732);
  fresh.insert(fresh.end(), others.begin(), others.end());
  require_same_hits(tree, kept_by(without), triangles, fresh);
  const auto json = nlohmann::json::parse(to_json(with));
  REQUIRE(json["decisions"][0]["local"]["regions"] == 2);
  REQUIRE(json["decisions"][0]["local"]["least_share_of_triangles"].get<double>() < 0.2);
  REQUIRE(json["decisions"][0]["local"]["trees"].size() == 2);
  REQUIRE(json["trees"].back()["local"].size() == 2);
  REQUIRE(json["trees"][0]["local"].empty());
}

TEST_CASE("no local tree is made for wide lamps, few rays, unknown regions, or where none can be traced") {
  const Triangles triangles = gnomon::test::soup(3000, 740, 0.25F);
  const auto untouched = [](const Plan& plan) {
    REQUIRE_FALSE(tried(plan.decisions.front()));
    for (const gnomon::PlanTree& tree : plan.trees) REQUIRE(tree.tree.local.empty());
  };
  const Plan wide = plan_of(triangles, kind_of({spot(5, 1.2)}, Query::kClosest));
  untouched(wide);
  REQUIRE(wide.decisions.front().regions == 1);
  REQUIRE(wide.decisions.front().least_members == 1.0);
  untouched(plan_of(triangles, kind_of({spot(5, 0.15)}, Query::kClosest, 1000.0)));
  untouched(plan_of(triangles, kind_of({spot(5, 0.15)}, Query::kClosest), "auto", false));
  PlanRays unknown = kind_of({spot(5, 0.15)}, Query::kClosest);
  unknown.regions.clear();
  const Plan plan = plan_of(triangles, unknown);
  untouched(plan);
  REQUIRE(plan.decisions.front().regions == 0);
  REQUIRE(
      nlohmann::json::parse(to_json(plan))["decisions"][0]["local"]["least_share_of_triangles"].is_null());
}

TEST_CASE("a local tree is kept only where it is surely better than what is kept without") {
  const Triangles triangles = gnomon::test::soup(6000, 745, 0.25F);
  const PlanRays rays = kind_of({spot(5, 0.5)}, Query::kClosest);
  PlanOptions options;
  options.local_trees = true;
  // It is some hundredths better.
  for (const double least : {0.01, 0.05}) {
    options.race.least_gain = least;
    const Plan plan = make_plan(triangles, std::span(&rays, 1), options);
    const Decision& decision = plan.decisions.front();
    CAPTURE(least, to_json(plan));
    REQUIRE(decision.trials.size() == 2);
    REQUIRE(decision.trials[0].standing.verdict == gnomon::Verdict::kBetter);
    REQUIRE(decision.trials[1].standing.cost < 0.99 * decision.trials[0].standing.cost);
    REQUIRE(decision.kept == (least < 0.02 ? "local-rays" : "sah-rays"));
    REQUIRE(decision.local.empty() == (decision.kept == "sah-rays"));
  }
}

TEST_CASE("a ray in a tree with local ones costs what its own tree takes, and the regions looked at for it") {
  const Triangles triangles = gnomon::test::soup(2000, 746, 0.25F);
  const std::vector<InfluenceArea> lamps{spot(3, 0.2), spot(8, 0.2)};
  OrderedTree tree{build_reference(triangles)};
  tree.local = gnomon::test::region_trees(triangles, {grown_by(lamps[0], 1e-3), grown_by(lamps[1], 1e-3)});
  const std::vector<Ray> rays = rays_of({lamps[0], lamps[1], spot(5, 1.5)}, 600, 747);
  const auto parts = rays_by_tree(tree, rays);
  const auto costs = ray_costs(tree, triangles, rays, Query::kClosest);
  for (std::size_t i = 0; i < 3; ++i) {
    REQUIRE(parts[i].size() > 100);
    const OrderedTree own{i == 0 ? tree.bvh : tree.local[i - 1].bvh};
    const double looked_at = i == 1 ? 1.0 : 2.0;
    for (const std::uint32_t ray : parts[i]) {
      const double alone = ray_costs(own, triangles, std::span(&rays[ray], 1), Query::kClosest)[0];
      REQUIRE(costs[ray] == Approx(alone + gnomon::kRegionCost * looked_at));
    }
  }
}

TEST_CASE("local trees are made by name without a test, also for regions that have to be detected") {
  const Triangles triangles = gnomon::test::soup(3000, 750, 0.25F);
  PlanRays rays = kind_of({spot(5, 0.15)}, Query::kClosest, 1.0);
  rays.regions.clear();
  const Plan plan = plan_of(triangles, rays, "local-rays");
  const Decision& decision = plan.decisions.front();
  CAPTURE(decision.reason, to_json(plan));
  REQUIRE(decision.kept == "local-rays");
  REQUIRE(decision.reason == "asked for");
  REQUIRE(decision.local.size() == 1);
  require_same_hits(kept_by(plan), plan.trees.front().tree, triangles, rays.probe);
  const Plan none = plan_of(triangles, kind_of({spot(5, 1.2)}, Query::kClosest, 1.0), "local-rays");
  REQUIRE(none.decisions.front().kept == "sah");
  REQUIRE_THAT(none.decisions.front().reason, Catch::Contains("more than 50.0 % of the triangles"));
  PlanRays noise = rays;
  noise.fit = gnomon::test::random_rays(600, 751);
  const Plan lost = plan_of(triangles, noise, "local-rays");
  REQUIRE_THAT(lost.decisions.front().reason, Catch::Contains("within no region"));
  REQUIRE_THROWS_WITH(plan_of(triangles, rays, "local-rays", false), Catch::Contains("local_trees"));
  PlanOptions options;
  options.most_local = 1.5;
  REQUIRE_THROWS_WITH(options.check(), Catch::Contains("most_local"));
}
