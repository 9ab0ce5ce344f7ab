#include "gnomon/scene/gltf_export.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "gnomon/base/error.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/glb_container.h"
#include "gnomon/scene/import.h"
#include "scene_test_tools.h"

using namespace gnomon_test;
using gnomon::export_glb;
using gnomon::generate_scene;
using gnomon::Light;
using gnomon::LightKind;
using gnomon::Scene;
using gnomon::Triangle;
using Bytes = std::vector<unsigned char>;

namespace {

std::uint32_t word_at(const Bytes& bytes, std::size_t offset) {
  std::uint32_t word = 0;
  REQUIRE(offset + sizeof word <= bytes.size());
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

// A .glb taken apart by the specification, apart from the importer.
struct Parts {
  nlohmann::json json;
  Bytes buffer;
};
Parts take_apart(const Bytes& glb) {
  REQUIRE(std::memcmp(glb.data(), "glTF", 4) == 0);
  REQUIRE(word_at(glb, 4) == 2);
  REQUIRE(word_at(glb, 8) == glb.size());
  const std::size_t json_size = word_at(glb, 12);
  REQUIRE(std::memcmp(glb.data() + 16, "JSON", 4) == 0);
  REQUIRE(json_size % 4 == 0);
  Parts parts{
      nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + static_cast<std::ptrdiff_t>(json_size)), {}};
  const std::size_t bin = 20 + json_size;
  if (bin == glb.size()) return parts;
  REQUIRE(std::memcmp(glb.data() + bin + 4, "BIN", 4) == 0);
  REQUIRE(word_at(glb, bin) % 4 == 0);
  REQUIRE(bin + 8 + word_at(glb, bin) == glb.size());
  parts.buffer.assign(glb.begin() + static_cast<std::ptrdiff_t>(bin) + 8, glb.end());
  return parts;
}

Scene square(const gnomon::Vec3& emission = {0.0F, 0.0F, 0.0F}) {
  Scene scene;
  scene.name = "square";
  scene.materials = {{"stone", {0.7F, 0.6F, 0.5F}, emission, 0.25F}};
  scene.triangles = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  scene.material_ids = {0, 0};
  return scene;
}

Scene reimported(const Scene& scene) {
  const Bytes glb = export_glb(scene);
  return gnomon::import_gltf_bytes(glb.data(), glb.size(), {});
}

// Triangles by material, in order within each: what a file with one mesh per material can keep.
std::vector<std::uint32_t> grouped_order(const Scene& scene) {
  std::vector<std::uint32_t> order(scene.triangles.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return scene.material_ids[a] < scene.material_ids[b]; });
  return order;
}

bool near(const gnomon::Vec3& a, const gnomon::Vec3& b) {
  return glm::length(to_point(a) - to_point(b)) <= 1e-5 * (1.0 + glm::length(to_point(b)));
}

std::vector<Light> sorted_lights(std::vector<Light> lights) {
  std::stable_partition(lights.begin(), lights.end(),
                        [](const Light& l) { return l.kind != LightKind::kArea; });
  return lights;
}

}  // namespace

TEST_CASE("every generated scene comes back with the same triangles, bit for bit") {
  for (const gnomon::GeneratorInfo& info : gnomon::generators()) {
    CAPTURE(info.name);
    const Scene scene = generate_scene(info.name, std::max<std::uint64_t>(info.min_triangles, 100), 4);
    const Scene back = reimported(scene);
    REQUIRE(back.triangles.size() == scene.triangles.size());
    const auto order = grouped_order(scene);
    for (std::size_t i = 0; i < order.size(); ++i) {
      CAPTURE(i);
      REQUIRE(std::memcmp(&back.triangles[i], &scene.triangles[order[i]], sizeof(Triangle)) == 0);
      const gnomon::Material& wanted = scene.materials[scene.material_ids[order[i]]];
      const gnomon::Material& material = back.materials[back.material_ids[i]];
      REQUIRE(material.name == wanted.name);
      REQUIRE(near(material.base_color, wanted.base_color));
      REQUIRE(near(material.emission, wanted.emission));
      REQUIRE(material.roughness == Approx(wanted.roughness));
      REQUIRE(material.metallic == wanted.metallic);
    }
  }
}

