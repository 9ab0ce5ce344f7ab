// Materials, cameras and lights of glTF documents.
#include <catch2/catch.hpp>
#include <cmath>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using gnomon::LightKind;
using gnomon::Scene;
using gnomon::Vec3;

namespace {

constexpr const char* kLights = "KHR_lights_punctual";

// One triangle and a node "Stand" with the given light or camera, at (1, 2, 3), turned to look along +x.
GltfBuilder with_light(const Json& light) {
  GltfBuilder builder = one_triangle();
  builder.json["extensions"][kLights]["lights"] = {light};
  builder.json["nodes"].push_back({{"name", "Stand"},
                                   {"translation", {1, 2, 3}},
                                   {"rotation", {0, -std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                   {"scale", {5, 6, 7}},
                                   {"extensions", {{kLights, {{"light", 0}}}}}});
  return builder;
}

GltfBuilder with_camera(const Json& camera) {
  GltfBuilder builder = one_triangle();
  builder.json["cameras"] = {camera};
  builder.json["nodes"].push_back({{"name", "Stand"},
                                   {"camera", 0},
                                   {"translation", {1, 2, 3}},
                                   {"rotation", {0, -std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                   {"scale", {2, 2, 2}}});
  return builder;
}

void check_near(const Vec3& v, float x, float y, float z) {
  CHECK(v[0] == Approx(x).margin(1e-6));
  CHECK(v[1] == Approx(y).margin(1e-6));
  CHECK(v[2] == Approx(z).margin(1e-6));
}

// A square of side 2 at z = 1, facing +z, as two triangles of one primitive.
GltfBuilder emissive_square() {
  GltfBuilder builder;
  const int positions = builder.add_positions({0, 0, 1, 2, 0, 1, 2, 2, 1, 0, 2, 1});
  const int indices = builder.add_indices(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}});
  builder.json["materials"] = {{{"name", "Lamp"}, {"emissiveFactor", {1, 0.5, 0.25}}}};
  return builder;
}

}  // namespace

TEST_CASE("a perspective camera looks down its node's -z with +y up, scale ignored") {
  const Scene scene = load(with_camera(
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"aspectRatio", 1.5}, {"znear", 0.1}}}}));
  REQUIRE(scene.cameras.size() == 1);
  const gnomon::Camera& camera = scene.cameras[0];
  CHECK(camera.name == "Stand");
  check_near(camera.position, 1, 2, 3);
  check_near(camera.forward, 1, 0, 0);
  check_near(camera.up, 0, 1, 0);
  CHECK(camera.fov_y == 0.9F);
  CHECK(camera.aspect == 1.5F);
}

TEST_CASE("a sheared camera's up stays at right angles to its view") {
  GltfBuilder builder =
      with_camera({{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}}}});
  builder.json["nodes"][1] = {{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  const Scene scene = load(builder);
  check_near(scene.cameras.at(0).up, 0, 1, 0);
  check_near(scene.cameras.at(0).forward, 0, 0, -1);
  CHECK(scene.cameras.at(0).aspect == 0);
}

TEST_CASE("cameras that cannot be used are left out with a note") {
  const Json ortho = {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}}}, {"name", "Plan"}};
  const Json wide = {{"type", "perspective"}, {"perspective", {{"yfov", 4.0}}}};
  for (const Json& camera : {ortho, wide}) {
    const Scene scene = load(with_camera(camera));
    CHECK(scene.cameras.empty());
    REQUIRE(scene.report.notes.size() == 1);
    CHECK_THAT(scene.report.notes[0], Contains("camera 0"));
  }
  GltfBuilder flat = with_camera({{"type", "perspective"}, {"perspective", {{"yfov", 0.9}}}});
  flat.json["nodes"][1]["scale"] = {1, 1, 0};
  CHECK(load(flat).cameras.empty());
}

TEST_CASE(
    "a camera or light that does not exist, or of a type that does not, is an error that names its node") {
  GltfBuilder builder = with_camera({{"type", "perspective"}, {"perspective", {{"yfov", 0.9}}}});
  builder.json["nodes"][1]["camera"] = 3;
  CHECK_THAT(load_error(builder), Contains("node 1 \"Stand\": camera 3 does not exist, there are 1"));
  CHECK_THAT(load_error(with_camera({{"type", "fisheye"}})), Contains("cameras[0] must be \"perspective\""));
  builder = with_light({{"type", "point"}});
  builder.json["nodes"][1]["extensions"][kLights]["light"] = 1;
  CHECK_THAT(load_error(builder), Contains("node 1 \"Stand\": light 1 does not exist, there are 1"));
  CHECK_THAT(load_error(with_light({{"type", "laser"}, {"name", "Beam"}})),
             Contains("node 1 \"Stand\", light 0 \"Beam\": light type \"laser\" does not exist"));
}

TEST_CASE("a point light stands at its node; color times intensity, no range means no limit") {
  const Scene scene =
      load(with_light({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 8}, {"name", "Bulb"}}));
  REQUIRE(scene.lights.size() == 1);
  const gnomon::Light& light = scene.lights[0];
  CHECK(light.kind == LightKind::kPoint);
  CHECK(light.name == "Bulb");
  check_near(light.position, 1, 2, 3);
  CHECK(light.color == Vec3{8, 4, 0});
  CHECK(light.range == 0);
}

