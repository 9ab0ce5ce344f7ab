#include "cases.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "gnomon/areas/measure.h"
#include "gnomon/measure/area_measure.h"
#include "gnomon/scene/generators.h"

namespace gnomon::bench {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Box3d box_over(const Scene& scene) {
  Box3d box;
  for (const Triangle& t : scene.triangles) {
    for (const float* v : {t.v0, t.v1, t.v2}) extend(box, {v[0], v[1], v[2]});
  }
  return box;
}

Vec3d place_in(const Box3d& box, const Vec3d& share) {
  Vec3d p{};
  for (std::size_t k = 0; k < 3; ++k) p[k] = box.lo[k] + share[k] * (box.hi[k] - box.lo[k]);
  return p;
}

// Parallel rays over the whole box, or over a window of so large a share of that on both sides.
LightCase sun(const std::string& name, const std::string& words, const Box3d& box, const Vec3d& direction,
              double share = 1.0) {
  const AreaFrame frame = look_along({0.0, 0.0, 0.0}, direction, kWorldUp);
  Box3d local;
  for (unsigned i = 0; i < 8; ++i) extend(local, to_local(frame, corner_of(box, i)));
  const Vec3d size = local.hi - local.lo;
  PlaneWindow window;
  window.point = to_world(frame, {0.5 * (local.lo[0] + local.hi[0]), 0.5 * (local.lo[1] + local.hi[1]),
                                  local.lo[2] - 0.01 * size[2]});
  window.direction = direction;
  window.half_width = 0.505 * share * size[0];
  window.half_height = 0.505 * share * size[1];
  window.depth = 1.02 * size[2];
  return {name, words, InfluenceArea::plane(window), RayMeasure::kParallel};
}

LightCase view(const std::string& name, const std::string& words, const Box3d& box, const Vec3d& eye,
               const Vec3d& target, double fov_x, double fov_y, RayMeasure rays) {
  PointView point;
  point.eye = place_in(box, eye);
  point.direction = place_in(box, target) - point.eye;
  point.fov_x = fov_x * kDegree;
  point.fov_y = fov_y * kDegree;
  const double reach = length(box.hi - box.lo);
  point.near_distance = 1e-3 * reach;
  point.far_distance = 2.0 * reach;
  return {name, words, InfluenceArea::point(point), rays};
}

LightCase lamp(const std::string& name, const std::string& words, const Box3d& box, const Vec3d& place) {
  return {name, words, InfluenceArea::omni(place_in(box, place), length(box.hi - box.lo)),
          RayMeasure::kSolidAngle};
}

const Vec3d kDown{0.0, -1.0, 0.0};
const Vec3d kSlanted{-0.4, -0.8, -0.45};

struct Recipe {
  const char* generator;
  std::uint64_t triangles;
  std::vector<LightCase> (*lights)(const Box3d&);
};

const std::vector<Recipe>& recipes() {
  static const std::vector<Recipe> all{
      {"random", 20000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("random, sun along x", "parallel along (1, 0, 0)", box, {1.0, 0.0, 0.0}),
             sun("random, sun on (1, 1, 1)", "parallel along (1, 1, 1)", box, {1.0, 1.0, 1.0})};
       }},
      {"city", 40000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("city, sun overhead", "parallel along (0, -1, 0)", box, kDown),
             sun("city, slanted sun", "parallel along (-0.4, -0.8, -0.45)", box, kSlanted),
             view("city, wide view", "130 by 90 degrees from a street, even in yaw and pitch", box,
                  {0.5, 0.15, 0.1}, {0.5, 0.12, 0.9}, 130.0, 90.0, RayMeasure::kYawPitch)};
       }},
      {"atrium", 40000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("atrium, sun along x", "parallel along (1, 0, 0)", box, {1.0, 0.0, 0.0}),
             sun("atrium, small window",
                 "parallel along (-0.4, -0.8, -0.45), a window of a third of each side", box, kSlanted,
                 1.0 / 3.0),
             lamp("atrium, lamp", "from a point in the middle, all ways", box, {0.5, 0.4, 0.5}),
             view("atrium, narrow view", "30 by 20 degrees along the hall, even over the picture's plane",
                  box, {0.05, 0.3, 0.5}, {0.95, 0.3, 0.5}, 30.0, 20.0, RayMeasure::kNearPlane)};
       }},
      {"cottage", 12000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("cottage, slanted sun", "parallel along (-0.4, -0.8, -0.45)", box, kSlanted),
             lamp("cottage, lamp", "from a point in a room, all ways", box, {0.45, 0.3, 0.55})};
       }},
      {"terrain", 40000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("terrain, low sun", "parallel along (1, -0.1, 0.2)", box, {1.0, -0.1, 0.2})};
       }},
      {"forest", 40000,
       [](const Box3d& box) {
         return std::vector<LightCase>{
             sun("forest, slanted sun", "parallel along (-0.4, -0.8, -0.45)", box, kSlanted)};
       }},
      {"crowd", 40000, [](const Box3d& box) {
         return std::vector<LightCase>{
             view("crowd, spotlight", "60 by 60 degrees from above, even in steradians", box, {0.2, 3.0, 0.2},
                  {0.5, 0.0, 0.5}, 60.0, 60.0, RayMeasure::kSolidAngle),
             view("crowd, wide view", "130 by 45 degrees from before the crowd, even in yaw and pitch", box,
                  {0.5, 1.0, -0.25}, {0.5, 0.9, 0.5}, 130.0, 45.0, RayMeasure::kYawPitch)};
       }}};
  return all;
}