TEST_CASE("cameras and lights come back within 1e-5") {
  for (const gnomon::GeneratorInfo& info : gnomon::generators()) {
    const Scene scene = generate_scene(info.name, std::max<std::uint64_t>(info.min_triangles, 100), 4);
    const Scene back = reimported(scene);
    CAPTURE(info.name);
    REQUIRE(back.cameras.size() == scene.cameras.size());
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      CAPTURE(i);
      REQUIRE(back.cameras[i].name == scene.cameras[i].name);
      REQUIRE(near(back.cameras[i].position, scene.cameras[i].position));
      REQUIRE(near(back.cameras[i].forward, scene.cameras[i].forward));
      REQUIRE(near(back.cameras[i].up, scene.cameras[i].up));
      REQUIRE(back.cameras[i].fov_y == Approx(scene.cameras[i].fov_y).epsilon(1e-5));
      REQUIRE(back.cameras[i].aspect == Approx(scene.cameras[i].aspect).epsilon(1e-5));
    }
    const std::vector<Light> wanted = sorted_lights(scene.lights);
    const std::vector<Light> lights = sorted_lights(back.lights);
    REQUIRE(lights.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      CAPTURE(i, wanted[i].name);
      REQUIRE(lights[i].name == wanted[i].name);
      REQUIRE(lights[i].kind == wanted[i].kind);
      REQUIRE(near(lights[i].color, wanted[i].color));
      if (wanted[i].kind != LightKind::kDirectional) REQUIRE(near(lights[i].position, wanted[i].position));
      if (wanted[i].kind != LightKind::kPoint) REQUIRE(near(lights[i].direction, wanted[i].direction));
      REQUIRE(lights[i].triangles.size() == wanted[i].triangles.size());
      if (wanted[i].kind != LightKind::kSpot) continue;
      REQUIRE(lights[i].inner_cone == Approx(wanted[i].inner_cone).epsilon(1e-5));
      REQUIRE(lights[i].outer_cone == Approx(wanted[i].outer_cone).epsilon(1e-5));
    }
  }
}

TEST_CASE("cameras and lights that look any way at all come back") {
  Scene scene = square();
  for (const gnomon::Vec3& forward : {gnomon::Vec3{0, -1, 0},
                                      {0, 1, 0},
                                      {0, 0, 1},
                                      {0, 0, -1},
                                      {1, 0, 0},
                                      {-1, 0, 0},
                                      {0.6F, 0.0F, 0.8F},
                                      {-0.48F, -0.6F, 0.64F}}) {
    gnomon::Camera camera;
    camera.forward = forward;
    const Point other = std::abs(forward[1]) > 0.9F ? Point{0.0, 0.0, 1.0} : Point{0.0, 1.0, 0.0};
    const Point right = glm::normalize(glm::cross(to_point(forward), other));
    const Point up = glm::cross(right, to_point(forward));
    camera.up = {static_cast<float>(up.x), static_cast<float>(up.y), static_cast<float>(up.z)};
    scene.cameras.push_back(camera);
    Light light;
    light.kind = LightKind::kDirectional;
    light.direction = forward;
    light.color = {0.0F, 3.0F, 0.5F};
    scene.lights.push_back(light);
  }
  const Scene back = reimported(scene);
  REQUIRE(back.cameras.size() == scene.cameras.size());
  REQUIRE(back.lights.size() == scene.lights.size());
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    CAPTURE(i);
    REQUIRE(near(back.cameras[i].forward, scene.cameras[i].forward));
    REQUIRE(near(back.cameras[i].up, scene.cameras[i].up));
    REQUIRE(back.cameras[i].aspect == 0.0F);
    REQUIRE(near(back.lights[i].direction, scene.lights[i].direction));
    REQUIRE(near(back.lights[i].color, scene.lights[i].color));
  }
}

TEST_CASE("corners that repeat are stored once, and -0 is not 0") {
  Scene scene = square();
  CHECK(take_apart(export_glb(scene)).json["accessors"][0]["count"] == 4);
  scene.triangles[1].v0[2] = -0.0F;
  CHECK(take_apart(export_glb(scene)).json["accessors"][0]["count"] == 5);
  const Scene back = reimported(scene);
  CHECK(std::memcmp(back.triangles.data(), scene.triangles.data(), 2 * sizeof(Triangle)) == 0);
}

TEST_CASE("views lie inside the buffer on four-byte boundaries and say what they are for") {
  const Parts parts = take_apart(export_glb(generate_scene("cottage", 8000, 1)));
  const auto& buffer = parts.json["buffers"][0];
  REQUIRE(parts.buffer.size() - buffer["byteLength"].get<std::size_t>() < 4);
  for (const auto& accessor : parts.json["accessors"]) {
    const auto& view = parts.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    CAPTURE(accessor.dump(), view.dump());
    const bool corners = accessor["type"] == "VEC3";
    const std::size_t size = corners ? 12 : (accessor["componentType"] == 5123 ? 2 : 4);
    REQUIRE(view["byteOffset"].get<std::size_t>() % 4 == 0);
    REQUIRE(view["byteLength"] == accessor["count"].get<std::size_t>() * size);
    REQUIRE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>() <=
            buffer["byteLength"]);
    REQUIRE(view["target"] == (corners ? 34962 : 34963));
  }
}

