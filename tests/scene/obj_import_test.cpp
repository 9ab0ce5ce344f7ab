// OBJ files: vertices, faces, polygons, materials, and what is wrong with them.
#include <catch2/catch.hpp>
#include <cmath>

#include "gltf_builder.h"
#include "gnomon/scene/obj_reader.h"

using namespace gnomon_test;
using Catch::Contains;
using Catch::StartsWith;
using gnomon::Scene;
using gnomon::Triangle;
using gnomon::Vec3;

namespace {

constexpr const char* kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene load_obj(const std::string& text, const gnomon::ImportOptions& options = {}) {
  return gnomon::import_obj_bytes({text.begin(), text.end()}, {}, options);
}

std::string obj_error(const std::string& text, const gnomon::ImportOptions& options = {}) {
  return error_of([&] { return load_obj(text, options); });
}

double signed_area(const Triangle& t) {
  return 0.5 * ((static_cast<double>(t.v1[0]) - t.v0[0]) * (static_cast<double>(t.v2[1]) - t.v0[1]) -
                (static_cast<double>(t.v1[1]) - t.v0[1]) * (static_cast<double>(t.v2[0]) - t.v0[0]));
}

}  // namespace

TEST_CASE("faces name vertices from 1, or back from the last one so far") {
  const Scene scene = load_obj(std::string(kSquare) + "f 1 2 3\nf -4 -2 -1\nv 5 5 5\nf -1 1 2\n");
  REQUIRE(scene.triangles.size() == 3);
  CHECK(scene.triangles[0].v2[1] == 1);
  CHECK(scene.triangles[1].v0[0] == 0);
  CHECK(scene.triangles[1].v1[0] == 1);
  CHECK(scene.triangles[2].v0[0] == 5);
}

TEST_CASE("normals, texture coordinates, colors and weights beside the positions are passed over") {
  const Scene scene =
      load_obj("v 0 0 0 1 0.5 0.25\nv 1 0 0 1.0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns off\nf 1/1/1 2//1 3/1\n");
  CHECK(scene.triangles.size() == 1);
}

TEST_CASE("numbers are read to the last bit, with a plus sign or an exponent") {
  const Scene scene = load_obj("v 0.1 +2.5e-3 16777217\nv 3.4028235e-38 -0 1e-60\nv 0 1 0\nf 1 2 3\n");
  const Triangle& t = scene.triangles.at(0);
  CHECK(t.v0[0] == 0.1F);
  CHECK(t.v0[1] == 2.5e-3F);
  CHECK(t.v0[2] == 16777216.0F);
  CHECK(t.v1[0] == 3.4028235e-38F);
  CHECK(std::signbit(t.v1[1]));
  CHECK(t.v1[2] == 0);
}

TEST_CASE("faces may come before their vertices") {
  CHECK(load_obj("f 1 2 3\n" + std::string(kSquare)).triangles.size() == 1);
}

TEST_CASE("line ends of every system and lines continued by a backslash are understood") {
  CHECK(load_obj("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n").triangles.size() == 1);
  CHECK(load_obj("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3").triangles.size() == 1);
  CHECK(load_obj("v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\  \r\n 2 3").triangles.size() == 1);
  // The line number counts the continued ones; a comment never continues.
  CHECK_THAT(obj_error("# C:\\\nv 0 \\\n0 0\nv 1 0 0\nf 1 2 9\n"), Contains("line 5: a face uses vertex 9"));
}

TEST_CASE("a convex polygon of n corners gives n - 2 triangles that face its way") {
  const Scene scene = load_obj(std::string(kSquare) + "v 0.5 2 0\nf 1 2 3 5 4\n");
  REQUIRE(scene.triangles.size() == 3);
  double area = 0.0;
  for (const Triangle& t : scene.triangles) {
    CHECK(signed_area(t) > 0);
    area += signed_area(t);
  }
  CHECK(area == Approx(1.5));
}

TEST_CASE("a face of two corners, lines and points are skipped and counted") {
  const Scene scene = load_obj(std::string(kSquare) + "f 1 2\nl 1 2 3\n  p 1\nf 1 2 3\n");
  CHECK(scene.triangles.size() == 1);
  CHECK(scene.report.primitives_skipped == 3);
}

TEST_CASE("vertex numbers that do not exist are errors that name the line") {
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 2 5\n"),
             StartsWith("kBadScene: line 5: a face uses vertex 5, and there are 4"));
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 2 -5\n"), Contains("line 5: a face needs vertex numbers"));
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 2 0\n"), Contains("line 5"));
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 two 3\n"),
             Contains("line 5") && Contains("\"f 1 two 3\""));
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 2 3 9\n"), Contains("line 5: a face uses vertex 9"));
}

