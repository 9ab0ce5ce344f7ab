// The list of our methods. A new one is one more line here.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/areas/measure.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/own_entrant.h"

namespace gnomon::compare {
namespace {

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
           const std::optional<RaysOf>& rays = std::nullopt, Accuracy accuracy = Accuracy::kWatertight) {
    OwnMethod own{build, rays, accuracy};
    MethodFacts own_facts = facts;
    own_facts.exact = accuracy == Accuracy::kWatertight;
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
  }

  [[nodiscard]] std::vector<Method> take() { return std::move(methods_); }

 private:
  const cl::Context& context_;
  const Scene& scene_;
  std::vector<Method> methods_;
};

}  // namespace

std::optional<RaysOf> first_light(const Scene& scene) {
  for (const LightArea& light : areas_of_lights(scene)) {
    const bool parallel = light.area.kind() == AreaKind::kPlane;
    const std::string index = std::to_string(light.light);
    const std::string& name = scene.lights[light.light].name;
    return RaysOf{"light " + index + (name.empty() ? "" : " (" + name + ")"), "--light " + index, light.area,
                  parallel ? RayMeasure::kParallel : RayMeasure::kSolidAngle};
  }
  return std::nullopt;
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

std::vector<Method> own_methods(const cl::Context& context, const Scene& scene) {
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
           surface(Builder::kBalanced), std::nullopt, Accuracy::kFast);
  const auto light = first_light(scene);
  if (light) list.add_published(*light, "light");
  if (const auto camera = first_camera(scene)) {
    list.add({"pah-near-plane@camera", Family::kRays, "projected areas for the rays of " + camera->name,
              "--heuristic near-plane " + camera->options},
             for_rays(*camera, true, AxisPolicy::kAll), camera);
  }
  list.add({"sah+lsph", Family::kSurface, "surface area heuristic, long sides divided first", "--axes lsph"},
           surface(Builder::kBalanced, AxisPolicy::kLsph));
  return list.take();
}

}  // namespace gnomon::compare