TEST_CASE("a spot light points down its node's -z, scale ignored, with its cones and range") {
  const Scene scene = load(with_light(
      {{"type", "spot"}, {"range", 20}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}));
  const gnomon::Light& light = scene.lights.at(0);
  CHECK(light.kind == LightKind::kSpot);
  CHECK(light.name == "Stand");
  check_near(light.direction, 1, 0, 0);
  CHECK(light.inner_cone == 0.25F);
  CHECK(light.outer_cone == 0.5F);
  CHECK(light.range == 20);
  CHECK(light.color == Vec3{1, 1, 1});
  CHECK(load(with_light({{"type", "spot"}})).lights.at(0).outer_cone == Approx(0.7853982));
}

TEST_CASE("a directional light has the direction light travels in") {
  const Scene scene = load(with_light({{"type", "directional"}, {"intensity", 3}}));
  CHECK(scene.lights.at(0).kind == LightKind::kDirectional);
  check_near(scene.lights.at(0).direction, 1, 0, 0);
  CHECK(scene.lights.at(0).color == Vec3{3, 3, 3});
}

TEST_CASE("materials keep base color, emission, roughness and metalness, clamped to what they may be") {
  GltfBuilder builder = one_triangle();
  builder.primitive()["material"] = 1;
  builder.json["materials"] = {
      {{"name", "Plain"}},
      {{"name", "Red"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 2, -1, 1}}, {"roughnessFactor", 0.25}}}},
      {{"name", "Tin"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}},
      {{"name", "Odd"}, {"pbrMetallicRoughness", {{"metallicFactor", -3}}}}};
  const Scene scene = load(builder);
  REQUIRE(scene.materials.size() == 4);
  CHECK(scene.materials[0].base_color == Vec3{1, 1, 1});
  CHECK(scene.materials[0].roughness == 1);
  CHECK(scene.materials[0].metallic == 1);  // glTF's default
  CHECK(scene.materials[2].metallic == 0.25F);
  CHECK(scene.materials[3].metallic == 0);
  CHECK(scene.materials[1].name == "Red");
  CHECK(scene.materials[1].base_color == Vec3{0.5F, 1, 0});
  CHECK(scene.materials[1].roughness == 0.25F);
  CHECK(scene.material_ids == std::vector<std::uint32_t>{1});
  CHECK(scene.lights.empty());
}

TEST_CASE("primitives without a material share one default material") {
  GltfBuilder builder = one_triangle();
  builder.json["materials"] = {{{"name", "Unused"}}};
  builder.json["meshes"][0]["primitives"].push_back(builder.primitive());
  const Scene scene = load(builder);
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.material_ids == std::vector<std::uint32_t>{1, 1});
  CHECK(scene.materials[1].base_color == gnomon::Material{}.base_color);
}

TEST_CASE("an emissive primitive is one area light with its triangles, centroid and normal") {
  GltfBuilder builder = emissive_square();
  builder.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 8;
  const Scene scene = load(builder);
  REQUIRE(scene.lights.size() == 1);
  const gnomon::Light& light = scene.lights[0];
  CHECK(light.kind == LightKind::kArea);
  CHECK(light.name == "Lamp");
  CHECK(light.color == Vec3{8, 4, 2});
  CHECK(scene.materials[0].emission == Vec3{8, 4, 2});
  check_near(light.position, 1, 1, 1);
  check_near(light.direction, 0, 0, 1);
  CHECK(light.triangles == std::vector<std::uint32_t>{0, 1});
}

TEST_CASE("an emissive mesh shown by two nodes is two area lights, each where its node stands") {
  GltfBuilder builder = emissive_square();
  builder.json["nodes"].push_back({{"mesh", 0}, {"scale", {1, 1, -1}}});
  const Scene scene = load(builder);
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[1].triangles == std::vector<std::uint32_t>{2, 3});
  check_near(scene.lights[1].position, 1, 1, -1);
  check_near(scene.lights[1].direction, 0, 0, -1);  // mirrored, still outwards
}

TEST_CASE("an area light leaves out triangles that were dropped, and is none when all were") {
  GltfBuilder builder = emissive_square();
  builder.primitive()["indices"] = builder.add_indices(std::vector<std::uint8_t>{0, 0, 0, 0, 2, 3});
  const Scene scene = load(builder);
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].triangles == std::vector<std::uint32_t>{0});
  builder.primitive()["indices"] = builder.add_indices(std::vector<std::uint8_t>{0, 0, 0});
  builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
  CHECK(load(builder).lights.empty());
}

TEST_CASE("an area light that faces all ways has no direction") {
  GltfBuilder builder;
  const int positions = builder.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const int indices = builder.add_indices(std::vector<std::uint8_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}});
  builder.json["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
  CHECK(load(builder).lights.at(0).direction == Vec3{0, 0, 0});
}

TEST_CASE("textures are not read, and notes say so") {
  GltfBuilder builder = emissive_square();
  builder.json["materials"][0]["emissiveTexture"] = {{"index", 3}};
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 9}};
  const Scene scene = load(builder);
  REQUIRE(scene.report.notes.size() == 2);
  CHECK_THAT(scene.report.notes[0], Contains("1 materials have their plain color only"));
  CHECK_THAT(scene.report.notes[1], Contains("shine with their whole surface"));
}
