#include "gnomon/measure/reproduce.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/membership.h"
#include "gnomon/measure/area_measure.h"
#include "gnomon/measure/overlap.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/scene/triangle_check.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon {
namespace {

using Clock = std::chrono::steady_clock;
using Triangles = std::vector<GnTriangle>;

Triangles chosen(std::span<const GnTriangle> triangles, const std::vector<std::uint32_t>& members,
                 const char* how) {
  Triangles out;
  out.reserve(members.size());
  for (const std::uint32_t member : members) out.push_back(triangles[member]);
  if (out.empty())
    throw Error(ErrorCode::kBadScene, std::string("no triangle of the scene is in the influence area (") +
                                          how + "): is it the scene that the set-up means?");
  return out;
}

// Every triangle that touches the area, but for those without area.
Triangles exact_members(const InfluenceArea& area, std::span<const GnTriangle> triangles) {
  Triangles solid;
  std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(solid),
               [](const GnTriangle& t) { return fault_of(t) == TriangleFault::kNone; });
  return chosen(solid, members(area, solid), "exact");
}

// Three axes, leaves by the cost that is measured.
BuildOptions three_axes(const GnMeasure& measure) {
  BuildOptions options;
  options.measure = measure;
  options.bins = 32;
  options.cost_traversal = static_cast<float>(kPiercedInnerCost);
  options.cost_triangle = static_cast<float>(kPiercedTriangleCost);
  return options;
}

Work work_of(const ReferenceTrace& trace) {
  Work sum;
  for (const GnRayCounters& counters : trace.counters) {
    sum.boxes += counters.boxes;
    sum.triangles += counters.triangles;
  }
  const double count = std::max<double>(1.0, static_cast<double>(trace.counters.size()));
  return {sum.boxes / count, sum.triangles / count};
}

double hit_share_of(const std::vector<Hit>& hits) {
  const auto met =
      std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.primitive != GN_NONE; });
  return hits.empty() ? 0.0 : static_cast<double>(met) / static_cast<double>(hits.size());
}

// A batch of rays, and what the global tree does with it.
struct Batch {
  RayMeasure measure;
  std::vector<GnRay> rays;
  std::vector<double> global_costs;
  double global_hit_share;
};

Batch batch_of(const InfluenceArea& area, RayMeasure measure, const ReproduceScene& scene,
               const ReproduceOptions& options) {
  Batch batch{measure, area_rays(area, measure, options.rays, options.seed), {}, 0.0};
  batch.global_costs = all_pierced_costs(scene.global, batch.rays);
  batch.global_hit_share =
      hit_share_of(trace_reference(scene.global, scene.scene.triangles, batch.rays, false).hits);
  return batch;
}

void add_totals(TreeRun& run, const std::vector<double>& local, const std::vector<Hit>& hits,
                const Batch& batch) {
  std::vector<double> total = local;
  std::vector<double> missed;
  for (std::size_t i = 0; i < total.size(); ++i) {
    if (hits[i].primitive != GN_NONE) continue;
    total[i] += batch.global_costs[i];
    missed.push_back(batch.global_costs[i]);
  }
  run.global = mean_of(batch.global_costs);
  run.global_hit_share = batch.global_hit_share;
  run.miss_cost = mean_of(missed).mean;
  run.total = mean_of(total);
  if (run.miss_cost > 0.0)
    run.break_even_hit_share = (run.local.mean + run.miss_cost - run.global.mean) / run.miss_cost;
}

// Names are the caller's to give.
TreeRun run_tree(const Bvh& tree, const Triangles& triangles, const InfluenceArea& area, const Batch& batch,
                 const BuildOptions& options) {
  TreeRun run;
  run.rays = batch.measure;
  run.triangles = triangles.size();
  run.stats = stats_of(tree, options);
  const std::vector<double> costs = all_pierced_costs(tree, batch.rays);
  run.local = mean_of(costs);
  const ReferenceTrace closest = trace_reference(tree, triangles, batch.rays, false);
  run.closest = work_of(closest);
  run.any = work_of(trace_reference(tree, triangles, batch.rays, true));
  run.local_hit_share = hit_share_of(closest.hits);
  add_totals(run, costs, closest.hits, batch);
  const RayMeasure flat = area.kind() == AreaKind::kPlane ? RayMeasure::kParallel : RayMeasure::kNearPlane;
  run.predicted_published = predicted_cost(tree, area, flat);
  run.predicted_matching =
      flat == batch.measure ? run.predicted_published : predicted_cost(tree, area, batch.measure);
  run.predicted_surface = predicted_surface_cost(tree);
  constexpr std::array<std::uint32_t, 5> kLevels{4, 7, 10, 15, kAllLevels};
  for (std::size_t i = 0; i < kLevels.size(); ++i)
    run.overlap[i] = sibling_overlap(tree, area, flat, kLevels[i]);
  return run;
}

Bvh build_timed(const TreeBuilder& build, const Triangles& triangles, const BuildOptions& options,
                double& ms) {
  const auto start = Clock::now();
  Bvh tree = build(triangles, options);
  ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return tree;
}

// Recounted by the reference builder, which makes the same tree as a device but can say how.
void add_effort(TreeRun& run, const Triangles& triangles, const BuildOptions& options) {
  SplitTally tally;
  static_cast<void>(build_reference(triangles, options, &tally));
  if (tally.inner_nodes == 0) return;
  const auto share = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(tally.inner_nodes);
  };
  run.planes_tried = share(tally.axes_tried);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    run.axis_share[axis] = share(tally.split_on[axis]);
    run.axis_fallback_share[axis] = share(tally.fallback_on[axis]);
  }
}

