#include "gnomon/render/light_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr double kFairWay = 0.3;    // of the bounds' diagonal
constexpr double kSkyShare = 0.16;  // sky radiance, as a share of the lights' irradiance

double squared(double x) {
  return x * x;
}

// KHR_lights_punctual's recommended window on the inverse square.
double falloff(const Light& light, double distance) {
  const double inverse_square = 1.0 / std::max(squared(distance), 1e-20);
  if (light.range <= 0.0F) return inverse_square;
  return inverse_square *
         std::clamp(1.0 - squared(squared(distance / static_cast<double>(light.range))), 0.0, 1.0);
}

// And its smooth edge of a spot's cone.
double cone_share(const Light& light, const Point& from_light) {
  if (light.kind != LightKind::kSpot) return 1.0;
  const double cos_outer = cos_turns(static_cast<double>(light.outer_cone) / (2.0 * kPi));
  const double cos_inner = cos_turns(static_cast<double>(light.inner_cone) / (2.0 * kPi));
  const double cos_angle = glm::dot(from_light, glm::normalize(to_point(light.direction)));
  return squared(std::clamp((cos_angle - cos_outer) / std::max(1e-3, cos_inner - cos_outer), 0.0, 1.0));
}

Point doubled_area_normal(const Triangle& t) {
  return glm::cross(to_point(t.v1) - to_point(t.v0), to_point(t.v2) - to_point(t.v0));
}

}  // namespace

Light default_sun() {
  Light sun;
  sun.name = "default sun";
  sun.kind = LightKind::kDirectional;
  sun.direction = {-0.4F, -0.8F, -0.45F};
  sun.color = {3.0F, 2.85F, 2.6F};
  return sun;
}

LightSet::LightSet(const Scene& scene, const Bounds& bounds) : triangles_(scene.triangles) {
  const double diagonal =
      scene.triangles.empty() ? 1.0 : glm::length(to_point(bounds.hi) - to_point(bounds.lo));
  reach_ = kFairWay * std::max(diagonal, 1e-20);
  for (const Light& light : scene.lights) {
    Emitter emitter{light, {}};
    double area = 0.0;
    for (const std::uint32_t index : light.triangles) {
      area += 0.5 * glm::length(doubled_area_normal(triangles_[index]));
      emitter.running_areas.push_back(area);
    }
    if (light.kind != LightKind::kArea || area > 0.0) emitters_.push_back(std::move(emitter));
  }
  if (emitters_.empty()) {
    emitters_.push_back({default_sun(), {}});
    note_ = "the scene has no lights: a default sun and sky light it";
  }
}

// Irradiance of one light on a surface that faces it, a fair way off.
double LightSet::level_of(const Emitter& emitter) const {
  const double strength = luminance(to_point(emitter.light.color));
  if (emitter.light.kind == LightKind::kDirectional) return strength;
  const double size = emitter.light.kind == LightKind::kArea ? emitter.running_areas.back() : 1.0;
  return strength * size / squared(reach_);
}

double LightSet::sky_level() const {
  double sum = 0.0;
  for (const Emitter& emitter : emitters_) sum += level_of(emitter);
  return kSkyShare * sum;
}

Point LightSet::point_on(const Emitter& emitter, const Point2& sample, Point& normal) const {
  const auto& areas = emitter.running_areas;
  const double wanted = sample.x * areas.back();
  const auto chosen = std::upper_bound(areas.begin(), areas.end() - 1, wanted);
  const double before = chosen == areas.begin() ? 0.0 : *(chosen - 1);
  const Triangle& t = triangles_[emitter.light.triangles[static_cast<std::size_t>(chosen - areas.begin())]];
  // What is left of the first number within the chosen triangle is again uniform.
  const double rest = *chosen > before ? std::clamp((wanted - before) / (*chosen - before), 0.0, 1.0) : 0.5;
  const double root = std::sqrt(rest);
  const double b1 = root * (1.0 - sample.y);
  normal = glm::normalize(doubled_area_normal(t));
  return (1.0 - root) * to_point(t.v0) + b1 * to_point(t.v1) + (root - b1) * to_point(t.v2);
}

std::optional<LightSample> LightSet::sample(std::size_t light_index, const Point& position,
                                            const Point& normal, const Point2& sample) const {
  const Emitter& emitter = emitters_[light_index];
  const Light& light = emitter.light;
  const Point color = to_point(light.color);
  if (light.kind == LightKind::kDirectional) {
    const Point direction = -glm::normalize(to_point(light.direction));
    const double slope = glm::dot(direction, normal);
    if (!(slope > 0.0)) return std::nullopt;
    return LightSample{direction, std::numeric_limits<double>::infinity(), slope * color};
  }
  Point light_normal{0.0};
  const bool is_area = light.kind == LightKind::kArea;
  const Point offset =
      (is_area ? point_on(emitter, sample, light_normal) : to_point(light.position)) - position;
  const double distance = glm::length(offset);
  const Point direction = offset / distance;
  const double slope = glm::dot(direction, normal);
  if (!(slope > 0.0)) return std::nullopt;  // also where the distance is 0
  const double share = is_area ? emitter.running_areas.back() * std::abs(glm::dot(direction, light_normal)) /
                                     std::max(squared(distance), 1e-4 * emitter.running_areas.back())
                               : falloff(light, distance) * cone_share(light, -direction);
  if (!(share > 0.0)) return std::nullopt;
  return LightSample{direction, distance, share * slope * color};
}

}  // namespace gnomon
