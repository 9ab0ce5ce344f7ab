#include "gnomon/scene/ray_set.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::generate_scene;
using gnomon::Hit;
using gnomon::Light;
using gnomon::LightKind;
using gnomon::Ray;
using gnomon::RayKind;
using gnomon::Scene;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool same_rays(const std::vector<Ray>& a, const std::vector<Ray>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Ray)) == 0;
}

// A square floor of side 4 at y = 0 under a camera at height 2 that looks straight down.
Scene floor_scene() {
  Scene scene;
  scene.materials.resize(1);
  scene.triangles = {{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, {{-2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}};
  scene.material_ids = {0, 0};
  gnomon::Camera camera;
  camera.position = {0.0F, 2.0F, 0.0F};
  camera.forward = {0.0F, -1.0F, 0.0F};
  camera.up = {0.0F, 0.0F, -1.0F};
  camera.fov_y = 1.2F;
  scene.cameras = {camera};
  return scene;
}

Light light_at(LightKind kind, const gnomon::Vec3& position) {
  Light light;
  light.kind = kind;
  light.position = position;
  light.direction = {0.0F, -1.0F, 0.0F};
  return light;
}

// Column and row of a primary ray in a picture of n by n pixels, and the place within the pixel.
struct Pixel {
  std::uint64_t x, y;
};
Pixel pixel_of(const gnomon::Camera& camera, const Ray& ray, double n) {
  const Point forward = to_point(camera.forward);
  const Point up = to_point(camera.up);
  const Point d = to_point(ray.direction) / glm::dot(to_point(ray.direction), forward);
  const double half = std::tan(static_cast<double>(camera.fov_y) / 2.0);
  const double u = 0.5 * (glm::dot(d, glm::cross(forward, up)) / half + 1.0);
  const double v = 0.5 * (1.0 - glm::dot(d, up) / half);
  REQUIRE((u >= 0.0 && u < 1.0 && v >= 0.0 && v < 1.0));
  return {static_cast<std::uint64_t>(u * n), static_cast<std::uint64_t>(v * n)};
}

std::uint64_t morton(const Pixel& pixel) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < 16; ++bit) {
    code |= ((pixel.x >> bit) & 1U) << (2 * bit) | ((pixel.y >> bit) & 1U) << (2 * bit + 1);
  }
  return code;
}

}  // namespace

TEST_CASE("names of ray kinds come back as the kinds") {
  for (const RayKind kind : {RayKind::kPrimary, RayKind::kBounce, RayKind::kShadow, RayKind::kRandom, RayKind::kParallel}) {
    CHECK(gnomon::ray_kind_from(gnomon::to_string(kind)) == kind);
    CHECK(gnomon::asks_any_hit(kind) == (kind == RayKind::kShadow || kind == RayKind::kParallel));
  }
  CHECK(gnomon::to_string(RayKind::kShadow) == "shadow");
  CHECK_FALSE(gnomon::ray_kind_from("Primary"));
  CHECK_FALSE(gnomon::ray_kind_from(""));
}

TEST_CASE("primary rays visit each pixel once, in Morton order") {
  const Scene scene = floor_scene();
  const auto rays = gnomon::primary_rays(scene, 64 * 64, 7);
  REQUIRE(rays.size() == 64 * 64);
  for (std::uint64_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(morton(pixel_of(scene.cameras[0], rays[i], 64.0)) == i);
  }
}

TEST_CASE("batches have exactly the count asked for, of unit rays without limits") {
  Scene scene = floor_scene();
  for (const float aspect : {0.0F, 1.0F, 1.7777778F, 0.3F, 200.0F}) {
    scene.cameras[0].aspect = aspect;
    for (const std::uint64_t count : {0ULL, 1ULL, 2ULL, 3ULL, 17ULL, 1000ULL, 4095ULL, 4097ULL}) {
      CAPTURE(aspect, count);
      for (const auto& rays : {gnomon::primary_rays(scene, count, 1), gnomon::random_rays(scene, count, 1),
                               gnomon::parallel_rays(scene, count, 1)}) {
        REQUIRE(rays.size() == count);
        for (const Ray& ray : rays) {
          REQUIRE(glm::length(to_point(ray.direction)) == Approx(1.0).epsilon(1e-6));
          REQUIRE((ray.tmin == 0.0F && ray.tmax == kInfinity));
        }
      }
    }
  }
}

