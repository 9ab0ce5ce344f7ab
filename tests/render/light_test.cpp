// Lights, sky and where samples lie.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/render/camera_view.h"
#include "gnomon/render/light_rays.h"
#include "gnomon/render/sky.h"

using namespace gnomon;

namespace {

const Point kUp{0.0, 1.0, 0.0};
constexpr Bounds kBounds{{-1.0F, -1.0F, -1.0F}, {1.0F, 1.0F, 1.0F}};

Light light_of(LightKind kind) {
  Light light;
  light.kind = kind;
  light.position = {0.0F, 2.0F, 0.0F};
  light.direction = {0.0F, -1.0F, 0.0F};
  light.color = {8.0F, 4.0F, 2.0F};
  return light;
}

Scene scene_with(const Light& light) {
  Scene scene;
  scene.lights = {light};
  return scene;
}

std::optional<LightSample> sample(const Scene& scene, const Point& position, const Point& normal = kUp) {
  return LightSet(scene, kBounds).sample(0, position, normal, {0.5, 0.5});
}

}  // namespace

TEST_CASE("a point light falls off with the squared distance and the slope") {
  const Scene scene = scene_with(light_of(LightKind::kPoint));
  const auto below = sample(scene, {0.0, 0.0, 0.0});
  REQUIRE(below);
  CHECK(below->distance == Approx(2.0));
  CHECK(below->irradiance.x == Approx(8.0 / 4.0));
  CHECK(below->irradiance.z == Approx(2.0 / 4.0));
  CHECK(sample(scene, {0.0, -2.0, 0.0})->irradiance.x == Approx(8.0 / 16.0));
  CHECK(sample(scene, {0.0, 0.0, 0.0}, {std::sqrt(0.75), 0.5, 0.0})->irradiance.x == Approx(1.0));
  CHECK_FALSE(sample(scene, {0.0, 0.0, 0.0}, -kUp));
  CHECK_FALSE(sample(scene, {0.0, 2.0, 0.0}));  // in the light itself
}

TEST_CASE("a range ends a light, a cone confines a spot, smoothly") {
  Light light = light_of(LightKind::kPoint);
  light.range = 2.5F;
  CHECK(sample(scene_with(light), {0.0, 1.9, 0.0})->irradiance.x == Approx(800.0).epsilon(1e-3));
  CHECK(sample(scene_with(light), {0.0, 0.0, 0.0})->irradiance.x < 8.0 / 4.0);
  CHECK_FALSE(sample(scene_with(light), {0.0, -0.6, 0.0}));

  Light spot = light_of(LightKind::kSpot);
  spot.inner_cone = 0.3F;
  spot.outer_cone = 0.5F;
  const Scene scene = scene_with(spot);
  CHECK(sample(scene, {0.0, 0.0, 0.0})->irradiance.x == Approx(2.0));
  double last = 10.0;
  for (const double angle : {0.29, 0.35, 0.4, 0.45, 0.49}) {
    CAPTURE(angle);
    const auto lit = sample(scene, {2.0 * std::tan(angle), 0.0, 0.0});
    REQUIRE(lit);
    CHECK(lit->irradiance.x < last);
    last = lit->irradiance.x;
  }
  CHECK_FALSE(sample(scene, {2.0 * std::tan(0.51), 0.0, 0.0}));
}

TEST_CASE("the sun is as strong everywhere and has no end") {
  const Scene scene = scene_with(light_of(LightKind::kDirectional));
  const auto lit = sample(scene, {5.0, -7.0, 3.0});
  REQUIRE(lit);
  CHECK(std::isinf(lit->distance));
  CHECK(lit->irradiance.x == Approx(8.0));
  CHECK(lit->direction.y == Approx(1.0));
}

TEST_CASE("an area light's samples have the mean that its solid angle says") {
  // A square of side 2, four above a surface that faces it: two triangles of unequal order.
  Scene scene;
  scene.triangles = {{{-1, 4, -1}, {1, 4, -1}, {1, 4, 1}}, {{-1, 4, -1}, {1, 4, 1}, {-1, 4, 1}}};
  Light light = light_of(LightKind::kArea);
  light.triangles = {0, 1};
  scene.lights = {light};
  const LightSet lights(scene, kBounds);
  double sum = 0.0;
  constexpr std::uint32_t kCount = 4000;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto lit = lights.sample(0, {0.0, 0.0, 0.0}, kUp, sample_point(1, 0, 0, i));
    REQUIRE(lit);
    const Point there = lit->distance * lit->direction;
    CHECK(std::abs(there.x) <= 1.0 + 1e-9);
    CHECK(there.y == Approx(4.0));
    sum += lit->irradiance.x;
  }
  // Form factor of a square above its centre: 4 times the corner's 2 / pi * a / s * atan(a / s), a = 1, s =
  // sqrt(17).
  const double s = std::sqrt(17.0);
  CHECK(sum / kCount == Approx(8.0 * 4.0 / s * std::atan(1.0 / s)).epsilon(5e-3));
}

