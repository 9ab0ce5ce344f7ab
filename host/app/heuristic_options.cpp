#include "heuristic_options.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "document.h"
#include "gnomon/areas/areas_from_scene.h"
#include "gnomon/areas/measure.h"
#include "numbers.h"
#include "options.h"

namespace gnomon::app {

const char* const kHeuristicHelp =
    "Heuristics say which rays the tree is for:\n"
    "  sah          from everywhere (surface area)\n"
    "  plane        parallel ones, of a sun: the area each box shows them\n"
    "  window       the same, but only those through the light's window count\n"
    "  solid-angle  from a point, even in all directions that it shines in\n"
    "  near-plane   from a point, even over a picture's plane, as a camera's are\n"
    "  yaw-pitch    from a point, even in yaw and pitch\n"
    "The rays are those of a light of the scene (--light 0 is the first; gnomon info numbers them), or your "
    "own:\n"
    "--direction alone: parallel; --point alone: all ways; both: a view, --fov wide and high.\n";

namespace {

struct Heuristic {
  const char* name;
  RayMeasure measure;
  bool culled;
};
constexpr std::array<Heuristic, 5> kHeuristics{{{"plane", RayMeasure::kParallel, false},
                                                {"window", RayMeasure::kParallel, true},
                                                {"solid-angle", RayMeasure::kSolidAngle, true},
                                                {"near-plane", RayMeasure::kNearPlane, true},
                                                {"yaw-pitch", RayMeasure::kYawPitch, true}}};
constexpr std::array<AxisPolicy, 3> kPolicies{AxisPolicy::kAll, AxisPolicy::kSpfh, AxisPolicy::kLsph};
// A view begins this share of its reach from the eye: it must begin somewhere.
constexpr double kNearShare = 0x1p-10;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

// Numbers of an option, "x,y,z". Says how many are wanted when they are not that.
std::vector<double> numbers_of(const std::string& option, const std::string& text, std::size_t count) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != count) {
    refuse(option + " " + text + ": write " +
           (count == 3 ? "three numbers, as 0.3,-1,0.2" : "two numbers, as 60,45"));
  }
  return *numbers;
}

