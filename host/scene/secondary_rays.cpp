// Rays that start where primary ones hit: bounces and shadow rays.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

using Point = glm::dvec3;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kOffset = 1e-5;         // of the bounds' diagonal
constexpr double kShadowReach = 0.9999;  // of the distance to the light: its own surface is not an occluder

Point to_point(const float* v) {
  return {v[0], v[1], v[2]};
}
Point to_point(const Vec3& v) {
  return to_point(v.data());
}

Ray make_ray(const Point& origin, const Point& direction, float tmax) {
  Ray ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(origin[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  ray.tmax = tmax;
  return ray;
}

// A point on a surface, moved off it to the side the ray came from, and the unit normal on that side.
struct Place {
  Point position;
  Point normal;
};

double offset_of(const Scene& scene) {
  if (scene.triangles.empty()) return 0.0;
  const Bounds bounds = bounds_of(scene);
  return kOffset * glm::length(to_point(bounds.hi) - to_point(bounds.lo));
}

Place place_of(const Triangle& triangle, const Ray& ray, const Hit& hit, double offset) {
  const Point v0 = to_point(triangle.v0);
  const Point e1 = to_point(triangle.v1) - v0;
  const Point e2 = to_point(triangle.v2) - v0;
  Point normal = glm::normalize(glm::cross(e1, e2));
  if (glm::dot(normal, to_point(ray.direction)) > 0.0) normal = -normal;
  return {v0 + static_cast<double>(hit.u) * e1 + static_cast<double>(hit.v) * e2 + offset * normal, normal};
}

// Indices of the rays that hit, thinned evenly to at most `count`.
std::vector<std::uint64_t> chosen_hits(const Scene& scene, std::span<const Ray> primary,
                                       std::span<const Hit> hits, std::uint64_t count) {
  if (primary.size() != hits.size()) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(primary.size()) + " rays do not go with " +
                                                 std::to_string(hits.size()) + " hits");
  }
  std::vector<std::uint64_t> found;
  for (std::uint64_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive == GN_NONE) continue;
    if (hits[i].primitive >= scene.triangles.size()) {
      throw Error(ErrorCode::kInvalidArgument, "hit " + std::to_string(i) + " names triangle " +
                                                   std::to_string(hits[i].primitive) + " of " +
                                                   std::to_string(scene.triangles.size()));
    }
    found.push_back(i);
  }
  if (found.size() <= count) return found;
  std::vector<std::uint64_t> thinned(count);
  const double step = static_cast<double>(found.size()) / static_cast<double>(count);
  for (std::uint64_t k = 0; k < count; ++k)
    thinned[k] = found[static_cast<std::uint64_t>(static_cast<double>(k) * step)];
  return thinned;
}

// Cosine-weighted about the normal: a uniform point of the unit disc, raised to the hemisphere (Malley).
Point cosine_direction(const Point& normal, SteadyRandom& random) {
  const Point other = std::abs(normal.y) < 0.9 ? Point{0.0, 1.0, 0.0} : Point{1.0, 0.0, 0.0};
  const Point x = glm::normalize(glm::cross(other, normal));
  const Point z = glm::cross(x, normal);
  const double squared = random.unit();
  const double turns = random.unit();
  const double radius = std::sqrt(squared);
  return radius * cos_turns(turns) * x + radius * sin_turns(turns) * z + std::sqrt(1.0 - squared) * normal;
}

// An area light's triangles with their running areas, so that a point on it can be drawn evenly.
struct Emitter {
  const Light* light;
  std::vector<double> running_areas;
};

std::vector<Emitter> emitters_of(const Scene& scene, const Light& default_sun) {
  std::vector<Emitter> emitters;
  for (const Light& light : scene.lights) {
    Emitter emitter{&light, {}};
    double area = 0.0;
    for (const std::uint32_t index : light.triangles) {
      const Triangle& t = scene.triangles.at(index);
      const Point v0 = to_point(t.v0);
      area += glm::length(glm::cross(to_point(t.v1) - v0, to_point(t.v2) - v0));
      emitter.running_areas.push_back(area);
    }
    if (light.kind != LightKind::kArea || area > 0.0) emitters.push_back(std::move(emitter));
  }
  if (emitters.empty()) emitters.push_back({&default_sun, {}});
  return emitters;
}

