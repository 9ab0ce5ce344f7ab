// Influence areas that are hard: for each, a tree built for its rays is the reference's and loses nothing,
// and a forest with its local tree answers as the global tree alone does, to the last bit.
#include <cmath>
#include <cstring>
#include <numbers>

#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/measure.h"
#include "gnomon/stability/aim.h"
#include "gnomon/stability/area_layers.h"
#include "gnomon/stability/cases.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh_check.h"

namespace gnomon::stability {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Areas over one scene, a cube of side 10.
struct Setting {
  std::vector<InfluenceArea> areas;
  double tolerance = 1.0;  // of affinity
};
using MakeSettings = std::function<std::vector<Setting>()>;

InfluenceArea view(const Vec3d& eye, const Vec3d& direction, double fov, double near_distance,
                   double far_distance = 30.0) {
  PointView v;
  v.eye = eye;
  v.direction = direction;
  v.fov_x = v.fov_y = fov * kDegree;
  v.near_distance = near_distance;
  v.far_distance = far_distance;
  return InfluenceArea::point(v);
}

InfluenceArea window(const Vec3d& point, const Vec3d& direction, double half, double depth) {
  PlaneWindow w;
  w.point = point;
  w.direction = direction;
  w.half_width = w.half_height = half;
  w.depth = depth;
  return InfluenceArea::plane(w);
}

Triangles scene_of(const Bench& bench) {
  Triangles mesh = soup(500, 0.8F, 0.0F, 10.0F, bench.seed);
  append(mesh, hill(5, 2, bench.seed));
  return mesh;
}

std::vector<RayMeasure> measures_of(const InfluenceArea& area) {
  if (area.kind() == AreaKind::kPlane) return {RayMeasure::kParallel};
  if (area.kind() == AreaKind::kOmni) return {RayMeasure::kSolidAngle};
  return {RayMeasure::kSolidAngle, RayMeasure::kNearPlane, RayMeasure::kYawPitch};
}

// The area's own rays, and rays through corners and edges of the scene from anywhere.
std::vector<Ray> rays_for(const Bench& bench, const InfluenceArea& area, const Triangles& mesh) {
  std::vector<Ray> rays = area_rays(area, measures_of(area).front(), bench.rays / 2, bench.seed);
  SteadyRandom random(bench.seed);
  for (std::uint32_t i = 0; i < bench.rays / 2; ++i) {
    const Triangle& t = mesh[random.below(static_cast<unsigned>(mesh.size()))];
    rays.push_back(through(place_on(t, i % 2, random), 12.0F, random));
  }
  for (std::size_t i = 0; i < rays.size();
       i += 8) {  // from the eye, the window's middle or the centre itself
    const Vec3d& o = area.frame().origin;
    for (std::size_t k = 0; k < 3; ++k) rays[i].origin[k] = static_cast<float>(o[k]);
  }
  return rays;
}

bool linear(const GnMeasure& measure) {
  return measure.kind == GN_MEASURE_LINEAR;
}

// The verdicts of one tree's options, one for each flavour; new ones where there are none yet.
std::span<Verdict> verdicts_of(const Bench& bench, const CaseInfo& info, const std::string& builder,
                               std::vector<Verdict>& all) {
  std::size_t at = 0;
  while (at < all.size() && all[at].builder != builder) at += bench.flavours.size();
  if (at >= all.size()) {
    for (const Flavour& flavour : bench.flavours)
      all.push_back(empty_verdict(bench, info, builder, flavour.name));
  }
  return std::span(all).subspan(at, bench.flavours.size());
}

// The device's tree is the reference's, unbroken, and its hits are the oracle's.
void check_tree(const Bench& bench, const Specimen& specimen, const BuildOptions& options,
                std::span<Verdict> verdicts) {
  const DeviceBvh tree = build_device(bench.context, specimen.triangles, options);
  const Bvh bvh = download_bvh(bench.context, tree);
  const auto broken = check_bvh(bvh, specimen.triangles, options);
  const bool same = tree_hash(bvh) == tree_hash(build_reference(specimen.triangles, options));
  for (Verdict& verdict : verdicts) {
    if (broken) verdict.fault(broken->what);
    if (!same) verdict.fault("not the reference's tree");
  }
  if (!broken) judge_specimen(bench, specimen, tree, verdicts);
}

// Trees for the area's rays, and every builder's by surface area under the same rays.
void check_trees(const Bench& bench, const CaseInfo& info, const Setting& setting, const Triangles& mesh,
                 std::vector<Verdict>& all) {
  for (const InfluenceArea& area : setting.areas) {
    const Specimen specimen{mesh, rays_for(bench, area, mesh), Expect::kOracle};
    for (const Builder& builder : bench.builders)
      check_tree(bench, specimen, builder.options, verdicts_of(bench, info, builder.name, all));
    for (const RayMeasure rays : measures_of(area)) {
      for (const bool culled : {false, true}) {
        BuildOptions options;
        options.measure = measure_of(area, rays, culled);
        if (bench.context.device().loop_limit != 0 && !linear(options.measure)) continue;  // refused there
        check_tree(bench, specimen, options, verdicts_of(bench, info, heuristic_name(options), all));
      }
    }
  }
}

void check_lookup(const Bench& bench, const DeviceForest& forest, AreaLookup lookup, const Specimen& specimen,
                  const TraceResult& closest, const TraceResult& any, Verdict& verdict) {
  const DeviceTopLevel top = upload_top_level(
      bench.context, build_top_level(forest.areas, lookup, OctreeOptions{3, false}), forest.shared_areas);
  const ForestTracer tracer(bench.context, forest, top);
  const ForestTraceResult hits = tracer.closest(specimen.rays);
  const ForestTraceResult occluded = tracer.any(specimen.rays);
  judge_answers(specimen, hits.hits, occluded.occluded, hits.invalid_rays, verdict);
  for (std::size_t i = 0; i < specimen.rays.size(); ++i) {
    if (std::memcmp(&hits.hits[i], &closest.hits[i], sizeof(Hit)) != 0 ||
        occluded.occluded[i] != any.occluded[i])
      verdict.fault("ray " + std::to_string(i) + " is answered otherwise than by the global tree");
  }
}

// Forests of the setting's areas, grown by so much, over a scene, for these rays: one by each builder.
void check_forest(const Bench& bench, const CaseInfo& info, const Setting& setting, const Specimen& specimen,
                  double growth, std::vector<Verdict>& forests) {
  std::size_t at = 0;
  for (const Builder& builder : bench.builders) {
    std::vector<LocalTree> trees;
    for (const InfluenceArea& area : setting.areas)
      trees.push_back({area, builder.options, Membership::kExact, setting.tolerance, growth});
    const DeviceForest forest = build_forest(bench.context, specimen.triangles, trees, builder.options);
    const DeviceBvh global = build_device(bench.context, specimen.triangles, builder.options);
    const Tracer alone(bench.context, global);
    const TraceResult closest = alone.closest(specimen.rays);
    const TraceResult any = alone.any(specimen.rays);
    for (const AreaLookup lookup : {AreaLookup::kList, AreaLookup::kBvh, AreaLookup::kOctree}) {
      if (forests.size() <= at)
        forests.push_back(empty_verdict(bench, info, "forest, " + builder.name, to_string(lookup)));
      check_lookup(bench, forest, lookup, specimen, closest, any, forests[at++]);
    }
  }
}

// The scene by all areas' own rays and others; and each area alone among layers just outside it.
void check_forests(const Bench& bench, const CaseInfo& info, const Setting& setting, const Triangles& mesh,
                   std::vector<Verdict>& forests) {
  Specimen scene{mesh, {}, Expect::kOracle};
  for (const InfluenceArea& area : setting.areas) {
    const std::vector<Ray> rays = rays_for(bench, area, mesh);
    scene.rays.insert(scene.rays.end(), rays.begin(), rays.end());
    const Triangles around = layers_around(area, bench.seed);
    const Specimen layers{around, rays_at_layers(area, around, bench.rays, bench.seed), Expect::kOracle};
    check_forest(bench, info, {{area}, setting.tolerance}, layers, 0.0, forests);
  }
  check_forest(bench, info, setting, scene, 0x1p-16, forests);
}

std::vector<Verdict> check_areas(const Bench& bench, const CaseInfo& info, const MakeSettings& settings) {
  std::vector<Verdict> all;
  std::vector<Verdict> forests;
  const Triangles mesh = scene_of(bench);
  for (const Setting& setting : settings()) {
    check_trees(bench, info, setting, mesh, all);
    check_forests(bench, info, setting, mesh, forests);
  }
  all.insert(all.end(), forests.begin(), forests.end());
  return all;
}

std::vector<Setting> frusta(double fov) {
  return {{{view({-4, 5, 5}, {1, 0.1, 0.05}, fov, 0.5)}}, {{view({5, 5, 5}, {0.3, 0.2, 1}, fov, 0.1)}}};
}

std::vector<Setting> lights_along_axes() {
  std::vector<Setting> out;
  for (const Vec3d& d : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1},
                         Vec3d{0, 0, -1}, Vec3d{1, 1, 1}}) {
    const Vec3d middle{5, 5, 5};
    out.push_back({{window(middle - (dot(d, d) > 1.5 ? 6.0 : 9.0) * d, d, 8.0, 20.0)}});
  }
  return out;
}

