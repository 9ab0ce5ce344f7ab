#include "gnomon/scene/mesh_sketch.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::Frame;
using gnomon::MeshSketch;
using gnomon::Scene;

namespace {

Scene drawn(const std::function<void(MeshSketch&)>& draw) {
  MeshSketch sketch("test", 100);
  sketch.use(sketch.material("grey", {0.5F, 0.5F, 0.5F}));
  draw(sketch);
  return sketch.finish();
}

// Positive when the faces of a closed surface look outwards (divergence theorem).
double signed_volume(const Scene& scene) {
  double volume = 0.0;
  for (const gnomon::Triangle& t : scene.triangles) {
    volume += glm::dot(to_point(t.v0), glm::cross(to_point(t.v1), to_point(t.v2))) / 6.0;
  }
  return volume;
}

// Zero for a surface without a gap.
double open_area(const Scene& scene) {
  Point sum{0.0};
  for (const gnomon::Triangle& t : scene.triangles) sum += area_vector(t);
  return glm::length(sum);
}

}  // namespace

TEST_CASE("the sine of turns is the sine, to the last digits") {
  for (int i = -4000; i <= 4000; ++i) {
    const double turns = i / 997.0;
    CAPTURE(turns);
    REQUIRE(std::abs(gnomon::sin_turns(turns) - std::sin(2.0 * gnomon::kPi * turns)) < 1e-14);
    REQUIRE(std::abs(gnomon::cos_turns(turns) - std::cos(2.0 * gnomon::kPi * turns)) < 1e-14);
  }
}

TEST_CASE("the steady random numbers are these") {
  gnomon::SteadyRandom random(1);
  const std::array<std::uint64_t, 3> first{random.bits(), random.bits(), random.bits()};
  gnomon::SteadyRandom other(1, 1);
  CHECK(first[0] != other.bits());
  CHECK(first ==
        std::array<std::uint64_t, 3>{0x017daf0019666393ULL, 0xd9e484272f675712ULL, 0x29bd10db6bcd372fULL});
}

TEST_CASE("solids are closed, face outwards and have their volume") {
  const Frame tilted = gnomon::aimed({0.3, 0.2, 0.1}, {1.0, 1.4, -0.6});
  const std::array<glm::dvec2, 4> can{{{0.0, 0.0}, {0.5, 0.0}, {0.5, 2.0}, {0.0, 2.0}}};
  const Scene box = drawn([&](MeshSketch& s) { s.box(tilted, {-1.0, -0.5, 0.0}, {1.0, 0.5, 2.0}); });
  const Scene lathe = drawn([&](MeshSketch& s) { s.lathe(tilted, can, 200); });
  const Scene ellipsoid = drawn([&](MeshSketch& s) { s.ellipsoid(tilted, {1.0, 2.0, 0.5}, 120, 90); });
  const Scene limb = drawn([&](MeshSketch& s) {
    s.limb({0.0, 1.0, 0.0}, {3.0, 1.0, 0.0}, 0.5, 0.5, 120, 60);
  });
  CHECK(signed_volume(box) == Approx(4.0).epsilon(1e-5));
  CHECK(signed_volume(lathe) == Approx(0.5 * gnomon::kPi).epsilon(1e-3));
  CHECK(signed_volume(ellipsoid) == Approx(4.0 / 3.0 * gnomon::kPi).epsilon(3e-3));
  CHECK(signed_volume(limb) == Approx(gnomon::kPi * (0.75 + 0.5 / 3.0)).epsilon(3e-3));
  for (const Scene* solid : {&box, &lathe, &ellipsoid, &limb}) CHECK(open_area(*solid) < 1e-4);
}

TEST_CASE("a bent tube faces outwards all along") {
  std::vector<Point> path;
  for (unsigned i = 0; i <= 40; ++i) path.push_back({std::cos(0.2 * i), 0.1 * i, std::sin(0.2 * i)});
  const std::vector<double> radii(path.size(), 0.05);
  const Scene scene = drawn([&](MeshSketch& s) { s.tube(path, radii, 8); });
  REQUIRE(scene.triangles.size() == 40 * 8 * 2);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    CAPTURE(i);
    const gnomon::Triangle& t = scene.triangles[i];
    const Point middle = (to_point(t.v0) + to_point(t.v1) + to_point(t.v2)) / 3.0;
    const Point core = 0.5 * (path[i / 16] + path[i / 16 + 1]);
    REQUIRE(glm::dot(area_vector(t), middle - core) > 0.0);
  }
}

TEST_CASE("flat triangles are left out") {
  const Scene scene = drawn([](MeshSketch& s) {
    s.triangle(Point{0.0}, Point{1.0}, Point{2.0});
    s.triangle(Point{0.0}, Point{1.0}, Point{1.0});
    s.quad({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {1.0, 1.0, 0.0});
  });
  CHECK(scene.triangles.size() == 1);
}

TEST_CASE("an emissive material becomes one area light, an unused one none") {
  MeshSketch sketch("test", 4);
  const auto lamp = sketch.material("lamp", {0.0F, 0.0F, 0.0F}, 1.0F, {2.0F, 1.0F, 0.5F});
  static_cast<void>(sketch.material("spare lamp", {0.0F, 0.0F, 0.0F}, 1.0F, {2.0F, 1.0F, 0.5F}));
  const auto grey = sketch.material("grey", {0.5F, 0.5F, 0.5F});
  sketch.use(grey);
  sketch.triangle(Point{0.0}, Point{1.0, 0.0, 0.0}, Point{0.0, 1.0, 0.0});
  sketch.use(lamp);
  sketch.quad({0.0, 3.0, 0.0}, {1.0, 3.0, 0.0}, {1.0, 3.0, 1.0}, {0.0, 3.0, 1.0});
  const Scene scene = sketch.finish();
  REQUIRE(scene.lights.size() == 1);
  const gnomon::Light& light = scene.lights[0];
  CHECK(light.kind == gnomon::LightKind::kArea);
  CHECK(light.name == "lamp");
  CHECK(light.triangles == std::vector<std::uint32_t>{1, 2});
  CHECK(light.color == gnomon::Vec3{2.0F, 1.0F, 0.5F});
  CHECK(light.position == gnomon::Vec3{0.5F, 3.0F, 0.5F});
  CHECK(light.direction == gnomon::Vec3{0.0F, -1.0F, 0.0F});
}
