#include "gnomon/scene/ray_set.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::generate_scene;
using gnomon::Hit;
using gnomon::Ray;
using gnomon::RayKind;
using gnomon::Scene;

namespace {

// Column and row of a primary ray in a picture of n by n pixels.
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
  for (const RayKind kind :
       {RayKind::kPrimary, RayKind::kBounce, RayKind::kShadow, RayKind::kRandom, RayKind::kParallel}) {
    CHECK(gnomon::ray_kind_from(gnomon::to_string(kind)) == kind);
    CHECK(gnomon::asks_any_hit(kind) == (kind == RayKind::kShadow || kind == RayKind::kParallel));
  }
  CHECK(gnomon::to_string(RayKind::kShadow) == "shadow");
  CHECK_FALSE(gnomon::ray_kind_from("Primary"));
  CHECK_FALSE(gnomon::ray_kind_from(""));
}

TEST_CASE("rays of a camera, along a sun and to the only light run together, others do not") {
  Scene scene;
  const auto together = [&](RayKind kind) { return gnomon::run_together(kind, scene); };
  CHECK(together(RayKind::kPrimary));
  CHECK(together(RayKind::kParallel));
  CHECK_FALSE(together(RayKind::kBounce));
  CHECK_FALSE(together(RayKind::kRandom));
  CHECK(together(RayKind::kShadow));  // to the sun that a scene without lights has
  scene.lights.resize(1);
  CHECK(together(RayKind::kShadow));
  scene.lights[0].kind = gnomon::LightKind::kArea;
  CHECK_FALSE(together(RayKind::kShadow));
  scene.lights = std::vector<gnomon::Light>(2);
  CHECK_FALSE(together(RayKind::kShadow));
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
  for (const auto& rays : {gnomon::primary_rays(scene, 9, 1), gnomon::random_rays(scene, 9, 1),
                           gnomon::parallel_rays(scene, 9, 1)}) {
    REQUIRE(rays.size() == 9);
    for (const Ray& ray : rays) {
      for (unsigned k = 0; k < 3; ++k)
        REQUIRE((std::isfinite(ray.origin[k]) && std::isfinite(ray.direction[k])));
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
    for (unsigned k = 0; k < 3; ++k)
      REQUIRE((ray.origin[k] >= bounds.lo[k] && ray.origin[k] <= bounds.hi[k]));
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
  CHECK_THROWS_WITH(gnomon::read_rays(folder / "odd.rays"),
                    Catch::Contains("33") && Catch::Contains("odd.rays"));
  CHECK_THROWS_AS(gnomon::read_rays(folder / "missing.rays"), gnomon::Error);
  CHECK_THROWS_AS(gnomon::write_rays(folder / "missing/a.rays", {}), gnomon::Error);
}
