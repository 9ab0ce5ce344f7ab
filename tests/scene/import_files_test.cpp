// Files on disk: telling formats apart, buffers beside a .gltf, missing files, and real scenes where there
// are any.
#include <catch2/catch.hpp>
#include <utility>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using Catch::StartsWith;
using gnomon::import_scene;
using gnomon::Scene;

namespace {

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// The triangle with its buffer in a file of the given uri.
std::string with_external_buffer(const std::string& uri) {
  GltfBuilder builder = one_triangle();
  builder.json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", uri}}};
  return builder.text();
}

std::string import_error(const std::filesystem::path& file) {
  return error_of([&] { return import_scene(file); });
}

}  // namespace

TEST_CASE("formats are told apart by content first and extension second") {
  const TemporaryFolder folder;
  const GltfBuilder builder = one_triangle();
  CHECK(import_scene(folder.write("a.gltf", builder.text())).triangles.size() == 1);
  CHECK(import_scene(folder.write("b.obj", "\xEF\xBB\xBF \n" + builder.text())).triangles.size() == 1);
  CHECK(import_scene(folder.write("c.gltf", builder.glb())).triangles.size() == 1);
  CHECK(import_scene(folder.write("d.bin", builder.glb())).triangles.size() == 1);
  CHECK(import_scene(folder.write("e.OBJ", std::string(kObj))).triangles.size() == 1);
  CHECK_THAT(import_error(folder.write("f.txt", std::string(kObj))),
             StartsWith("kBadScene") && Contains("f.txt: not a scene; it should be .gltf, .glb or .obj"));
  CHECK_THAT(import_error(folder.write("g.glb", std::string(kObj))),
             Contains("g.glb: is neither glTF nor GLB"));
  CHECK_THAT(import_error(folder.write("h.glb", std::string())), StartsWith("kBadScene"));
}

TEST_CASE("a scene is named after its file") {
  const TemporaryFolder folder;
  CHECK(import_scene(folder.write("my room.v2.glb", one_triangle().glb())).name == "my room.v2");
}

TEST_CASE("a file that cannot be opened is kIo and says why") {
  const TemporaryFolder folder;
  for (const char* const name : {"none.glb", "none.obj", "none"}) {
    CHECK_THAT(import_error(folder.path() / name),
               StartsWith("kIo: cannot read") && Contains("no such file"));
  }
  CHECK_THAT(import_error(folder.path()), StartsWith("kIo") && Contains("it is a folder"));
  CHECK_THAT(import_error("/dev/zero"), StartsWith("kIo") && Contains("not a regular file"));
  CHECK_THAT(error_of([&] { return gnomon::import_obj(folder.path() / "x.obj"); }), StartsWith("kIo"));
  CHECK_THAT(error_of([&] { return gnomon::import_gltf(folder.path() / "x.glb"); }), StartsWith("kIo"));
}

TEST_CASE(
    "a buffer file is found beside the .gltf, also with escapes in its name and more bytes than needed") {
  const TemporaryFolder folder;
  Bytes data = one_triangle().binary;
  data.resize(data.size() + 100);
  folder.write("my mesh+1.bin", data);
  CHECK(import_scene(folder.write("a.gltf", with_external_buffer("my%20mesh+1.bin"))).triangles.size() == 1);
}

TEST_CASE("a missing buffer file is kIo; one that is too short or no file is named as well") {
  const TemporaryFolder folder;
  CHECK_THAT(
      import_error(folder.write("a.gltf", with_external_buffer("mesh.bin"))),
      StartsWith("kIo") && Contains("a.gltf: cannot read") && Contains("mesh.bin: there is no such file"));
  CHECK_THAT(import_error(folder.write("b.gltf", with_external_buffer("/dev/zero"))),
             StartsWith("kIo") && Contains("/dev/zero: it is not a regular file"));
  folder.write("short.bin", std::string("0123456789"));
  CHECK_THAT(import_error(folder.write("c.gltf", with_external_buffer("short.bin"))),
             StartsWith("kBadScene") && Contains("buffer 0 should have 36 bytes and has 10"));
}

TEST_CASE("real scenes load, where this checkout has them beside it") {
  const std::filesystem::path shared = GNOMON_SHARED_FOLDER;
  // Triangle counts as their own index accessors state them.
  const std::vector<std::pair<const char*, std::size_t>> scenes{{"gltf/CesiumMan.glb", 4672},
                                                                {"gltf/retroufo.glb", 16428},
                                                                {"gltf/balloon/scene.gltf", 35698},
                                                                {"thesis/scenes/woods.glb", 7058},
                                                                {"thesis/scenes/cottage.glb", 4281},
                                                                {"thesis/scenes/suzanne.glb", 967},
                                                                {"thesis/scenes/cottage-walls.glb", 5817}};
  for (const auto& [name, triangles] : scenes) {
    if (!std::filesystem::exists(shared / name)) continue;
    INFO(name);
    const Scene scene = import_scene(shared / name);
    CHECK(scene.triangles.size() + scene.report.dropped() == triangles);
  }
}