TEST_CASE("every kind of ray repeats with its seed and changes with another") {
  Scene scene = generate_scene("atrium", 16'000, 1);
  const auto primary = gnomon::primary_rays(scene, 60, 1);
  const auto hits = nearest_hits(scene, primary);
  const auto all = [&](std::uint64_t seed) {
    return std::vector<std::vector<Ray>>{gnomon::primary_rays(scene, 60, seed), gnomon::random_rays(scene, 60, seed),
                                         gnomon::parallel_rays(scene, 60, seed),
                                         gnomon::bounce_rays(scene, primary, hits, 60, seed),
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

TEST_CASE("the default camera has the whole scene in view") {
  Scene scene = generate_scene("random100", 100, 1);
  scene.cameras = {gnomon::default_camera(scene)};
  for (const gnomon::Triangle& triangle : scene.triangles) {
    for (const float* corner : {triangle.v0, triangle.v1, triangle.v2}) {
      Ray ray{};
      const Point to = to_point(corner) - to_point(scene.cameras[0].position);
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = static_cast<float>(to[axis]);
      REQUIRE(glm::dot(to, to_point(scene.cameras[0].forward)) > 0.0);
      static_cast<void>(pixel_of(scene.cameras[0], ray, 1.0));
    }
  }
}

TEST_CASE("an empty scene still has rays, all of them finite") {
  const Scene scene;
  for (const auto& rays : {gnomon::primary_rays(scene, 9, 1), gnomon::random_rays(scene, 9, 1), gnomon::parallel_rays(scene, 9, 1)}) {
    REQUIRE(rays.size() == 9);
    for (const Ray& ray : rays) {
      for (unsigned k = 0; k < 3; ++k) REQUIRE((std::isfinite(ray.origin[k]) && std::isfinite(ray.direction[k])));
    }
  }
}

TEST_CASE("random rays start inside the bounds and go every way alike") {
  const Scene scene = generate_scene("random1000", 1000, 1);
  const gnomon::Bounds bounds = gnomon::bounds_of(scene);
  Point mean{0.0};
  Point squares{0.0};
  constexpr std::uint64_t kCount = 40'000;
  for (const Ray& ray : gnomon::random_rays(scene, kCount, 2)) {
    for (unsigned k = 0; k < 3; ++k) REQUIRE((ray.origin[k] >= bounds.lo[k] && ray.origin[k] <= bounds.hi[k]));
    mean += to_point(ray.direction) / static_cast<double>(kCount);
    squares += to_point(ray.direction) * to_point(ray.direction) / static_cast<double>(kCount);
  }
  CHECK(glm::length(mean) < 0.015);
  CHECK(glm::length(squares - Point{1.0 / 3.0}) < 0.01);
}

TEST_CASE("parallel rays travel with the sun, start outside and cover the scene") {
  Scene scene = generate_scene("random100", 100, 1);
  const Point sun = to_point(scene.lights[0].direction);
  const Point side = glm::normalize(glm::cross(sun, Point{0.0, 1.0, 0.0}));
  const auto rays = gnomon::parallel_rays(scene, 5000, 1);
  double scene_lo = 1e30;
  double scene_hi = -1e30;
  double front = 1e30;
  for (const gnomon::Triangle& t : scene.triangles) {
    for (const float* corner : {t.v0, t.v1, t.v2}) {
      scene_lo = std::min(scene_lo, glm::dot(to_point(corner), side));
      scene_hi = std::max(scene_hi, glm::dot(to_point(corner), side));
      front = std::min(front, glm::dot(to_point(corner), sun));
    }
  }
  double rays_lo = 1e30;
  double rays_hi = -1e30;
  for (const Ray& ray : rays) {
    REQUIRE(glm::length(to_point(ray.direction) - sun) < 1e-6);
    REQUIRE(glm::dot(to_point(ray.origin), sun) < front);
    rays_lo = std::min(rays_lo, glm::dot(to_point(ray.origin), side));
    rays_hi = std::max(rays_hi, glm::dot(to_point(ray.origin), side));
  }
  CHECK((rays_lo < scene_lo && rays_hi > scene_hi));
  scene.lights.clear();
  for (const Ray& ray : gnomon::parallel_rays(scene, 10, 1)) {
    CHECK(to_point(ray.direction) == Point{0.0, -1.0, 0.0});
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
  for (const Ray& ray : rays) mean += static_cast<double>(ray.direction[1]) / static_cast<double>(rays.size());
  CHECK(rays.size() == 20'000);
  CHECK(mean == Approx(2.0 / 3.0).margin(0.006));
}

TEST_CASE("secondary rays are at most as many as asked for, spread over all hits, none for misses") {
  const Scene scene = floor_scene();
  const auto primary = gnomon::primary_rays(scene, 400, 3);
  auto hits = nearest_hits(scene, primary);
  const auto thinned = gnomon::bounce_rays(scene, primary, hits, 7, 1);
  CHECK(thinned.size() == 7);
  CHECK(same_rays({thinned.begin(), thinned.begin() + 1}, gnomon::bounce_rays(scene, {primary.data(), 1}, {hits.data(), 1}, 9, 1)));
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
  for (const float x : {-1.0F, 0.0F, 1.0F}) scene.lights.push_back(light_at(LightKind::kPoint, {x, 50.0F, 0.0F}));
  const auto primary = gnomon::primary_rays(scene, 900, 3);
  std::vector<unsigned> rays_of(3);
  for (const Ray& ray : gnomon::shadow_rays(scene, primary, nearest_hits(scene, primary), 900, 1)) {
    const Point end = to_point(ray.origin) + static_cast<double>(ray.tmax) * to_point(ray.direction);
    ++rays_of[static_cast<std::size_t>(std::lround(end.x) + 1)];
  }
  for (const unsigned count : rays_of) CHECK((count > 240 && count < 360));
}

TEST_CASE("ray files hold 32 bytes a ray and come back bit for bit") {
  const ScratchFolder folder("rays");
  const auto rays = gnomon::random_rays(floor_scene(), 33, 1);
  gnomon::write_rays(folder / "a.rays", rays);
  CHECK(std::filesystem::file_size(folder / "a.rays") == 33 * 32);
  CHECK(same_rays(gnomon::read_rays(folder / "a.rays"), rays));
  gnomon::write_rays(folder / "none.rays", {});
  CHECK(gnomon::read_rays(folder / "none.rays").empty());
  const std::vector<Hit> hits(5, Hit{1.0F, 0.25F, 0.5F, 7});
  gnomon::write_hits(folder / "a.hits", hits);
  CHECK(std::filesystem::file_size(folder / "a.hits") == 5 * 16);
  CHECK(folder.files() == 3);
}

TEST_CASE("a ray file of odd size, or none at all, is refused") {
  const ScratchFolder folder("odd-rays");
  std::ofstream(folder / "odd.rays") << std::string(33, 'x');
  CHECK_THROWS_WITH(gnomon::read_rays(folder / "odd.rays"), Catch::Contains("33") && Catch::Contains("odd.rays"));
  CHECK_THROWS_AS(gnomon::read_rays(folder / "missing.rays"), gnomon::Error);
  CHECK_THROWS_AS(gnomon::write_rays(folder / "missing/a.rays", {}), gnomon::Error);
}
