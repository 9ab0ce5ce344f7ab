#include "figures.h"

#include <cmath>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/projection.h"
#include "gnomon/measure/node_box.h"
#include "gnomon/measure/overlap.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon::bench {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

// From a hit, a little back to where its ray came from, to the light; none where the light does not reach.
std::optional<GnRay> shadow_ray(const LightCase& light, const GnRay& seen_by, const GnHit& hit) {
  GnRay ray{};
  Vec3d place{};
  for (std::size_t k = 0; k < 3; ++k) {
    place[k] = seen_by.origin[k] + 0.9999 * static_cast<double>(hit.t) * seen_by.direction[k];
    ray.origin[k] = static_cast<float>(place[k]);
  }
  if (!light.area.contains(place)) return std::nullopt;
  const bool parallel = light.area.kind() == AreaKind::kPlane;
  const Vec3d to_light = parallel ? -light.area.frame().forward : light.area.frame().origin - place;
  for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = static_cast<float>(to_light[k]);
  ray.tmin = 0.0F;
  ray.tmax = parallel ? kInfinite : 0.9999F;
  return ray;
}

// Inner nodes whose division tells no ray from another.
double idle_share_of(const Bvh& tree, const LightCase& light) {
  std::uint64_t inner = 0;
  std::uint64_t idle = 0;
  for (const Node& node : tree.nodes) {
    if (node.count > 0) continue;
    inner += 1;
    const double whole = culled_measure(light.area, box_of(node), light.rays);
    const double left = culled_measure(light.area, box_of(tree.nodes[node.first]), light.rays);
    const double right = culled_measure(light.area, box_of(tree.nodes[node.first + 1]), light.rays);
    idle += smaller(left, right) >= (1.0 - 1e-6) * whole ? 1 : 0;
  }
  return inner == 0 ? 0.0 : static_cast<double>(idle) / static_cast<double>(inner);
}

}  // namespace

CaseRays rays_of(const CaseScene& scene, const LightCase& light, std::uint64_t count) {
  CaseRays rays;
  rays.own = area_rays(light.area, light.rays, count, kMeasureSeed);
  rays.other = random_rays(scene.scene, count, kMeasureSeed);
  const std::vector<GnRay> seen = primary_rays(scene.scene, count, kMeasureSeed);
  const Bvh tree = build_reference(scene.scene.triangles);
  const std::vector<Hit> hits = trace_reference(tree, scene.scene.triangles, seen, false).hits;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (hits[i].primitive == GN_NONE) continue;
    if (const auto ray = shadow_ray(light, seen[i], hits[i])) rays.shadow.push_back(*ray);
  }
  return rays;
}

Work work_of(const Bvh& tree, std::span<const GnTriangle> triangles, std::span<const GnRay> rays,
             bool any_hit) {
  Work sum;
  if (rays.empty()) return sum;
  for (const GnRayCounters& counters : trace_reference(tree, triangles, rays, any_hit).counters) {
    sum.boxes += counters.boxes;
    sum.triangles += counters.triangles;
  }
  const auto count = static_cast<double>(rays.size());
  return {sum.boxes / count, sum.triangles / count};
}

TreeFigures figures_of(const CaseScene& scene, const LightCase& light, const Method& method,
                       const CaseRays& rays) {
  const std::vector<GnTriangle>& triangles = scene.scene.triangles;
  TreeFigures out;
  out.tree = build_reference(triangles, method.options, &out.tally);
  out.stats = stats_of(out.tree, method.options);
  out.idle_share = idle_share_of(out.tree, light);
  if (light.area.kind() != AreaKind::kOmni) {
    const bool plane = light.area.kind() == AreaKind::kPlane;
    out.overlap_4 =
        sibling_overlap(out.tree, light.area, plane ? RayMeasure::kParallel : RayMeasure::kNearPlane, 4);
  }
  out.predicted = predicted_cost(out.tree, light.area, light.rays);
  out.predicted_surface = predicted_surface_cost(out.tree);
  out.pierced = mean_of(all_pierced_costs(out.tree, rays.own));
  out.closest = work_of(out.tree, triangles, rays.own, false);
  out.any = work_of(out.tree, triangles, rays.own, true);
  out.shadow = work_of(out.tree, triangles, rays.shadow, true);
  out.other = work_of(out.tree, triangles, rays.other, false);
  return out;
}

}  // namespace gnomon::bench
