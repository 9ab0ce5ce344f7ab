#include "set_ups.h"

#include <algorithm>
#include <map>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/areas/membership.h"
#include "gnomon/measure/reproduce.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon::bench {

namespace {

constexpr std::uint64_t kFitSeed = 101;
constexpr std::uint64_t kProbeSeed = 202;
constexpr std::uint64_t kMeasureSeed = 303;
constexpr std::uint64_t kFitRays = 1024;  // drawn; a plan takes fewer
constexpr std::uint64_t kProbeRays = 2048;
constexpr std::size_t kFewest = 256;  // fewer rays make no case

using Draw = std::function<std::vector<Ray>(std::uint64_t count, std::uint64_t seed)>;

void add_case(AwareSetUp& out, const std::string& rays, Query query, std::uint64_t count, const Draw& draw,
              const std::vector<InfluenceArea>& regions = {}) {
  RayCase made{rays,
               query,
               {draw(kFitRays, kFitSeed), draw(kProbeRays, kProbeSeed), draw(count, kMeasureSeed)},
               false,
               regions};
  if (std::min({made.draws.fit.size(), made.draws.probe.size(), made.draws.measure.size()}) < kFewest) return;
  out.cases.push_back(std::move(made));
}

// What a camera sees of a scene.
class Sight {
 public:
  explicit Sight(const Scene& scene) : scene_(scene), bvh_(build_reference(scene.triangles)) {}

  // Rays that `follow(primary, hits, count, seed)` makes at what is seen.
  template <typename Follow>
  [[nodiscard]] std::vector<Ray> from(std::uint64_t views, std::uint64_t seed, const Follow& follow) const {
    const std::vector<Ray> primary = primary_rays(scene_, views, seed);
    const std::vector<Hit> hits = trace_reference(bvh_, scene_.triangles, primary, false).hits;
    return follow(primary, hits, views, seed);
  }

  [[nodiscard]] std::vector<Ray> unstopped(std::vector<Ray> rays) const {
    const std::vector<Hit> hits = trace_reference(bvh_, scene_.triangles, rays, true).hits;
    std::vector<Ray> out;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].primitive == GN_NONE) out.push_back(rays[i]);
    }
    return out;
  }

 private:
  const Scene& scene_;
  Bvh bvh_;
};

Vec3 to_float(const Vec3d& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// The light whose rays an area's are.
Light light_of(const InfluenceArea& area) {
  Light light;
  light.kind = area.kind() == AreaKind::kPlane ? LightKind::kDirectional : LightKind::kPoint;
  light.position = to_float(area.frame().origin);
  light.direction = to_float(area.frame().forward);
  return light;
}

// Those that begin in the area, up to where they leave it: by a plane area's window.
std::vector<Ray> inside(const InfluenceArea& area, const std::vector<Ray>& rays, std::uint64_t count) {
  std::vector<Ray> out;
  for (Ray ray : rays) {
    if (!area.contains({ray.origin[0], ray.origin[1], ray.origin[2]})) continue;
    if (area.kind() == AreaKind::kPlane) {
      const auto exit = area.exit_distance(to_ray3d(ray));
      if (exit) ray.tmax = std::min(ray.tmax, static_cast<float>(*exit));
    }
    out.push_back(ray);
  }
  return thinned(out, count);
}

}  // namespace

PlanRays to_plan_for(const RayCase& rays, double expected) {
  return {rays.rays, rays.query, rays.draws.fit, rays.draws.probe, expected, rays.together, rays.regions};
}