Method facing_or_longest(const std::string& name, const GnMeasure& measure, AxisPolicy axes, bool repaired,
                         bool from_point) {
  Method method{name, {}};
  method.options.measure = measure;
  method.options.axes = axes;
  method.options.policy.repaired = repaired;
  method.options.policy.rays_from_point = from_point;
  method.options.policy.quality_threshold = axes == AxisPolicy::kSpfh ? 0.4F : 0.99F;
  return method;
}

Method by_measure(const std::string& name, const GnMeasure& measure) {
  Method method{name, {}};
  method.options.measure = measure;
  return method;
}

}  // namespace

std::vector<std::string> case_generators() {
  std::vector<std::string> names;
  for (const Recipe& recipe : recipes()) names.emplace_back(recipe.generator);
  return names;
}

CaseScene make_case(const std::string& generator, std::uint64_t triangles) {
  for (const Recipe& recipe : recipes()) {
    if (generator != recipe.generator) continue;
    Scene scene = generate_scene(generator, triangles == 0 ? recipe.triangles : triangles, kSceneSeed);
    const Box3d box = box_over(scene);
    return {generator, std::move(scene), recipe.lights(box)};
  }
  throw std::runtime_error("no such scene in the failure map: " + generator);
}

GnMeasure own_measure(const LightCase& light) {
  return measure_of(light.area, light.rays, true);
}

std::vector<Method> methods_for(const LightCase& light) {
  const bool point = light.area.kind() != AreaKind::kPlane;
  const GnMeasure own = own_measure(light);
  const GnMeasure surface = framed_surface_measure(light.area);
  std::vector<Method> out{{"SAH", {}}};
  if (light.area.kind() == AreaKind::kPlane) {
    out.push_back(by_measure("PAH plane", measure_of(light.area, RayMeasure::kParallel, false)));
    out.push_back(by_measure("PAH window", own));
  } else {
    out.push_back(by_measure("PAH solid angle", measure_of(light.area, RayMeasure::kSolidAngle, true)));
  }
  if (light.area.kind() == AreaKind::kPoint) {
    out.push_back(by_measure("PAH near plane", measure_of(light.area, RayMeasure::kNearPlane, true)));
    out.push_back(by_measure("PAH yaw-pitch", measure_of(light.area, RayMeasure::kYawPitch, true)));
  }
  Method untied = by_measure("PAH, ties unsettled", own);
  untied.options.measure.breaks_ties = 0;
  out.push_back(untied);
  for (const float share : {0.5F, 0.75F, 0.9F}) {
    Method mixed = by_measure("mixture " + std::string(share == 0.5F    ? "0.5"
                                                       : share == 0.75F ? "0.75"
                                                                        : "0.9"),
                              own);
    mixed.options.measure.area_share = share;
    out.push_back(mixed);
  }
  out.push_back(facing_or_longest("SAH+SPFH published", surface, AxisPolicy::kSpfh, false, point));
  out.push_back(facing_or_longest("SAH+SPFH repaired", surface, AxisPolicy::kSpfh, true, point));
  out.push_back(facing_or_longest("PAH+SPFH published", own, AxisPolicy::kSpfh, false, point));
  out.push_back(facing_or_longest("PAH+SPFH repaired", own, AxisPolicy::kSpfh, true, point));
  out.push_back(facing_or_longest("SAH+LSPH published", surface, AxisPolicy::kLsph, false, point));
  out.push_back(facing_or_longest("SAH+LSPH repaired", surface, AxisPolicy::kLsph, true, point));
  Method fast{"fast builder", {}};
  fast.options.builder = Builder::kFast;
  out.push_back(fast);
  return out;
}

Method method_named(const LightCase& light, const std::string& name) {
  for (const Method& method : methods_for(light)) {
    if (method.name == name) return method;
  }
  throw std::runtime_error("no method " + name + " for " + light.name);
}

}  // namespace gnomon::bench
