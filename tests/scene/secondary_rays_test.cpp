// Bounce and shadow rays.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::generate_scene;
using gnomon::Light;
using gnomon::LightKind;
using gnomon::Ray;
using gnomon::Scene;

namespace {

Light light_at(LightKind kind, const gnomon::Vec3& position) {
  Light light;
  light.kind = kind;
  light.position = position;
  light.direction = {0.0F, -1.0F, 0.0F};
  return light;
}

}  // namespace

TEST_CASE("every kind of ray repeats with its seed and changes with another") {
  Scene scene = generate_scene("atrium", 16'000, 1);
  const auto primary = gnomon::primary_rays(scene, 60, 1);
  const auto hits = nearest_hits(scene, primary);
  const auto all = [&](std::uint64_t seed) {
    return std::vector<std::vector<Ray>>{
        gnomon::primary_rays(scene, 60, seed), gnomon::random_rays(scene, 60, seed),
        gnomon::parallel_rays(scene, 60, seed), gnomon::bounce_rays(scene, primary, hits, 60, seed),
        gnomon::shadow_rays(scene, primary, hits, 60, seed)};
  };
  const auto first = all(3);
  const auto again = all(3);
  const auto other = all(4);
  for (std::size_t kind = 0; kind < first.size(); ++kind) {
    CAPTURE(kind);
    REQUIRE_FALSE(first[kind].empty());
    REQUIRE(same_rays(first[kind], again[kind]));
    REQUIRE_FALSE(same_rays(first[kind], other[kind]));
  }
}

TEST_CASE("bounce rays leave the surface on the side the primary ray came from") {
  const Scene scene = generate_scene("random", 2000, 1);
  const auto primary = gnomon::random_rays(scene, 600, 3);
  const auto hits = nearest_hits(scene, primary);
  const auto rays = gnomon::bounce_rays(scene, primary, hits, 600, 1);
  const gnomon::Bounds bounds = gnomon::bounds_of(scene);
  const double offset = 1e-5 * glm::length(to_point(bounds.hi) - to_point(bounds.lo));
  std::size_t next = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive == GN_NONE) continue;
    CAPTURE(i, next);
    REQUIRE(next < rays.size());
    const gnomon::Triangle& triangle = scene.triangles[hits[i].primitive];
    Point normal = glm::normalize(area_vector(triangle));
    if (glm::dot(normal, to_point(primary[i].direction)) > 0.0) normal = -normal;
    REQUIRE(glm::dot(normal, to_point(rays[next].direction)) > -1e-6);
    const double height = glm::dot(normal, to_point(rays[next].origin) - to_point(triangle.v0));
    REQUIRE(height == Approx(offset).margin(3e-6));
    ++next;
  }
  CHECK(next == rays.size());
  CHECK(next > 50);
}

TEST_CASE("bounce rays are weighted by the cosine") {
  const Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 20'000, 3);
  double mean = 0.0;
  const auto rays = gnomon::bounce_rays(scene, primary, nearest_hits(scene, primary), 20'000, 1);
  for (const Ray& ray : rays)
    mean += static_cast<double>(ray.direction[1]) / static_cast<double>(rays.size());
  CHECK(rays.size() == 20'000);
  CHECK(mean == Approx(2.0 / 3.0).margin(0.006));
}

TEST_CASE("secondary rays are at most as many as asked for, spread over all hits, none for misses") {
  const Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 400, 3);
  auto hits = nearest_hits(scene, primary);
  const auto thinned = gnomon::bounce_rays(scene, primary, hits, 7, 1);
  CHECK(thinned.size() == 7);
  CHECK(same_rays({thinned.begin(), thinned.begin() + 1},
                  gnomon::bounce_rays(scene, {primary.data(), 1}, {hits.data(), 1}, 9, 1)));
  for (std::size_t i = 0; i < hits.size(); i += 2) hits[i] = {kInfinity, 0.0F, 0.0F, GN_NONE};
  CHECK(gnomon::bounce_rays(scene, primary, hits, 400, 1).size() == 200);
  CHECK(gnomon::shadow_rays(scene, primary, hits, 400, 1).size() == 200);
}

TEST_CASE("hits that do not go with the rays or the scene are refused") {
  const Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 4, 3);
  auto hits = nearest_hits(scene, primary);
  CHECK_THROWS_AS(gnomon::bounce_rays(scene, primary, {hits.data(), 3}, 4, 1), gnomon::Error);
  hits[2].primitive = 2;
  CHECK_THROWS_WITH(gnomon::shadow_rays(scene, primary, hits, 4, 1), Catch::Contains("hit 2"));
}

