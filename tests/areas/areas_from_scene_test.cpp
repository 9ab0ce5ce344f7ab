// Influence areas of lights.
#include "gnomon/areas/areas_from_scene.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/membership.h"
#include "gnomon/scene/area_light.h"
#include "gnomon/scene/generators.h"
#include "support/shapes.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

Light light_of(LightKind kind) {
  Light light;
  light.kind = kind;
  light.position = {5.0F, 12.0F, 5.0F};
  light.direction = {0.0F, -1.0F, 0.0F};
  return light;
}

Scene soup_scene() {
  Scene scene;
  scene.triangles = soup(300, 17);
  scene.materials.resize(1);
  scene.material_ids.assign(scene.triangles.size(), 0);
  return scene;
}

bool holds_all(const InfluenceArea& area, const Scene& scene) {
  for (const Triangle& t : scene.triangles) {
    for (const float* v : {t.v0, t.v1, t.v2}) {
      if (!area.contains({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])}))
        return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("a directional light's area is the tightest window box around the scene") {
  Scene scene = soup_scene();
  for (const Vec3 direction : {Vec3{0, -1, 0}, Vec3{0.28F, -1.0F, -0.42F}, Vec3{1, 0, 0}, Vec3{-1, -1, -1}}) {
    Light sun = light_of(LightKind::kDirectional);
    sun.direction = direction;
    scene.lights = {sun};
    const auto areas = areas_of_lights(scene);
    CAPTURE(direction);
    REQUIRE(areas.size() == 1);
    const InfluenceArea& area = areas[0].area;
    REQUIRE(area.kind() == AreaKind::kPlane);
    const Vec3d d{static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                  static_cast<double>(direction[2])};
    REQUIRE(dot(area.frame().forward, unit_of(d)) == Approx(1.0).epsilon(1e-12));
    REQUIRE(holds_all(area, scene));
    REQUIRE(members(area, scene.triangles).size() == scene.triangles.size());
    // Every side is near a corner of some triangle.
    for (const Plane& plane : area.planes()) {
      double nearest = 1e9;
      for (const Triangle& t : scene.triangles) {
        for (const float* v : {t.v0, t.v1, t.v2})
          nearest =
              std::min(nearest, signed_distance(plane, {static_cast<double>(v[0]), static_cast<double>(v[1]),
                                                        static_cast<double>(v[2])}));
      }
      REQUIRE(nearest > 0.0);
      REQUIRE(nearest < 1e-4);
    }
  }
}

TEST_CASE("a flat scene seen edge-on still has an area, one without triangles none") {
  Scene scene;
  scene.triangles = grid(4);
  Light sun = light_of(LightKind::kDirectional);
  sun.direction = {1, 0, 0};
  scene.lights = {sun, light_of(LightKind::kPoint)};
  REQUIRE(areas_of_lights(scene).size() == 2);
  REQUIRE(holds_all(areas_of_lights(scene)[0].area, scene));
  scene.triangles = {triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0})};
  REQUIRE(holds_all(areas_of_lights(scene)[0].area, scene));
  scene.triangles.clear();
  REQUIRE(areas_of_lights(scene).empty());
}

TEST_CASE("a point light's ball has its range, or else the whole scene") {
  Scene scene = soup_scene();
  Light bulb = light_of(LightKind::kPoint);
  scene.lights = {bulb};
  REQUIRE(areas_of_lights(scene)[0].area.kind() == AreaKind::kOmni);
  REQUIRE(holds_all(areas_of_lights(scene)[0].area, scene));
  scene.lights[0].range = 3.0F;
  const InfluenceArea limited = areas_of_lights(scene)[0].area;
  REQUIRE(std::get<Ball>(limited.region()).radius == 3.0);
  REQUIRE(std::get<Ball>(limited.region()).centre == Vec3d{5, 12, 5});
  scene.lights[0].range = 1e9F;  // no farther than the scene
  REQUIRE(std::get<Ball>(areas_of_lights(scene)[0].area.region()).radius < 30.0);
}