TEST_CASE("a scene without lights gets a sun, and is told so") {
  const LightSet lights(Scene{}, kBounds);
  CHECK(lights.size() == 1);
  CHECK_FALSE(lights.note().empty());
  CHECK(lights.sky_level() > 0.0);
  CHECK(LightSet(scene_with(light_of(LightKind::kPoint)), kBounds).note().empty());
}

TEST_CASE("many lights drawn at random add up to all of them") {
  Scene scene;
  for (int i = 0; i < 20; ++i) {
    Light light = light_of(LightKind::kPoint);
    light.position = {static_cast<float>(i - 10), 3.0F, 0.0F};
    light.color = {1.0F + static_cast<float>(i), 1.0F, 1.0F};
    scene.lights.push_back(light);
  }
  const LightSet lights(scene, kBounds);
  double expected = 0.0;
  for (std::size_t i = 0; i < lights.size(); ++i)
    expected += lights.sample(i, Point{0.0}, kUp, Point2{0.0})->irradiance.x;
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < 20'000; ++i) places.push_back({Point{0.0}, kUp, Point{M_PI}, 0, i});
  const LightRays rays(lights, 7);
  REQUIRE(rays.rounds() == 8);
  const auto mean_of = [&](const ShadowBatch& batch) {
    double sum = 0.0;
    for (const Pending& light : batch.pending) sum += light.radiance.x;
    return sum / static_cast<double>(places.size());
  };
  double in_rounds = 0.0;
  for (std::uint32_t round = 0; round < rays.rounds(); ++round)
    in_rounds += mean_of(rays.aim_round(places, round));
  CHECK(in_rounds == Approx(expected).epsilon(0.02));
  const ShadowBatch once = rays.aim_once(places);
  CHECK(once.rays.size() == places.size());
  CHECK(mean_of(once) == Approx(expected).epsilon(0.02));
}

TEST_CASE("cosine-weighted directions stay above the surface and favour its normal") {
  const Point normal = glm::normalize(Point{1.0, -2.0, 0.5});
  double sum = 0.0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Point direction = cosine_direction(normal, sample_point(3, 1, 1, i));
    CHECK(glm::length(direction) == Approx(1.0));
    CHECK(glm::dot(direction, normal) >= -1e-12);
    sum += glm::dot(direction, normal);
  }
  CHECK(sum / 2000 == Approx(2.0 / 3.0).epsilon(5e-3));
}

TEST_CASE("a camera looks forward through the middle and keeps its vertical angle in pictures of any shape") {
  Camera camera;
  camera.position = {1.0F, 2.0F, 3.0F};
  camera.fov_y = 1.0F;
  for (const std::uint32_t width : {100U, 300U}) {
    CAPTURE(width);
    const CameraView view(camera, width, 200);
    const Ray middle = view.ray(0.5 * width, 100.0);
    CHECK(middle.direction[2] == Approx(-1.0F));
    CHECK(middle.origin[1] == 2.0F);
    const Ray top = view.ray(0.5 * width, 0.0);
    CHECK(std::atan2(top.direction[1], -top.direction[2]) == Approx(0.5F));
    CHECK(view.ray(width, 100.0).direction[0] > 0.0F);
  }
}

TEST_CASE("the sky is bluest at the zenith and has no seam at the horizon") {
  const Sky sky(2.0);
  const Point zenith = sky.radiance({0.0, 1.0, 0.0});
  const Point horizon = sky.radiance({1.0, 0.0, 0.0});
  CHECK(zenith.z / zenith.x > horizon.z / horizon.x);
  CHECK(glm::length(sky.radiance({1.0, -1e-9, 0.0}) - horizon) < 1e-6);
  CHECK(glm::length(Sky(4.0).radiance(kUp) - 2.0 * zenith) < 1e-12);
}
