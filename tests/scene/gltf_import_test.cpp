// Node hierarchies, primitive modes and scenes of glTF documents.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using gnomon::Scene;
using gnomon::Triangle;
using Corner = std::tuple<float, float, float>;

namespace {

Corner v0(const Triangle& t) {
  return {t.v0[0], t.v0[1], t.v0[2]};
}
Corner v1(const Triangle& t) {
  return {t.v1[0], t.v1[1], t.v1[2]};
}
Corner v2(const Triangle& t) {
  return {t.v2[0], t.v2[1], t.v2[2]};
}

float normal_z(const Triangle& t) {
  return (t.v1[0] - t.v0[0]) * (t.v2[1] - t.v0[1]) - (t.v1[1] - t.v0[1]) * (t.v2[0] - t.v0[0]);
}

// Five vertices on a zigzag in the plane z = 0.
GltfBuilder zigzag(int mode) {
  GltfBuilder builder;
  const int positions = builder.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
  return builder;
}

}  // namespace

TEST_CASE("a data URI document and a GLB of the same mesh give the same triangles") {
  const GltfBuilder builder = one_triangle();
  const Scene from_text = load(builder.text());
  const Scene from_glb = load(builder.glb());
  REQUIRE(from_text.triangles.size() == 1);
  REQUIRE(from_glb.triangles.size() == 1);
  CHECK(v0(from_text.triangles[0]) == Corner{0, 0, 0});
  CHECK(v1(from_text.triangles[0]) == Corner{1, 0, 0});
  CHECK(v2(from_text.triangles[0]) == Corner{0, 1, 0});
  CHECK(gnomon::scene_hash(from_text) == gnomon::scene_hash(from_glb));
  CHECK(from_text.cameras.empty());
  CHECK(from_text.lights.empty());
  CHECK(from_text.report.dropped() == 0);
  CHECK(from_text.report.notes.empty());
}

TEST_CASE("translation, rotation and scale apply in the order T * R * S, parents last") {
  GltfBuilder builder = one_triangle();
  const double half = std::sqrt(0.5);
  builder.json["nodes"][0]["scale"] = {2, 3, 4};
  builder.json["nodes"][0]["rotation"] = {0, 0, half, half};  // x to y
  builder.json["nodes"][0]["translation"] = {10, 0, 0};
  builder.json["nodes"].push_back({{"children", {0}}, {"translation", {0, 0, 5}}, {"scale", {1, 1, 2}}});
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 1);
  const Triangle& t = scene.triangles[0];
  CHECK(v0(t) == Corner{10, 0, 5});
  CHECK(std::get<0>(v1(t)) == Approx(10));
  CHECK(std::get<1>(v1(t)) == Approx(2));
  CHECK(std::get<0>(v2(t)) == Approx(7));
  CHECK(std::get<1>(v2(t)) == Approx(0).margin(1e-6));
}

TEST_CASE("a matrix is read column by column") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["matrix"] = {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1};
  const Triangle t = load(builder).triangles.at(0);
  CHECK(v0(t) == Corner{11, 12, 13});
  CHECK((v1(t) == Corner{12, 14, 16} || v2(t) == Corner{12, 14, 16}));  // its determinant is negative
}

TEST_CASE("transforms compose in double precision and round once") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["translation"] = {-16777216.5, 0, 0};
  builder.json["nodes"].push_back({{"children", {0}}, {"translation", {16777217.25, 0, 0}}});
  CHECK(v0(load(builder).triangles.at(0)) == Corner{0.75F, 0, 0});
}

TEST_CASE("without a transform coordinates stay as they are, a negative zero too") {
  GltfBuilder builder;
  builder.add_mesh(
      {{"attributes", {{"POSITION", builder.add_positions({-0.0F, 0, 0, 0.1F, 0, 0, 0, 1e-30F, 0})}}}});
  const Triangle t = load(builder).triangles.at(0);
  CHECK(std::signbit(t.v0[0]));
  CHECK(t.v1[0] == 0.1F);
  CHECK(t.v2[1] == 1e-30F);
}

TEST_CASE("a node with negative determinant keeps its faces outwards") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Triangle mirrored = load(builder).triangles.at(0);
  CHECK(normal_z(mirrored) > 0);
  CHECK(v0(mirrored) == Corner{0, 0, 0});
  builder.json["nodes"][0]["scale"] = {-1, -1, 1};  // twice mirrored is turned
  CHECK(normal_z(load(builder).triangles.at(0)) > 0);
}

TEST_CASE("a vertex that two primitives of a node share has the same bits in both") {
  GltfBuilder builder = one_triangle();
  const int other = builder.add_positions({0.3F, 0.7F, 0.1F, 1, 0, 0, 5, 1, 2});
  builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", other}}}});
  builder.json["nodes"][0]["rotation"] = {0.1, 0.2, 0.3, 0.9};
  builder.json["nodes"][0]["translation"] = {0.1, 1e3, -7};
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 2);
  CHECK(v1(scene.triangles[0]) == v1(scene.triangles[1]));
}