Vec3d vector_of(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = numbers_of(option, text, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

Vec3d direction_of(const HeuristicOptions& options) {
  const Vec3d direction = vector_of("--direction", options.direction);
  if (direction[0] == 0.0 && direction[1] == 0.0 && direction[2] == 0.0) {
    refuse("--direction " + options.direction + " leads nowhere: at least one number must not be 0");
  }
  return direction;
}

// Full angles in radians.
std::array<double, 2> fov_of(const HeuristicOptions& options) {
  if (options.fov.empty()) return {std::numbers::pi / 3.0, std::numbers::pi / 3.0};
  const std::vector<double> degrees = numbers_of("--fov", options.fov, 2);
  for (const double angle : degrees) {
    if (!(angle > 0.0 && angle < 180.0))
      refuse("--fov " + options.fov + ": angles are between 0 and 180 degrees");
  }
  return {degrees[0] * std::numbers::pi / 180.0, degrees[1] * std::numbers::pi / 180.0};
}

bool has_rays(const HeuristicOptions& options) {
  return options.light || !options.direction.empty() || !options.point.empty();
}

Vec3 to_float(const Vec3d& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::string name_of(const HeuristicOptions& options, const Scene& scene) {
  if (options.light) {
    const Light& light = scene.lights.at(*options.light);
    const std::string kind = kind_name(light.kind);
    return "light " + std::to_string(*options.light) + " (" + kind +
           (light.name.empty() ? ")" : " \"" + light.name + "\")");
  }
  std::string name;
  if (!options.point.empty()) name += "--point " + options.point;
  if (!options.direction.empty()) name += (name.empty() ? "" : " ") + ("--direction " + options.direction);
  return name;
}

Light light_of(const HeuristicOptions& options, const Scene& scene) {
  if (options.light) {
    const std::size_t count = scene.lights.size();
    if (count == 0) refuse("--light: the scene has no lights; give --direction or --point instead");
    if (*options.light >= count) {
      refuse("--light " + std::to_string(*options.light) + ": the scene's lights are 0 to " +
             std::to_string(count - 1) + " (gnomon info says what they are)");
    }
    return scene.lights[*options.light];
  }
  Light own;
  own.kind = options.point.empty() ? LightKind::kDirectional : LightKind::kPoint;
  if (options.point.empty())
    own.direction = to_float(direction_of(options));
  else
    own.position = to_float(vector_of("--point", options.point));
  return own;
}

InfluenceArea area_of(const HeuristicOptions& options, const Scene& scene) {
  if (scene.triangles.empty())
    refuse("the scene has no triangles that rays could meet; leave out --heuristic");
  const auto area = area_of_light(scene, light_of(options, scene));
  if (!area)
    refuse(name_of(options, scene) + " shines at nothing: no triangle of the scene is in front of it");
  if (options.point.empty() || options.direction.empty()) return *area;
  PointView view;
  view.eye = vector_of("--point", options.point);
  view.direction = direction_of(options);
  view.fov_x = fov_of(options)[0];
  view.fov_y = fov_of(options)[1];
  view.far_distance = std::get<Ball>(area->region()).radius;  // the scene's farthest corner
  view.near_distance = kNearShare * view.far_distance;
  return InfluenceArea::point(view);
}

const char* rays_in_words(AreaKind kind) {
  switch (kind) {
    case AreaKind::kPlane:
      return "are parallel: plane and window measure them";
    case AreaKind::kPoint:
      return "come from a point: solid-angle, near-plane and yaw-pitch measure them";
    case AreaKind::kOmni:
      break;
  }
  return "go all ways from a point: solid-angle measures them";
}

GnMeasure measure_for(const HeuristicOptions& options, const Scene& scene) {
  const InfluenceArea area = area_of(options, scene);
  const bool plane = area.kind() == AreaKind::kPlane;
  // Surface area, with the rays for SPFH to go by.
  Heuristic chosen{"sah", plane ? RayMeasure::kParallel : RayMeasure::kSolidAngle, !plane};
  for (const Heuristic& heuristic : kHeuristics) {
    if (options.heuristic == heuristic.name) chosen = heuristic;
  }
  const bool fits = chosen.measure == RayMeasure::kParallel     ? plane
                    : chosen.measure == RayMeasure::kSolidAngle ? !plane
                                                                : area.kind() == AreaKind::kPoint;
  if (!fits) {
    refuse("--heuristic " + options.heuristic + ": the rays of " + name_of(options, scene) + " " +
           rays_in_words(area.kind()));
  }
  return measure_of(area, chosen.measure, chosen.culled);
}

}  // namespace

void add_heuristic_options(CLI::App& command, HeuristicOptions& options) {
  const std::string group = kRaysGroup;
  std::vector<std::string> names{"sah"};
  for (const Heuristic& heuristic : kHeuristics) names.emplace_back(heuristic.name);
  std::vector<std::string> policies;
  for (const AxisPolicy policy : kPolicies) policies.emplace_back(to_string(policy));
  command
      .add_option(
          "--heuristic", options.heuristic,
          "sah, plane, window, solid-angle, near-plane or yaw-pitch (gnomon build --help explains them)")
      ->check(CLI::IsMember(names))
      ->type_name("H")
      ->group(group)
      ->capture_default_str();
  command
      .add_option(
          "--axes", options.axes,
          "all: the cheapest split of three axes; spfh: those the rays cross least first; lsph: long ones "
          "first")
      ->check(CLI::IsMember(policies))
      ->type_name("A")
      ->group(group)
      ->capture_default_str();
  CLI::Option* const light =
      command.add_option("--light", options.light, "the rays of this light of the scene, from 0 on")
          ->check(CLI::NonNegativeNumber)
          ->type_name("N")
          ->group(group);
  command
      .add_option("--direction", options.direction, "parallel rays this way, or where a view looks: x,y,z")
      ->excludes(light)
      ->type_name("V")
      ->group(group);
  command.add_option("--point", options.point, "rays from here: x,y,z")
      ->excludes(light)
      ->type_name("P")
      ->group(group);
  command.add_option("--fov", options.fov, "of a view, in degrees: wide,high; default 60,60")
      ->type_name("W,H")
      ->group(group);
  command
      .add_option("--share", options.share,
                  "of the heuristic, 0 to 1, the rest being surface area; both relative to the scene")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("S")
      ->group(group);
}

void check(const HeuristicOptions& options) {
  const bool surface = options.heuristic == "sah";
  const bool rays = has_rays(options);
  if (surface && options.share)
    refuse("--share mixes sah into another heuristic; choose one with --heuristic");
  if (!surface && !rays) {
    refuse("--heuristic " + options.heuristic + " needs rays: --light N, --direction x,y,z or --point x,y,z");
  }
  if (options.axes == "spfh" && !rays) {
    refuse("--axes spfh needs to know where rays go: --light N, --direction x,y,z or --point x,y,z");
  }
  if (surface && rays && options.axes != "spfh") {
    refuse(
        "sah is for rays from everywhere and heeds none in particular; choose another --heuristic or --axes "
        "spfh");
  }
  if (!options.direction.empty()) static_cast<void>(direction_of(options));
  if (!options.point.empty()) static_cast<void>(vector_of("--point", options.point));
  if (!options.fov.empty()) {
    if (options.point.empty() || options.direction.empty())
      refuse("--fov is of a view: give --point and --direction");
    static_cast<void>(fov_of(options));
  }
}

BuildOptions with_heuristic(BuildOptions build, const HeuristicOptions& options, const Scene& scene) {
  for (const AxisPolicy policy : kPolicies) {
    if (options.axes == to_string(policy)) build.axes = policy;
  }
  if (!has_rays(options)) return build;
  build.measure = measure_for(options, scene);
  if (options.heuristic == "sah") {
    build.policy.rays_from_point = build.measure.kind != GN_MEASURE_LINEAR;
    build.measure.kind = GN_MEASURE_LINEAR;
    for (float& weight : build.measure.weights) weight = 1.0F;
    build.measure.breaks_ties = 0;
  } else if (options.share) {
    build.measure.area_share = static_cast<float>(*options.share);
  }
  build.check();
  return build;
}

std::string describe(const HeuristicOptions& options, const BuildOptions& build, const Scene& scene) {
  std::string text = heuristic_name(build);
  if (has_rays(options)) text += ", rays of " + name_of(options, scene);
  if (options.share) text += ", share " + fixed(*options.share, 3);
  return text;
}

void add_heuristic(Json& document, const HeuristicOptions& options, const Scene& scene) {
  Json& out = document["options"];
  out["axes"] = options.axes;
  out["rays_of"] = has_rays(options) ? Json(name_of(options, scene)) : Json(nullptr);
  out["share"] = options.share ? Json(*options.share) : Json(nullptr);
}

}  // namespace gnomon::app
