#include "gnomon/compare/plan_entrant.h"

#include <algorithm>
#include <optional>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/compare/traced_tree.h"

namespace gnomon::compare {
namespace {

// As many as plans can take and a race can want; kinds that need hits get fewer than they ask for.
constexpr std::uint64_t kDrawnRays = 4096;
// Far from seeds that measured rays are drawn with.
constexpr std::uint64_t kFitSeed = 0x9e3779b97f4a7c15U;

class PlanEntrant : public Entrant {
 public:
  PlanEntrant(const cl::Context& context, const Scene& scene, const PlanBuilder& builder, RaysToPlan rays)
      : context_(context), scene_(scene), builder_(builder), rays_(std::move(rays)) {}

  void build(const Progress& progress) override {
    trees_.clear();
    plan_ = {};
    const std::vector<PlanRays> rays = drawn();
    if (rays.empty())
      throw Error(ErrorCode::kInvalidArgument, "the scene has no rays of these kinds to plan for");
    PlanOptions how;
    how.light_space = traces_wide(context_.device());
    how.packets = how.light_space;
    how.local_trees = how.light_space;
    plan_ = make_plan(scene_.triangles, rays, how, builder_, progress);
    for (const PlanTree& kept : plan_.trees) trees_.emplace_back(context_, kept.tree, scene_.triangles);
  }

  void trace(const Batch& batch) override { tree_of(batch.kind).trace(batch); }
  Answers answers(const Batch& batch) override { return tree_of(batch.kind).answers(batch); }
  std::vector<Hit> closest(std::span<const Ray> rays) override { return first().closest(rays); }
  std::optional<Work> work(const Batch& batch) override { return tree_of(batch.kind).work(batch); }
  std::vector<float> boxes(std::span<const Ray> rays) override { return first().boxes(rays); }
  const DeviceBvh* device_tree() override { return first().tree(); }

  // All trees it keeps; hashes of those that rays are traced through, in the order of decisions.
  BuildRow facts() override {
    BuildRow row;
    for (TracedTree& tree : trees_) row.bytes += tree.bytes();
    for (const Decision& decision : plan_.decisions) {
      const Bvh& bvh = plan_.trees[decision.tree].tree.bvh;
      const std::string hash = tree_hash(bvh);
      if (row.tree_hash.find(hash) != std::string::npos) continue;
      row.tree_hash += (row.tree_hash.empty() ? "" : ",") + hash;
      const BvhStats stats = stats_of(bvh, {});
      row.nodes += stats.nodes;
      row.max_depth = std::max(row.max_depth, stats.max_depth);
      if (row.sah_cost == 0.0) row.sah_cost = stats.sah_cost;
    }
    row.flavour = first().flavour();
    return row;
  }

  std::vector<DecisionRow> decisions() override {
    std::vector<DecisionRow> rows;
    const double share = plan_.baseline_units > 0.0 ? plan_.planning_units / plan_.baseline_units : 0.0;
    for (const Decision& d : plan_.decisions)
      rows.push_back({"", d.rays, to_string(d.query), d.expected, d.kept, d.reason, d.probes, d.baseline_cost,
                      d.cost, share});
    return rows;
  }

  void forget_tree() override {
    for (TracedTree& tree : trees_) tree.forget_tree();
  }

 private:
  // Through a quickly built tree of its own where they need hits.
  [[nodiscard]] std::vector<PlanRays> drawn() const {
    std::optional<TracedTree> tree;
    return rays_([&](std::span<const Ray> rays) {
      if (!tree) tree.emplace(context_, build_device(context_, scene_.triangles), TracedTree::Options{});
      return tree->closest(rays);
    });
  }

  TracedTree& tree_of(const std::string& kind) {
    const auto decision = std::find_if(plan_.decisions.begin(), plan_.decisions.end(),
                                       [&](const Decision& d) { return d.rays == kind; });
    return decision == plan_.decisions.end() ? trees_.front() : trees_[decision->tree];
  }
  // Of the first kind: for rays that are of none.
  TracedTree& first() { return trees_[plan_.decisions.front().tree]; }

  const cl::Context& context_;
  const Scene& scene_;
  PlanBuilder builder_;
  RaysToPlan rays_;
  Plan plan_;
  std::vector<TracedTree> trees_;
};

}  // namespace

RaysToPlan drawn_for(const Scene& scene, const PlanSource& source) {
  return [&scene, source](const FindHits& closest) {
    std::vector<PlanRays> out;
    for (const std::string& kind : source.kinds) {
      PlanRays rays;
      rays.name = kind;
      rays.query = is_any_hit(kind) ? Query::kAny : Query::kClosest;
      rays.expected = kPlannedRays;
      if (rays.query == Query::kAny) rays.regions = bounded_areas_of_lights(scene);
      if (const auto known = ray_kind_from(kind)) rays.together = run_together(*known, scene);
      rays.fit = draw_rays(scene, closest, kind, kDrawnRays, source.seed + 1);
      rays.probe = draw_rays(scene, closest, kind, kDrawnRays, source.seed + 2);
      if (rays.fit.empty()) continue;
      // A file has no seed: every other ray is fitted to, the rest judge.
      if (!is_ray_kind(kind)) {
        rays.fit.clear();
        std::vector<Ray> judges;
        for (std::size_t i = 0; i < rays.probe.size(); ++i)
          (i % 2 == 0 ? rays.fit : judges).push_back(rays.probe[i]);
        rays.probe = std::move(judges);
      }
      out.push_back(std::move(rays));
    }
    return out;
  };
}

RaysToPlan planned_for(const RaysOf& rays) {
  return [rays](const FindHits&) {
    PlanRays out;
    out.name = rays.name;
    out.query = Query::kClosest;
    out.expected = kPlannedRays;
    out.fit = area_rays(rays.area, rays.measure, kDrawnRays, kFitSeed);
    out.probe = area_rays(rays.area, rays.measure, kDrawnRays, kFitSeed + 1);
    out.regions = {rays.area};
    return std::vector<PlanRays>{out};
  };
}

std::unique_ptr<Entrant> enter_plan(const cl::Context& context, const Scene& scene,
                                    const PlanBuilder& builder, const RaysToPlan& rays) {
  return std::make_unique<PlanEntrant>(context, scene, builder, rays);
}

}  // namespace gnomon::compare