TEST_CASE("a mesh that two nodes show is there twice") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 2);
  CHECK(v0(scene.triangles[1]) == Corner{0, 0, 1});
}

TEST_CASE("indices of 8, 16 and 32 bits mean the same") {
  const auto with = [](auto indices) {
    GltfBuilder builder;
    const int positions = builder.add_positions({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int accessor = builder.add_indices(indices);
    builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}});
    return load(builder).triangles.at(0);
  };
  for (const Triangle& t :
       {with(std::vector<std::uint8_t>{1, 2, 3}), with(std::vector<std::uint16_t>{1, 2, 3}),
        with(std::vector<std::uint32_t>{1, 2, 3})}) {
    CHECK(v0(t) == Corner{0, 0, 0});
    CHECK(v1(t) == Corner{1, 0, 0});
    CHECK(v2(t) == Corner{0, 1, 0});
  }
}

TEST_CASE("a strip's triangles all face the same way") {
  const Scene scene = load(zigzag(5));
  REQUIRE(scene.triangles.size() == 3);
  for (const Triangle& t : scene.triangles) CHECK(normal_z(t) > 0);
  CHECK(v0(scene.triangles[1]) == Corner{1, 0, 0});
}

TEST_CASE("a strip may repeat a vertex to jump: that is no faulty triangle") {
  GltfBuilder builder = zigzag(5);
  builder.primitive()["indices"] = builder.add_indices(std::vector<std::uint8_t>{0, 1, 2, 2, 3, 3, 4, 1});
  const Scene scene = load(builder, kReject);
  CHECK(scene.triangles.size() == 2);
  CHECK(scene.report.dropped() == 0);
}

TEST_CASE("a fan turns around its first vertex") {
  GltfBuilder builder;
  const int positions = builder.add_positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  builder.add_mesh({{"attributes", {{"POSITION", positions}}}, {"mode", 6}});
  const Scene scene = load(builder);
  REQUIRE(scene.triangles.size() == 2);
  for (const Triangle& t : scene.triangles) {
    CHECK(v2(t) == Corner{0, 0, 0});
    CHECK(normal_z(t) > 0);
  }
}

TEST_CASE("points, lines and primitives without positions are skipped and counted") {
  GltfBuilder builder = one_triangle();
  const int positions = builder.primitive()["attributes"]["POSITION"];
  for (const int mode : {0, 1, 2, 3}) {
    builder.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
  }
  builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"NORMAL", positions}}}});
  const Scene scene = load(builder);
  CHECK(scene.triangles.size() == 1);
  CHECK(scene.report.primitives_skipped == 5);
}

TEST_CASE("an incomplete last triangle is left out with a note") {
  const Scene scene = load(zigzag(4));
  CHECK(scene.triangles.size() == 1);
  REQUIRE(scene.report.notes.size() == 1);
  CHECK_THAT(scene.report.notes[0], Contains("mesh 0 \"Body\", primitive 0") && Contains("5 corners"));
}

TEST_CASE("the default scene is read, else the first, else every root node") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
  builder.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 2}}});
  CHECK(load(builder).triangles.size() == 3);
  builder.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1}}, {"name", "Main"}}};
  const Scene first = load(builder);
  REQUIRE(first.triangles.size() == 1);
  CHECK(v0(first.triangles[0]) == Corner{0, 0, 2});
  builder.json["scene"] = 1;
  const Scene chosen = load(builder);
  CHECK(chosen.triangles.size() == 2);
  REQUIRE(chosen.report.notes.size() == 1);
  CHECK(chosen.report.notes[0] == "Only scene 1 \"Main\" of 2 was read.");
}

TEST_CASE("a hierarchy 200000 nodes deep loads") {
  GltfBuilder builder = one_triangle();
  Json& nodes = builder.json["nodes"];
  constexpr int kDepth = 200000;
  nodes[0] = {{"children", {1}}};
  for (int i = 1; i < kDepth; ++i) nodes.push_back({{"translation", {0, 0, 1}}, {"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  CHECK(v0(load(builder).triangles.at(0)) == Corner{0, 0, kDepth - 1});
}

TEST_CASE("a skinned or morphed mesh is read in its basic shape, with a note") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["meshes"][0]["weights"] = {0.5};
  const Scene scene = load(builder);
  CHECK(scene.triangles.size() == 1);
  REQUIRE(scene.report.notes.size() == 2);
  CHECK_THAT(scene.report.notes[0], Contains("Morph"));
  CHECK_THAT(scene.report.notes[1], Contains("Skins"));
}

TEST_CASE("images, textures, animations and extras are not looked at, however broken") {
  GltfBuilder builder = one_triangle();
  builder.json["images"] = {{{"uri", "no/such/file.png"}}, {{"uri", "/"}}, {{"bufferView", 99}}, 7};
  builder.json["textures"] = "none";
  builder.json["animations"] = {{{"channels", 3}}};
  builder.json["skins"] = {{{"joints", "x"}}};
  builder.json["extras"] = {{"deep", {{{"deeper", {1, 2, {3}}}}}}};
  CHECK(load(builder).triangles.size() == 1);
}