AwareSetUp thesis_set_up(const SetUp& set_up, const Scene& scene, std::uint64_t rays) {
  const InfluenceArea& area = set_up.area;
  AwareSetUp out{"thesis", set_up.label(), {}, {}};
  for (const std::uint32_t i : members(area, scene.triangles)) out.triangles.push_back(scene.triangles[i]);
  const Draw of_area = [&](std::uint64_t count, std::uint64_t seed) {
    return area_rays(area, ray_measures_of(area).front(), count, seed);
  };
  add_case(out, "area", Query::kClosest, rays, of_area);
  add_case(out, "area", Query::kEvery, rays, of_area);
  Scene lit = scene;
  lit.lights = {light_of(area)};
  const Sight sight(lit);
  const Draw shadow = [&](std::uint64_t count, std::uint64_t seed) {
    const auto follow = [&](const auto& primary, const auto& hits, std::uint64_t most, std::uint64_t own) {
      return inside(area, shadow_rays(lit, primary, hits, most, own), count);
    };
    return sight.from(16 * count, seed, follow);
  };
  add_case(out, "shadow", Query::kAny, rays, shadow);
  add_case(out, "lit", Query::kAny, rays, [&](std::uint64_t count, std::uint64_t seed) {
    return thinned(sight.unstopped(shadow(4 * count, seed)), count);
  });
  return out;
}

AwareSetUp generated_set_up(const std::string& name, const Scene& scene, std::uint64_t rays) {
  AwareSetUp out{"generated", name, scene.triangles, {}};
  const Sight sight(scene);
  add_case(out, "primary", Query::kClosest, rays,
           [&](std::uint64_t count, std::uint64_t seed) { return primary_rays(scene, count, seed); });
  out.cases.back().together = true;
  add_case(out, "bounce", Query::kClosest, rays, [&](std::uint64_t count, std::uint64_t seed) {
    return thinned(
        sight.from(2 * count, seed, [&](const auto&... seen) { return bounce_rays(scene, seen...); }), count);
  });
  const Draw shadow = [&](std::uint64_t count, std::uint64_t seed) {
    return thinned(
        sight.from(4 * count, seed, [&](const auto&... seen) { return shadow_rays(scene, seen...); }), count);
  };
  const std::size_t before = out.cases.size();
  const std::vector<InfluenceArea> lit = bounded_areas_of_lights(scene);
  add_case(out, "shadow", Query::kAny, rays, shadow, lit);
  const Draw unstopped = [&](std::uint64_t count, std::uint64_t seed) {
    return thinned(sight.unstopped(shadow(4 * count, seed)), count);
  };
  add_case(out, "lit", Query::kAny, rays, unstopped, lit);
  for (std::size_t i = before; i < out.cases.size(); ++i)
    out.cases[i].together = run_together(RayKind::kShadow, scene);
  std::size_t lights = 0;
  for (const LightArea& light : areas_of_lights(scene)) {
    if (++lights > 2) break;
    const RayMeasure measure =
        light.area.kind() == AreaKind::kPlane ? RayMeasure::kParallel : RayMeasure::kSolidAngle;
    const Draw of_light = [&](std::uint64_t count, std::uint64_t seed) {
      return area_rays(light.area, measure, count, seed);
    };
    for (const Query query : {Query::kClosest, Query::kEvery})
      add_case(out, "light " + std::to_string(light.light), query, rays, of_light, {light.area});
  }
  return out;
}

void for_each_thesis_set_up(const SetUpSources& sources, const VisitSetUp& visit) {
  std::map<std::string, Scene> scenes;
  for (const SetUp& set_up : read_set_ups(sources.configs)) {
    if (is_lost(set_up.scene) || set_up.label().find(sources.only) == std::string::npos) continue;
    const auto [at, fresh] = scenes.try_emplace(set_up.scene);
    const std::string source = scene_source_of(set_up.scene);
    if (fresh && !source.starts_with("gen:")) at->second = import_scene(sources.models + "/" + source);
    if (fresh && source.starts_with("gen:"))
      at->second = generate_scene(source.substr(4), source == "gen:random100" ? 100 : 1000, 1);
    visit(thesis_set_up(set_up, at->second, sources.rays));
  }
}

void for_each_generated_set_up(const SetUpSources& sources, const VisitSetUp& visit) {
  for (const std::string& name : sources.scenes)
    visit(generated_set_up(name, generate_scene(name, sources.triangles, 1), sources.rays));
}

}  // namespace gnomon::bench
