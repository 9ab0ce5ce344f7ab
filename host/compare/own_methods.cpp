// The list of our methods. A new one is one more line here.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/areas/measure.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/own_entrant.h"
#include "gnomon/compare/plan_entrant.h"

namespace gnomon::compare {
namespace {

// Of kBaseline, that a plan for five kinds of rays may take as long as.
constexpr double kPlanBuilds = 100.0;

// Numbers as --direction takes them, exact for floats.
std::string numbers(const Vec3& v) {
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(), "%.9g,%.9g,%.9g", static_cast<double>(v[0]),
                static_cast<double>(v[1]), static_cast<double>(v[2]));
  return text.data();
}

Vec3d to_double(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

BuildOptions surface(Builder builder, AxisPolicy axes = AxisPolicy::kAll) {
  BuildOptions options;
  options.builder = builder;
  options.axes = axes;
  return options;
}

BuildOptions for_rays(const RaysOf& rays, bool culled, AxisPolicy axes, float share = 1.0F) {
  BuildOptions options;
  options.measure = measure_of(rays.area, rays.measure, culled);
  options.axes = axes;
  if (share < 1.0F) options.measure.area_share = share;
  return options;
}

// Surface area, with the rays for the policy to go by, as --axes spfh makes it.
BuildOptions facing(const RaysOf& rays) {
  BuildOptions options = for_rays(rays, true, AxisPolicy::kSpfh);
  options.policy.rays_from_point = options.measure.kind != GN_MEASURE_LINEAR;
  options.measure.kind = GN_MEASURE_LINEAR;
  for (float& weight : options.measure.weights) weight = 1.0F;
  options.measure.breaks_ties = 0;
  return options;
}

const char* option_of(RayMeasure measure, bool culled) {
  switch (measure) {
    case RayMeasure::kParallel:
      return culled ? "window" : "plane";
    case RayMeasure::kSolidAngle:
      return "solid-angle";
    case RayMeasure::kNearPlane:
      return "near-plane";
    case RayMeasure::kYawPitch:
      return "yaw-pitch";
  }
  return "?";
}

class List {
 public:
  List(const cl::Context& context, const Scene& scene) : context_(context), scene_(scene) {}

  void add(const MethodFacts& facts, const BuildOptions& build,
           const std::optional<RaysOf>& rays = std::nullopt, const TracedTree::Options& tracing = {}) {
    OwnMethod own{build, rays, tracing};
    MethodFacts own_facts = facts;
    own_facts.exact = tracing.accuracy == Accuracy::kWatertight;
    methods_.push_back(
        {own_facts, [&context = context_, &scene = scene_, own] { return enter_own(context, scene, own); }});
  }

  // The published heuristics for these rays, each with its axis policies, and a mixture with surface area.
  void add_published(const RaysOf& rays, const std::string& tag) {
    const bool parallel = rays.measure == RayMeasure::kParallel;
    const auto method = [&](bool culled, AxisPolicy axes, float share, const std::string& suffix,
                            Family family, const std::string& words) {
      const std::string kind = option_of(rays.measure, culled);
      std::string options = "--heuristic " + kind + " " + rays.options;
      if (axes != AxisPolicy::kAll) options += std::string(" --axes ") + to_string(axes);
      if (share < 1.0F) options += " --share 0.5";
      add({"pah-" + kind + suffix + "@" + tag, family, words + " for the rays of " + rays.name, options},
          for_rays(rays, culled, axes, share), rays);
    };
    if (parallel)
      method(false, AxisPolicy::kAll, 1.0F, "", Family::kRays, "projected areas, without a window,");
    method(true, AxisPolicy::kAll, 1.0F, "", Family::kRays, "projected areas");
    method(true, AxisPolicy::kSpfh, 1.0F, "+spfh", Family::kRays,
           "projected areas, planes that face the rays first,");
    method(true, AxisPolicy::kLsph, 1.0F, "+lsph", Family::kRays,
           "projected areas, long sides divided first,");
    method(true, AxisPolicy::kAll, 0.5F, "+sah", Family::kMixture,
           "projected and surface areas, half and half,");
    add({"sah+spfh@" + tag, Family::kMixture,
         "surface area, planes that face the rays of " + rays.name + " first", "--axes spfh " + rays.options},
        facing(rays));
  }

  void add_plan(const PlanBuilder& builder, const RaysToPlan& rays) {
    methods_.push_back({{"auto", Family::kMixture,
                         "the trees that gnomon plan keeps for these rays, its choosing part of the build",
                         "--plan auto", true},
                        [&context = context_, &scene = scene_, builder, rays] {
                          return enter_plan(context, scene, builder, rays);
                        },
                        kPlanBuilds});
  }

  [[nodiscard]] std::vector<Method> take() { return std::move(methods_); }

 private:
  const cl::Context& context_;
  const Scene& scene_;
  std::vector<Method> methods_;
};

}  // namespace

std::vector<RaysOf> rays_of_lights(const Scene& scene) {
  std::vector<RaysOf> out;
  for (const LightArea& light : areas_of_lights(scene)) {
    const bool parallel = light.area.kind() == AreaKind::kPlane;
    const std::string index = std::to_string(light.light);
    const std::string& name = scene.lights[light.light].name;
    out.push_back({"light " + index + (name.empty() ? "" : " (" + name + ")"), "--light " + index, light.area,
                   parallel ? RayMeasure::kParallel : RayMeasure::kSolidAngle});
  }
  return out;
}

std::optional<RaysOf> first_light(const Scene& scene) {
  const std::vector<RaysOf> lights = rays_of_lights(scene);
  return lights.empty() ? std::nullopt : std::optional(lights.front());
}

std::optional<RaysOf> first_camera(const Scene& scene) {
  if (scene.triangles.empty()) return std::nullopt;
  const Camera camera = scene.cameras.empty() ? default_camera(scene) : scene.cameras.front();
  const float aspect = camera.aspect > 0.0F ? camera.aspect : 1.0F;
  const Bounds bounds = bounds_of(scene);
  double far = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    double squares = 0.0;
    for (unsigned k = 0; k < 3; ++k) {
      const double at = static_cast<double>((corner >> k & 1U) != 0 ? bounds.hi[k] : bounds.lo[k]);
      squares +=
          (at - static_cast<double>(camera.position[k])) * (at - static_cast<double>(camera.position[k]));
    }
    far = std::max(far, std::sqrt(squares));
  }
  PointView view;
  view.eye = to_double(camera.position);
  view.direction = to_double(camera.forward);
  view.up = to_double(camera.up);
  view.fov_y = static_cast<double>(camera.fov_y);
  view.fov_x = 2.0 * std::atan(static_cast<double>(aspect) * std::tan(0.5 * view.fov_y));
  view.far_distance = far;
  view.near_distance = 0x1p-10 * far;
  const auto degrees = [](double radians) { return std::to_string(radians * 180.0 / std::numbers::pi); };
  return RaysOf{"the first camera",
                "--point " + numbers(camera.position) + " --direction " + numbers(camera.forward) +
                    " --fov " + degrees(view.fov_x) + "," + degrees(view.fov_y),
                InfluenceArea::point(view), RayMeasure::kNearPlane};
}