// Side by side sharing a face, one in another, one the same again.
std::vector<Setting> touching_and_nested() {
  return {{{window({5, 5, 0}, {0, 0, 1}, 3, 5), window({5, 5, 5}, {0, 0, 1}, 3, 5),
            window({5, 5, 5}, {0, 0, 1}, 3, 5), InfluenceArea::omni({5, 5, 5}, 4.0),
            InfluenceArea::omni({5, 5, 5}, 1.0), view({5, 5, 2}, {0, 0, 1}, 40, 0.25, 6)}}};
}

// Rays of all directions to the area's axis meet areas whose tolerance lies at, just below and just above
// |cos| = 1, and at 1, where no direction is refused.
std::vector<Setting> affinities() {
  std::vector<Setting> out;
  for (const double tolerance : {0.0, 0x1p-53, 0.01, 1.0 - 0x1p-53, 1.0}) {
    out.push_back({{window({5, 5, -1}, {0, 0, 1}, 5, 12), InfluenceArea::omni({5, 5, 5}, 5.0)}, tolerance});
  }
  return out;
}

}  // namespace

void add_area_cases(std::vector<Case>& cases) {
  const auto add = [&](std::uint32_t number, const char* name, MakeSettings settings) {
    cases.push_back({{number, "areas", name, "the reference's trees, the global tree's answers"},
                     {},
                     [settings](const Bench& bench, const CaseInfo& info) {
                       return check_areas(bench, info, settings);
                     }});
  };
  add(41, "eye inside boxes", [] {
    return std::vector<Setting>{{{view({5, 5, 5}, {0.2, 0.1, 1}, 90, 0.01)}},
                                {{InfluenceArea::omni({5, 5, 5}, 9)}}};
  });
  add(42, "boxes across the near plane", [] {
    return std::vector<Setting>{{{view({5, 5, -1}, {0, 0, 1}, 100, 6.0)}},
                                {{view({2, 8, 1}, {1, -1, 0.5}, 70, 4.0)}}};
  });
  add(43, "boxes behind the near plane", [] {
    return std::vector<Setting>{{{view({5, 5, -2}, {0, 0, 1}, 60, 20.0)}},
                                {{view({5, 5, 20}, {0, 0, 1}, 60, 1.0)}}};
  });
  add(44, "frusta of 1 degree", [] { return frusta(1.0); });
  add(45, "frusta of 179 degrees", [] { return frusta(179.0); });
  add(46, "light along the axes and (1, 1, 1)", lights_along_axes);
  add(47, "windows that cull everything", [] {
    return std::vector<Setting>{{{window({100, 5, -1}, {0, 0, 1}, 1, 12)}},
                                {{view({5, 5, -50}, {0, 0, -1}, 60, 1.0)}}};
  });
  add(48, "an area outside the scene", [] {
    return std::vector<Setting>{{{InfluenceArea::omni({200, 0, 0}, 5.0)}},
                                {{window({5, 5, 90}, {0, 0, 1}, 3, 5)}}};
  });
  add(49, "touching and nested areas", touching_and_nested);
  add(50, "affinity at its tolerance", affinities);
}

}  // namespace gnomon::stability