TEST_CASE("position accessors state the exact bounds of their corners") {
  const Parts parts = take_apart(export_glb(generate_scene("city", 3000, 1)));
  for (const auto& accessor : parts.json["accessors"]) {
    if (accessor["type"] != "VEC3") continue;
    const auto& view = parts.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<gnomon::Vec3> corners(accessor["count"].get<std::size_t>());
    std::memcpy(corners.data(), parts.buffer.data() + view["byteOffset"].get<std::size_t>(),
                corners.size() * 12);
    for (unsigned axis = 0; axis < 3; ++axis) {
      CAPTURE(accessor.dump(), axis);
      const auto less = [&](const gnomon::Vec3& a, const gnomon::Vec3& b) { return a[axis] < b[axis]; };
      REQUIRE(accessor["min"][axis] == (*std::min_element(corners.begin(), corners.end(), less))[axis]);
      REQUIRE(accessor["max"][axis] == (*std::max_element(corners.begin(), corners.end(), less))[axis]);
    }
  }
}

TEST_CASE("indices are 16 bits wide up to 65535 corners and 32 above") {
  Scene scene = generate_scene("random", 21'846, 1);
  std::fill(scene.material_ids.begin(), scene.material_ids.end(), 0U);
  const auto width_at = [&](std::size_t corners) {
    const Parts parts = take_apart(export_glb(scene));
    REQUIRE(parts.json["accessors"][0]["count"] == corners);
    return parts.json["accessors"][1]["componentType"];
  };
  scene.triangles[1] = {{1, 2, 3}, {4, 5, 6}, {0, 0, 9}};
  scene.triangles[2] = {{1, 2, 3}, {4, 5, 6}, {0, 9, 0}};
  CHECK(width_at(65'536) == 5125);
  std::copy(scene.triangles[0].v0, scene.triangles[0].v0 + 3, scene.triangles[2].v2);
  CHECK(width_at(65'535) == 5123);
}

TEST_CASE("emission above one goes into the strength, below it stays in the factor") {
  const auto bright = take_apart(export_glb(square({8.0F, 4.0F, 0.0F}))).json;
  CHECK(bright["materials"][0]["emissiveFactor"] == nlohmann::json({1.0, 0.5, 0.0}));
  CHECK(bright["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 8.0);
  CHECK(bright["extensionsUsed"] == nlohmann::json({"KHR_materials_emissive_strength"}));
  const auto dim = take_apart(export_glb(square({0.5F, 0.25F, 0.0F}))).json;
  CHECK(dim["materials"][0]["emissiveFactor"] == nlohmann::json({0.5, 0.25, 0.0}));
  CHECK_FALSE(dim.contains("extensionsUsed"));
  CHECK_FALSE(take_apart(export_glb(square())).json["materials"][0].contains("emissiveFactor"));
}

TEST_CASE("the same scene gives the same bytes, with nothing of the day in them") {
  const Scene scene = generate_scene("crowd", 5000, 1);
  CHECK(export_glb(scene) == export_glb(scene));
  const auto asset = take_apart(export_glb(scene)).json["asset"];
  CHECK(asset == nlohmann::json({{"version", "2.0"}, {"generator", "gnomon"}}));
}

TEST_CASE("an empty scene is a valid file without a buffer") {
  const Parts parts = take_apart(export_glb(Scene{}));
  CHECK((parts.buffer.empty() && !parts.json.contains("buffers") && !parts.json.contains("meshes")));
}

TEST_CASE("names that are not UTF-8 do not spoil the file") {
  Scene scene = square();
  scene.materials[0].name = "caf\xe9";
  CHECK(take_apart(export_glb(scene)).json["materials"][0]["name"].get<std::string>().substr(0, 3) == "caf");
}

TEST_CASE("a buffer beyond four gigabytes is refused with its size") {
  CHECK_NOTHROW(gnomon::require_glb_room(4'000'000'000ULL));
  CHECK_THROWS_WITH(gnomon::require_glb_room(5'000'000'000ULL), Catch::Contains("5000000000"));
}

TEST_CASE("writing replaces the file and leaves nothing beside it") {
  const ScratchFolder folder("export-write");
  gnomon::write_glb(square(), folder / "a.glb");
  const Scene scene = generate_scene("random100", 100, 1);
  gnomon::write_glb(scene, folder / "a.glb");
  CHECK(folder.files() == 1);
  std::ifstream file(folder / "a.glb", std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  CHECK(bytes == export_glb(scene));
}

TEST_CASE("writing where it cannot be done names the path and the reason, and leaves what was there") {
  const ScratchFolder folder("export-fail");
  const auto code_of = [&](const std::filesystem::path& file) {
    try {
      gnomon::write_glb(square(), file);
    } catch (const gnomon::Error& error) {
      CHECK_THAT(error.what(), Catch::Contains(file.string()));
      return error.code();
    }
    return gnomon::ErrorCode::kDevice;
  };
  CHECK(code_of(folder / "missing/a.glb") == gnomon::ErrorCode::kIo);
  std::filesystem::create_directories(folder / "taken.glb/inside");
  CHECK(code_of(folder / "taken.glb") == gnomon::ErrorCode::kIo);
  CHECK(folder.files() == 1);
}