std::vector<Method> own_methods(const cl::Context& context, const Scene& scene, const PlanSource& plan) {
  List list(context, scene);
  list.add({kBaseline, Family::kSurface, "surface area heuristic, top down", "--builder balanced"},
           surface(Builder::kBalanced));
  list.add({"sah-fast", Family::kSurface, "surface area heuristic, bottom up along the Morton curve",
            "--builder fast"},
           surface(Builder::kFast));
  list.add({"sah-best", Family::kSurface,
            "surface area heuristic over parts of large triangles, then optimised", "--builder best"},
           surface(Builder::kBest));
  BuildOptions cheap_triangles = surface(Builder::kBalanced);
  cheap_triangles.cost_triangle = 0.25F;
  list.add({"sah-balanced/cheap-triangles", Family::kSurface,
            "surface area heuristic, top down, a triangle at a quarter of a box, as blocks of eight cost it",
            "--builder balanced --cost-triangle 0.25"},
           cheap_triangles);
  list.add({"sah-balanced/fast-hits", Family::kSurface,
            "the tree of sah-balanced, hits decided by floats alone (gnomon trace --accuracy fast)",
            "--builder balanced"},
           surface(Builder::kBalanced), std::nullopt, {Accuracy::kFast, false});
  const auto light = first_light(scene);
  if (light) list.add_published(*light, "light");
  if (const auto camera = first_camera(scene)) {
    list.add({"pah-near-plane@camera", Family::kRays, "projected areas for the rays of " + camera->name,
              "--heuristic near-plane " + camera->options},
             for_rays(*camera, true, AxisPolicy::kAll), camera);
  }
  list.add_plan(plan.builder, drawn_for(scene, plan));
  list.add({"sah+lsph", Family::kSurface, "surface area heuristic, long sides divided first", "--axes lsph"},
           surface(Builder::kBalanced, AxisPolicy::kLsph));
  list.add(
      {"sah-balanced/portable", Family::kSurface,
       "the tree of sah-balanced, traced by OpenCL C alone, without the device compiler's own instructions",
       "--builder balanced"},
      surface(Builder::kBalanced), std::nullopt, {Accuracy::kWatertight, true});
  return list.take();
}

std::vector<Method> methods_for(const cl::Context& context, const Scene& scene, const RaysOf& rays,
                                const PlanBuilder& builder) {
  List list(context, scene);
  list.add({"pah", Family::kRays, "projected areas", rays.options}, for_rays(rays, true, AxisPolicy::kAll),
           rays);
  list.add({"pah+sah", Family::kMixture, "projected and surface areas, half and half", rays.options},
           for_rays(rays, true, AxisPolicy::kAll, 0.5F), rays);
  list.add_plan(builder, planned_for(rays));
  return list.take();
}

}  // namespace gnomon::compare