TEST_CASE("shadow rays end just before a point light and never for the sun") {
  Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 100, 3);
  const auto hits = nearest_hits(scene, primary);
  scene.lights = {light_at(LightKind::kPoint, {1.0F, 3.0F, 0.0F})};
  for (const Ray& ray : gnomon::shadow_rays(scene, primary, hits, 100, 1)) {
    const Point to = Point{1.0, 3.0, 0.0} - to_point(ray.origin);
    REQUIRE(glm::length(glm::normalize(to) - to_point(ray.direction)) < 1e-6);
    REQUIRE(ray.tmax == Approx(0.9999 * glm::length(to)).epsilon(1e-6));
  }
  scene.lights = {light_at(LightKind::kDirectional, {})};
  for (const Ray& ray : gnomon::shadow_rays(scene, primary, hits, 100, 1)) {
    REQUIRE((ray.direction[1] == 1.0F && ray.tmax == kInfinity));
  }
}

TEST_CASE("a scene without lights is lit by the default sun") {
  const Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 10, 3);
  const auto rays = gnomon::shadow_rays(scene, primary, nearest_hits(scene, primary), 10, 1);
  REQUIRE(rays.size() == 10);
  for (const Ray& ray : rays) {
    REQUIRE(glm::length(to_point(ray.direction) - glm::normalize(Point{0.4, 0.8, 0.45})) < 1e-6);
  }
}

TEST_CASE("shadow rays to an area light spread over its triangles by area") {
  Scene scene = floor_scene();
  scene.triangles.push_back({{0, 3, 0}, {0, 3, 1}, {3, 3, 0}});
  scene.triangles.push_back({{-1, 3, 0}, {-1, 3, 1}, {0, 3, 0}});
  scene.material_ids = {0, 0, 0, 0};
  Light light = light_at(LightKind::kArea, {0.5F, 3.0F, 0.4F});
  light.triangles = {2, 3};
  scene.lights = {light};
  const auto primary = gnomon::primary_rays(scene, 4000, 3);
  const auto rays = gnomon::shadow_rays(scene, primary, nearest_hits(floor_scene(), primary), 4000, 1);
  REQUIRE(rays.size() == 4000);
  double on_larger = 0.0;
  for (const Ray& ray : rays) {
    const Point end = to_point(ray.origin) + static_cast<double>(ray.tmax) / 0.9999 * to_point(ray.direction);
    REQUIRE(end.y == Approx(3.0).epsilon(1e-5));
    REQUIRE((end.x > -1.001 && end.x < 3.001 && end.z > -0.001 && end.z < 1.001));
    on_larger += end.x > 0.0 ? 1.0 / 4000.0 : 0.0;
  }
  CHECK(on_larger == Approx(0.75).margin(0.03));
}

TEST_CASE("no shadow ray goes to a light that cannot reach the place") {
  Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 100, 3);
  const auto hits = nearest_hits(scene, primary);
  Light below = light_at(LightKind::kPoint, {0.0F, -1.0F, 0.0F});
  Light near = light_at(LightKind::kPoint, {0.0F, 3.0F, 0.0F});
  near.range = 1.0F;
  Light narrow = light_at(LightKind::kSpot, {0.0F, 3.0F, 0.0F});
  narrow.outer_cone = 0.1F;
  for (const Light& light : {below, near}) {
    scene.lights = {light};
    REQUIRE(gnomon::shadow_rays(scene, primary, hits, 100, 1).empty());
  }
  scene.lights = {narrow};
  const auto rays = gnomon::shadow_rays(scene, primary, hits, 100, 1);
  CHECK((!rays.empty() && rays.size() < 50));
  for (const Ray& ray : rays) CHECK(ray.direction[1] > std::cos(0.1F) - 1e-6F);
  scene.lights = {below, near, light_at(LightKind::kPoint, {0.0F, 5.0F, 0.0F})};
  CHECK(gnomon::shadow_rays(scene, primary, hits, 100, 1).size() == 100);
}

TEST_CASE("lights share the shadow rays") {
  Scene scene = floor_scene();
  for (const float x : {-1.0F, 0.0F, 1.0F})
    scene.lights.push_back(light_at(LightKind::kPoint, {x, 50.0F, 0.0F}));
  const auto primary = gnomon::primary_rays(scene, 900, 3);
  std::vector<unsigned> rays_of(3);
  for (const Ray& ray : gnomon::shadow_rays(scene, primary, nearest_hits(scene, primary), 900, 1)) {
    const Point end = to_point(ray.origin) + static_cast<double>(ray.tmax) * to_point(ray.direction);
    ++rays_of[static_cast<std::size_t>(std::lround(end.x) + 1)];
  }
  for (const unsigned count : rays_of) CHECK((count > 240 && count < 360));
}
