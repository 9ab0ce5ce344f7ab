#include "gnomon/plan/seen_areas.h"

#include <variant>

#include "gnomon/areas/detect.h"
#include "gnomon/areas/measure.h"

namespace gnomon {

namespace {

// Of the rays, that a group must have for boxes to be measured as it sees them.
constexpr double kLeastShare = 0.05;

// How much surface area counts beside what a group's rays see.
constexpr double kSurfaceShare = 0.05;

double work_of(const ReferenceTrace& trace) {
  double sum = 0.0;
  for (const GnRayCounters& counters : trace.counters)
    sum += kBoxCost * counters.boxes + kTriangleCost * counters.triangles;
  return sum;
}

// Where an area's rays begin and end along its forward axis.
struct Depths {
  float near_depth;
  float far_depth;
};

Depths depths_of(const InfluenceArea& area) {
  if (const auto* box = std::get_if<OrientedBox>(&area.region()))
    return {0.0F, 2.0F * static_cast<float>(box->half[2])};
  const auto& frustum = std::get<Frustum>(area.region());
  return {static_cast<float>(frustum.near_distance), static_cast<float>(frustum.far_distance)};
}

}  // namespace

SeenAreas seen_areas(const Bvh& tree, std::span<const Triangle> triangles, std::span<const Ray> rays) {
  SeenAreas out;
  if (tree.nodes.empty() || rays.empty()) return out;
  DetectOptions options;
  options.least_share = kLeastShare;
  options.most_groups = GN_MOST_COST_AREAS;
  options.bounds.emplace();
  for (const float* corner : {tree.nodes.front().lo, tree.nodes.front().hi})
    extend(*options.bounds, {corner[0], corner[1], corner[2]});
  const Detection found = detect(rays, options);
  for (const RayGroup& group : found.groups) out.coverage += group.coverage;
  for (const RayGroup& group : found.groups) {
    const bool plane = group.area.kind() == AreaKind::kPlane;
    const bool mapped = group.area.kind() != AreaKind::kOmni;
    AreaCost cost;
    cost.measure = measure_of(group.area, plane ? RayMeasure::kParallel : RayMeasure::kSolidAngle, mapped);
    if (mapped) {
      const Depths depths = depths_of(group.area);
      const std::vector<Ray> looks = depth_rays(cost.measure, depths.near_depth, depths.far_depth);
      const ReferenceTrace seen = trace_reference(tree, triangles, looks, false);
      cost.map = depth_map_of(cost.measure, depths.near_depth, depths.far_depth, seen.hits);
      out.traced += work_of(seen);
    }
    // Face weights have the rest: 1 less what is said of these rays.
    cost.share = static_cast<float>(group.coverage / (1.0 - (1.0 - kSurfaceShare) * out.coverage));
    out.areas.push_back(std::move(cost));
  }
  return out;
}

}  // namespace gnomon
