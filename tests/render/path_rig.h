// Small scenes with known light, and what a path tracer on the device makes of them. Feeds the path tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gnomon/render/path_tracer.h"
#include "support/device.h"
#include "support/shapes.h"

namespace gnomon::test {

using Corner = std::array<float, 3>;

// Scenes put together piece by piece; the camera has to be set.
class PathSceneBuilder {
 public:
  PathSceneBuilder() { scene_.cameras.emplace_back(); }

  std::uint32_t material(Vec3 color, float roughness = 1.0F, float metallic = 0.0F, Vec3 emission = {}) {
    Material made;
    made.base_color = color;
    made.roughness = roughness;
    made.metallic = metallic;
    made.emission = emission;
    scene_.materials.push_back(made);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }
  void triangle(std::uint32_t material, Corner a, Corner b, Corner c) {
    scene_.triangles.push_back(test::triangle(a, b, c));
    scene_.material_ids.push_back(material);
  }
  void quad(std::uint32_t material, Corner a, Corner b, Corner c, Corner d) {
    triangle(material, a, b, c);
    triangle(material, a, c, d);
  }
  // A quad that is an area light.
  void lamp(Vec3 radiance, Corner a, Corner b, Corner c, Corner d) {
    const auto first = static_cast<std::uint32_t>(scene_.triangles.size());
    quad(material({0.0F, 0.0F, 0.0F}, 1.0F, 0.0F, radiance), a, b, c, d);
    Light light;
    light.name = "lamp";
    light.kind = LightKind::kArea;
    light.color = radiance;
    light.triangles = {first, first + 1};
    for (std::size_t k = 0; k < 3; ++k) light.position[k] = 0.5F * (a[k] + c[k]);
    scene_.lights.push_back(light);
  }
  void light(const Light& light) { scene_.lights.push_back(light); }
  void look(Vec3 from, Vec3 at, float fov_y) {
    Camera& camera = scene_.cameras.front();
    camera.position = from;
    std::array<double, 3> forward{};
    double length = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      forward[k] = static_cast<double>(at[k]) - static_cast<double>(from[k]);
      length += forward[k] * forward[k];
    }
    for (double& x : forward) x /= std::sqrt(length);
    // Up is y, or z where the camera looks along y.
    const bool steep = std::abs(forward[1]) > 0.99;
    const std::array<double, 3> up = steep ? std::array{0.0, 0.0, 1.0} : std::array{0.0, 1.0, 0.0};
    double along = 0.0;
    for (std::size_t k = 0; k < 3; ++k) along += up[k] * forward[k];
    std::array<double, 3> across{};
    double rest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      across[k] = up[k] - along * forward[k];
      rest += across[k] * across[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      camera.forward[k] = static_cast<float>(forward[k]);
      camera.up[k] = static_cast<float>(across[k] / std::sqrt(rest));
    }
    camera.fov_y = fov_y;
  }
  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
};

inline Light point_light(Vec3 position, Vec3 intensity) {
  Light light;
  light.kind = LightKind::kPoint;
  light.position = position;
  light.color = intensity;
  return light;
}
inline Light sun_light(Vec3 travels, Vec3 irradiance) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = travels;
  light.color = irradiance;
  return light;
}
inline Light spot_light(Vec3 position, Vec3 axis, Vec3 intensity, float inner, float outer) {
  Light light = point_light(position, intensity);
  light.kind = LightKind::kSpot;
  light.direction = axis;
  light.inner_cone = inner;
  light.outer_cone = outer;
  return light;
}

// A tree and a tracer for a scene, so that several path tracers can share them.
struct TracedScene {
  explicit TracedScene(const Scene& shown, const TraceOptions& options = {})
      : scene(shown), tree(build_device(context(), scene.triangles)), tracer(context(), tree, options) {}
  Scene scene;
  DeviceBvh tree;
  Tracer tracer;

  [[nodiscard]] Picture picture(const PathOptions& options, std::uint32_t samples) const {
    PathTracer paths(context(), tracer, scene, options);
    paths.add_samples(samples);
    return paths.picture();
  }
};

// A mean with its error bar.
struct Estimate {
  double mean = 0.0;
  double error = 0.0;  // one standard deviation of the mean
};

inline Estimate estimate_of(const std::vector<double>& values) {
  Estimate out;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) out.mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - out.mean) * (value - out.mean);
  out.error = std::sqrt(squares / (n - 1.0) / n);
  return out;
}

// Over a picture's pixels, which are independent of each other.
inline Estimate mean_of(const Picture& picture, std::size_t channel = 0) {
  std::vector<double> values;
  for (const Vec3& pixel : picture.pixels) values.push_back(pixel[channel]);
  return estimate_of(values);
}

}  // namespace gnomon::test