TEST_CASE("a spot's frustum holds all of its cone") {
  Source source(101);
  Scene scene = soup_scene();
  for (const double degrees : {0.0, 1.0, 20.0, 45.0, 74.0, 80.0, 90.0}) {
    Light spot = light_of(LightKind::kSpot);
    spot.direction = {0.36F, -0.8F, 0.48F};
    spot.outer_cone = static_cast<float>(degrees * kDegree);
    spot.range = 9.0F;
    scene.lights = {spot};
    const auto areas = areas_of_lights(scene);
    REQUIRE(areas.size() == 1);
    const InfluenceArea& area = areas[0].area;
    CAPTURE(degrees);
    REQUIRE(area.kind() == (degrees > 75.0 ? AreaKind::kOmni : AreaKind::kPoint));
    const AreaFrame frame = look_along({5, 12, 5}, {0.36, -0.8, 0.48}, kWorldUp);
    for (int i = 0; i < 1000; ++i) {
      const double angle = source.between(0.0, 0.9999) * degrees * kDegree;
      const double turn = source.between(0.0, 2.0 * kPiD);
      const double r = source.between(0.01, 0.9999) * 9.0;
      const Vec3d p = to_world(frame, {r * std::sin(angle) * std::cos(turn),
                                       r * std::sin(angle) * std::sin(turn), r * std::cos(angle)});
      CAPTURE(angle, turn, r);
      if (degrees > 0.0) REQUIRE(area.contains(p));
    }
  }
}

TEST_CASE("a panel's area is in front of it, as wide as it is and as deep as the scene") {
  Scene scene = soup_scene();
  Material glowing;
  glowing.emission = {1, 1, 1};
  const auto first = static_cast<std::uint32_t>(scene.triangles.size());
  // Two triangles facing down, 2 by 1, at the height 12.
  scene.triangles.push_back(triangle({4, 12, 4}, {6, 12, 4}, {6, 12, 5}));
  scene.triangles.push_back(triangle({4, 12, 4}, {6, 12, 5}, {4, 12, 5}));
  scene.lights = {make_area_light(scene, "panel", glowing, {first, first + 1})};
  REQUIRE(scene.lights[0].direction == Vec3{0, -1, 0});
  const auto areas = areas_of_lights(scene);
  REQUIRE(areas.size() == 1);
  const InfluenceArea& area = areas[0].area;
  REQUIRE(area.kind() == AreaKind::kPlane);
  REQUIRE(area.frame().forward == Vec3d{0, -1, 0});
  REQUIRE(area.half_window()[0] * area.half_window()[1] == Approx(0.5).epsilon(1e-4));
  REQUIRE(area.contains({5, 12, 4.5}));
  REQUIRE(area.contains({4.01, 0.0, 4.99}));
  REQUIRE_FALSE(area.contains({5, 12.1, 4.5}));
  REQUIRE_FALSE(area.contains({3.9, 6, 4.5}));
  // From the other side nothing is in front.
  scene.lights[0].direction = {0, 1, 0};
  REQUIRE(areas_of_lights(scene).empty());
  // A closed emitter faces no way: a bulb. One without triangles is nothing.
  scene.lights[0].direction = {0, 0, 0};
  REQUIRE(areas_of_lights(scene)[0].area.kind() == AreaKind::kOmni);
  scene.lights[0].triangles.clear();
  REQUIRE(areas_of_lights(scene).empty());
}

TEST_CASE("the lights of generated scenes have areas, in their order") {
  for (const char* name : {"atrium", "city", "crowd", "cottage"}) {
    const Scene scene = generate_scene(name, 20000, 1);
    const auto areas = areas_of_lights(scene);
    CAPTURE(name, scene.lights.size(), areas.size());
    REQUIRE_FALSE(areas.empty());
    for (std::size_t i = 0; i < areas.size(); ++i) {
      CAPTURE(i, areas[i].light);
      REQUIRE(areas[i].light < scene.lights.size());
      if (i > 0) REQUIRE(areas[i].light > areas[i - 1].light);
      REQUIRE_FALSE(members(areas[i].area, scene.triangles).empty());
    }
  }
}