PublishedVariant variant_named(const std::string& name) {
  for (const PublishedVariant variant : {PublishedVariant::kFull, PublishedVariant::kFacing,
                                         PublishedVariant::kStandard, PublishedVariant::kLongest}) {
    if (name == to_string(variant)) return variant;
  }
  throw Error(ErrorCode::kInvalidArgument,
              "there is no variant \"" + name + "\"; there are Full, Facing, Standard and Longest");
}

std::vector<PublishedVariant> variants_of(const SetUp& set_up) {
  std::vector<PublishedVariant> out;
  for (const std::string& name : set_up.variants) out.push_back(variant_named(name));
  std::sort(out.begin(), out.end());
  if (!out.empty() && out.front() == PublishedVariant::kFull && set_up.area.kind() == AreaKind::kPoint)
    out.push_back(PublishedVariant::kTrueLongest);
  return out;
}

void run_published(SetUpReport& report, const SetUp& set_up, const Batch& batch, const ReproduceScene& scene,
                   const TreeBuilder& build) {
  const InfluenceArea& area = set_up.area;
  const Triangles triangles =
      chosen(scene.scene.triangles, published_members(area, scene.scene.triangles), "octree-vertices");
  for (const PublishedVariant variant : variants_of(set_up)) {
    const BuildOptions options = published_options(variant, area);
    double ms = 0.0;
    const Bvh tree = build_timed(build, triangles, options, ms);
    TreeRun run = run_tree(tree, triangles, area, batch, options);
    run.builder = to_string(variant);
    run.heuristics = heuristics_of(variant, area.kind());
    run.members = "octree-vertices";
    run.build_ms = ms;
    add_effort(run, triangles, options);
    report.trees.push_back(std::move(run));
  }
}

struct BuiltTree {
  Bvh tree;
  BuildOptions options;
  double ms = 0.0;
};

BuiltTree build_three_axes(const TreeBuilder& build, const Triangles& triangles, const GnMeasure& measure) {
  BuiltTree built{{}, three_axes(measure), 0.0};
  built.tree = build_timed(build, triangles, built.options, built.ms);
  return built;
}

// Rays of one measure through a tree, beside what every measure of the area says.
void add_predictions(std::vector<PredictionRun>& out, const Bvh& tree, const InfluenceArea& area,
                     RayMeasure rays, const ReproduceOptions& options) {
  const auto costs =
      all_pierced_costs(tree, area_rays(area, rays, options.prediction_rays, options.seed + 1));
  const MeanCost real = mean_of(costs);
  for (const RayMeasure measure : ray_measures_of(area))
    out.push_back({rays, measure, false, real, predicted_cost(tree, area, measure)});
  out.push_back({rays, rays, true, real, predicted_surface_cost(tree)});
}

void run_ours(SetUpReport& report, const InfluenceArea& area, const Batch& published,
              const ReproduceScene& scene, const ReproduceOptions& options, const TreeBuilder& build,
              const Progress& progress) {
  const Triangles triangles = exact_members(area, scene.scene.triangles);
  const BuiltTree sah = build_three_axes(build, triangles, surface_area_measure());
  for (const RayMeasure measure : ray_measures_of(area)) {
    const Batch batch = measure == published.measure ? published : batch_of(area, measure, scene, options);
    const BuiltTree pah = build_three_axes(build, triangles, area_measure(area, measure));
    for (const auto& [name, built] : {std::pair{"SAH3", &sah}, {"PAH3", &pah}}) {
      TreeRun run = run_tree(built->tree, triangles, area, batch, built->options);
      run.builder = name;
      run.heuristics = heuristic_name(built->options);
      run.members = "exact";
      run.build_ms = built->ms;
      add_effort(run, triangles, built->options);
      report.trees.push_back(std::move(run));
    }
    add_predictions(report.predictions, pah.tree, area, measure, options);
    gnomon::report(progress, "three-axis trees", 1.0);
  }
}

}  // namespace

ReproduceScene prepare_scene(Scene scene, const TreeBuilder& build) {
  ReproduceScene out{std::move(scene), {}, {}};
  out.hash = scene_hash(out.scene);
  out.global = build(out.scene.triangles, published_global_options());
  return out;
}

std::vector<RayMeasure> ray_measures_of(const InfluenceArea& area) {
  if (area.kind() == AreaKind::kPlane) return {RayMeasure::kParallel};
  if (area.kind() == AreaKind::kOmni) return {RayMeasure::kSolidAngle};
  return {RayMeasure::kYawPitch, RayMeasure::kNearPlane, RayMeasure::kSolidAngle};
}

SetUpReport run_set_up(const SetUp& set_up, const ReproduceScene& scene, const ReproduceOptions& options,
                       const TreeBuilder& build, const Progress& progress) {
  SetUpReport report;
  const Batch batch = batch_of(set_up.area, ray_measures_of(set_up.area).front(), scene, options);
  run_published(report, set_up, batch, scene, build);
  const auto& variants = set_up.variants;
  if (std::find(variants.begin(), variants.end(), "Full") != variants.end())
    run_ours(report, set_up.area, batch, scene, options, build, progress);
  return report;
}

std::vector<PredictionRun> check_predictions(const InfluenceArea& area, const ReproduceScene& scene,
                                             const ReproduceOptions& options, const TreeBuilder& build) {
  const Triangles triangles = exact_members(area, scene.scene.triangles);
  std::vector<PredictionRun> out;
  for (const RayMeasure measure : ray_measures_of(area)) {
    const BuiltTree pah = build_three_axes(build, triangles, area_measure(area, measure));
    add_predictions(out, pah.tree, area, measure, options);
  }
  return out;
}

}  // namespace gnomon