TEST_CASE("a vertex that is no three numbers is an error that names the line") {
  CHECK_THAT(obj_error("v 0 0\n"), Contains("line 1: a vertex needs three numbers") && Contains("\"v 0 0\""));
  CHECK_THAT(obj_error("\nv 0 x 1\n"), Contains("line 2"));
  CHECK_THAT(obj_error("v 0 1,5 1\n"), Contains("line 1"));
}

TEST_CASE("an OBJ vertex that is NaN, infinite or too large makes its triangles invalid") {
  for (const char* const bad : {"nan", "-NaN", "inf", "1.#QNAN", "-nan(ind)", "1e39", "3e14"}) {
    INFO(bad);
    const std::string text = std::string(kSquare) + "v 2 " + bad + " 0\nf 1 2 3\nf 1 2 5\n";
    const Scene scene = load_obj(text);
    CHECK(scene.triangles.size() == 1);
    CHECK(scene.report.non_finite_dropped == 1);
    CHECK_THAT(obj_error(text, kReject), StartsWith("kBadScene: line 7: a triangle of shape"));
  }
}

TEST_CASE("OBJ triangles without area are dropped and counted, or rejected by line") {
  const std::string text = std::string(kSquare) + "g wall\nf 1 2 3\nf 1 1 2\n";
  CHECK(load_obj(text).report.zero_area_dropped == 1);
  CHECK_THAT(obj_error(text, kReject), Contains("line 7: a triangle of shape \"wall\" has no area"));
}

TEST_CASE("a file without faces says so") {
  CHECK(obj_error(kSquare) == "kBadScene: contains no triangles");
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 1 1\n"), Contains("left out: 1 triangles of zero area"));
}

TEST_CASE("OBJ triangles above max_triangles are refused") {
  gnomon::ImportOptions options;
  options.max_triangles = 2;
  CHECK(load_obj(std::string(kSquare) + "f 1 2 3 4\n", options).triangles.size() == 2);
  CHECK_THAT(obj_error(std::string(kSquare) + "f 1 2 3 4\nf 1 2 3\n", options), Contains("limit of 2"));
}

TEST_CASE("materials are found beside the OBJ and give color, emission and roughness") {
  const TemporaryFolder folder;
  folder.write("my paint.mtl",
               std::string("newmtl red\nKd 0.5 0.25 2\nPr 0.125\nnewmtl lamp\nKe 3 2 1\nKd 1 1 1\n"));
  const auto file = folder.write(
      "room.obj",
      "mtllib my paint.mtl\n" + std::string(kSquare) +
          "o a\nusemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\nf 4 3 2\no b\nf 1 2 4\nusemtl red\nf 2 3 4\n");
  const Scene scene = gnomon::import_obj(file);
  CHECK(scene.name == "room");
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].name == "red");
  CHECK(scene.materials[0].base_color == Vec3{0.5F, 0.25F, 1});
  CHECK(scene.materials[0].roughness == 0.125F);
  CHECK(scene.materials[1].roughness == 1);
  CHECK(scene.material_ids == std::vector<std::uint32_t>{0, 1, 1, 1, 0});
  CHECK(scene.report.notes.empty());
  REQUIRE(scene.lights.size() == 2);  // one per shape
  CHECK(scene.lights[0].kind == gnomon::LightKind::kArea);
  CHECK(scene.lights[0].name == "lamp");
  CHECK(scene.lights[0].color == Vec3{3, 2, 1});
  CHECK(scene.lights[0].triangles == std::vector<std::uint32_t>{1, 2});
  CHECK(scene.lights[1].triangles == std::vector<std::uint32_t>{3});
}

TEST_CASE("several material files on a line are all read") {
  const TemporaryFolder folder;
  folder.write("a.mtl", std::string("newmtl a\nKd 1 0 0\n"));
  folder.write("b.mtl", std::string("newmtl b\nKd 0 1 0\n"));
  const auto file =
      folder.write("x.obj", "mtllib a.mtl b.mtl\nusemtl b\n" + std::string(kSquare) + "f 1 2 3\n");
  const Scene scene = gnomon::import_obj(file);
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[scene.material_ids.at(0)].name == "b");
}

TEST_CASE("a missing material file and an unknown material are only notes, one each") {
  const Scene scene = load_obj("mtllib none.mtl\nmtllib none.mtl\nusemtl x\n" + std::string(kSquare) +
                               "f 1 2 3\nusemtl x\nf 1 3 4\n");
  CHECK(scene.triangles.size() == 2);
  CHECK(scene.materials.size() == 1);
  REQUIRE(scene.report.notes.size() == 2);
  CHECK_THAT(scene.report.notes[0], Contains("\"none.mtl\" (line 1) cannot be read"));
  CHECK_THAT(scene.report.notes[1], Contains("\"x\" (line 3) is not defined"));
}