Point point_on(const Scene& scene, const Emitter& emitter, SteadyRandom& random) {
  const auto& areas = emitter.running_areas;
  const auto chosen = std::upper_bound(areas.begin(), areas.end() - 1, random.unit() * areas.back());
  const Triangle& t =
      scene.triangles[emitter.light->triangles[static_cast<std::size_t>(chosen - areas.begin())]];
  const double root = std::sqrt(random.unit());
  const double b1 = root * (1.0 - random.unit());
  const double b0 = 1.0 - root;
  return b0 * to_point(t.v0) + b1 * to_point(t.v1) + (1.0 - b0 - b1) * to_point(t.v2);
}

// The shadow ray from a place to a light, or nothing where that light cannot reach: behind the surface, out
// of range or outside the cone.
std::optional<Ray> shadow_ray(const Scene& scene, const Emitter& emitter, const Place& place,
                              SteadyRandom& random) {
  const Light& light = *emitter.light;
  if (light.kind == LightKind::kDirectional) {
    const Point direction = -glm::normalize(to_point(light.direction));
    if (glm::dot(direction, place.normal) <= 0.0) return std::nullopt;
    return make_ray(place.position, direction, kInfinity);
  }
  const Point target =
      light.kind == LightKind::kArea ? point_on(scene, emitter, random) : to_point(light.position);
  const double distance = glm::length(target - place.position);
  const Point direction = (target - place.position) / distance;
  if (!(glm::dot(direction, place.normal) > 0.0)) return std::nullopt;  // also where the distance is 0
  if (light.kind != LightKind::kArea && light.range > 0.0F && distance > light.range) return std::nullopt;
  if (light.kind == LightKind::kSpot) {
    const double turns = static_cast<double>(light.outer_cone) / (2.0 * kPi);
    if (-glm::dot(direction, glm::normalize(to_point(light.direction))) < cos_turns(turns))
      return std::nullopt;
  }
  return make_ray(place.position, direction, static_cast<float>(kShadowReach * distance));
}

}  // namespace

std::vector<Ray> bounce_rays(const Scene& scene, std::span<const Ray> primary, std::span<const Hit> hits,
                             std::uint64_t count, std::uint64_t seed) {
  const double offset = offset_of(scene);
  std::vector<Ray> rays;
  for (const std::uint64_t i : chosen_hits(scene, primary, hits, count)) {
    SteadyRandom random(seed, i);
    const Place place = place_of(scene.triangles[hits[i].primitive], primary[i], hits[i], offset);
    rays.push_back(make_ray(place.position, cosine_direction(place.normal, random), kInfinity));
  }
  return rays;
}

std::vector<Ray> shadow_rays(const Scene& scene, std::span<const Ray> primary, std::span<const Hit> hits,
                             std::uint64_t count, std::uint64_t seed) {
  Light default_sun;
  default_sun.kind = LightKind::kDirectional;
  default_sun.direction = {-0.4F, -0.8F, -0.45F};
  const std::vector<Emitter> emitters = emitters_of(scene, default_sun);
  const double offset = offset_of(scene);
  std::vector<Ray> rays;
  for (const std::uint64_t i : chosen_hits(scene, primary, hits, count)) {
    SteadyRandom random(seed, i);
    const Place place = place_of(scene.triangles[hits[i].primitive], primary[i], hits[i], offset);
    const unsigned first = random.below(static_cast<unsigned>(emitters.size()));
    for (std::size_t k = 0; k < emitters.size(); ++k) {
      const auto ray = shadow_ray(scene, emitters[(first + k) % emitters.size()], place, random);
      if (!ray) continue;
      rays.push_back(*ray);
      break;
    }
  }
  return rays;
}

}  // namespace gnomon
