// Broken containers, broken JSON, graphs that are no trees, and extensions: each a clear error, none a crash.
#include <catch2/catch.hpp>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

std::string bytes_error(const Bytes& bytes) {
  return error_of([&] { return load(bytes); });
}

}  // namespace

TEST_CASE("a cycle of nodes is an error that names one of them, whether a scene shows it or not") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"].push_back({{"children", {2}}});
  builder.json["nodes"].push_back({{"children", {3}}, {"name", "Loop"}});
  builder.json["nodes"].push_back({{"children", {1}}});
  CHECK_THAT(load_error(builder), StartsWith("kBadScene: node") && Contains("is its own ancestor"));
  builder.json["scenes"] = {{{"nodes", {0}}}};
  CHECK_THAT(load_error(builder), Contains("the nodes form a cycle"));
  builder.json["nodes"][2] = Json::object();
  builder.json["nodes"][3] = {{"children", {3}}};
  CHECK_THAT(load_error(builder), Contains("node 3 is its own ancestor"));
}

TEST_CASE("a node with two parents is an error that names all three") {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"].push_back({{"children", {0}}, {"name", "Left"}});
  builder.json["nodes"].push_back({{"children", {0}}, {"name", "Right"}});
  CHECK_THAT(load_error(builder),
             Contains("node 0 is listed as a child twice, by node 1 \"Left\" and node 2 \"Right\""));
}

TEST_CASE("node and scene indices that do not exist are errors that name their place") {
  GltfBuilder builder = one_triangle();
  SECTION("child") {
    builder.json["nodes"][0]["children"] = {4};
    CHECK_THAT(load_error(builder), Contains("node 0: node 4 does not exist, there are 1"));
  }
  SECTION("root") {
    builder.json["scenes"] = {{{"nodes", {0, 9}}, {"name", "Main"}}};
    CHECK_THAT(load_error(builder), Contains("scene 0 \"Main\": node 9 does not exist, there are 1"));
  }
  SECTION("root listed twice") {
    builder.json["scenes"] = {{{"nodes", {0, 0}}}};
    CHECK_THAT(load_error(builder), Contains("scene 0 lists node 0 twice"));
  }
  SECTION("root that has a parent") {
    builder.json["nodes"].push_back({{"children", {0}}});
    builder.json["scenes"] = {{{"nodes", {0}}}};
    CHECK_THAT(load_error(builder), Contains("scene 0 lists node 0, which is no root node"));
  }
  SECTION("default scene") {
    builder.json["scene"] = 2;
    CHECK_THAT(load_error(builder), Contains("the default scene 2 does not exist, there are 0"));
  }
}

TEST_CASE("a transform that is none is an error that names its node") {
  GltfBuilder builder = one_triangle();
  Json& node = builder.json["nodes"][0];
  SECTION("projective matrix") {
    node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 1};
    CHECK_THAT(load_error(builder), Contains("node 0: its matrix must end in the row 0 0 0 1"));
  }
  SECTION("rotation of length zero") {
    node["rotation"] = {0, 0, 0, 0};
    CHECK_THAT(load_error(builder), Contains("node 0: its rotation has no direction"));
  }
  SECTION("too few numbers") {
    node["translation"] = {1, 2};
    CHECK_THAT(load_error(builder), Contains("nodes[0].translation must be an array of 3 numbers"));
  }
}

TEST_CASE("members of the wrong type or range are errors that name their path") {
  GltfBuilder builder = one_triangle();
  SECTION("a negative offset, which tinygltf would read as zero") {
    builder.json["accessors"][0]["byteOffset"] = -4;
    CHECK_THAT(load_error(builder),
               Contains("accessors[0].byteOffset must be a whole number from 0 to 2^53"));
  }
  SECTION("an index that would wrap to zero in 32 bits") {
    builder.json["nodes"][0]["mesh"] = 1ULL << 32U;
    CHECK_THAT(load_error(builder), Contains("nodes[0].mesh must be a whole number from 0 to 2147483647"));
  }
  SECTION("a text for a number") {
    builder.json["bufferViews"][0]["byteLength"] = "36";
    CHECK_THAT(load_error(builder), Contains("bufferViews[0].byteLength must be a whole number"));
  }
  SECTION("a missing member") {
    builder.json["accessors"][0].erase("count");
    CHECK_THAT(load_error(builder), Contains("accessors[0].count is missing"));
  }
  SECTION("a primitive without attributes, which tinygltf would drop in silence") {
    builder.primitive().erase("attributes");
    CHECK_THAT(load_error(builder), Contains("meshes[0].primitives[0].attributes is missing"));
  }
  SECTION("an array that is none") {
    builder.json["nodes"] = 7;
    CHECK_THAT(load_error(builder), Contains("nodes must be a JSON array"));
  }
  SECTION("an element that is no object") {
    builder.json["meshes"].push_back(nullptr);
    CHECK_THAT(load_error(builder), Contains("meshes[1] must be a JSON object"));
  }
  SECTION("half a sparse accessor") {
    builder.json["accessors"][0]["sparse"] = {{"count", 1}, {"values", {{"bufferView", 0}}}};
    CHECK_THAT(load_error(builder), Contains("accessors[0].sparse needs both \"indices\" and \"values\""));
  }
}

TEST_CASE("a document of another kind or version says so") {
  GltfBuilder builder = one_triangle();
  builder.json["asset"]["version"] = "1.0";
  CHECK_THAT(load_error(builder), Contains("glTF version \"1.0\"; export it as glTF 2.0"));
  CHECK_THAT(error_of([] { return load(std::string("{\"a\": 1}")); }),
             Contains("it has no \"asset\" object"));
  CHECK_THAT(error_of([] { return load(std::string("[1, 2]")); }), Contains("it is no JSON object"));
  CHECK_THAT(error_of([] { return load(std::string("{\"asset\": ")); }),
             StartsWith("kBadScene: is neither glTF nor GLB: parse error at line 1"));
  CHECK_THAT(error_of([] { return load(std::string()); }), StartsWith("kBadScene"));
}

TEST_CASE("JSON nested a million deep is parsed or refused without recursion") {
  const std::string deep(1000000, '[');
  CHECK_THAT(error_of([&] { return load("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep); }),
             StartsWith("kBadScene: is neither glTF nor GLB"));
  const std::string closed = deep + std::string(1000000, ']');
  CHECK_THAT(error_of([&] { return load("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + closed + "}"); }),
             Contains("contains no triangles"));
}

TEST_CASE("a document without triangles says so, and what was left out") {
  GltfBuilder builder = one_triangle();
  builder.primitive()["mode"] = 1;
  CHECK(load_error(builder) ==
        "kBadScene: contains no triangles (left out: 1 primitives that are not triangles)");
  CHECK(error_of([] { return load(std::string(R"({"asset": {"version": "2.0"}})")); }) ==
        "kBadScene: contains no triangles");
}

TEST_CASE("a GLB that ends early or lies about its chunks is an error at every length") {
  const Bytes whole = one_triangle().glb();
  for (std::size_t length = 4; length < whole.size(); ++length) {
    INFO("first " << length << " of " << whole.size() << " bytes");
    CHECK_THAT(bytes_error(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))),
               StartsWith("kBadScene: this .glb is cut short"));
  }
  Bytes changed = whole;
  changed[4] = 1;
  CHECK_THAT(bytes_error(changed), Contains("this .glb is of version 1"));
  changed = whole;
  changed[16] = 'X';
  CHECK_THAT(bytes_error(changed), Contains("must have exactly one JSON chunk"));
  changed = whole;
  changed[15] = 0x7F;
  CHECK_THAT(bytes_error(changed), Contains("chunk 0 reaches past its end"));
  changed = whole;
  changed[9] = 0xFF;
  CHECK_THAT(bytes_error(changed), Contains("cut short: its header states"));
}

TEST_CASE("bytes after the length a GLB states, and chunks of other types, are ignored") {
  Bytes glb = one_triangle().glb();
  glb.insert(glb.end(), {4, 0, 0, 0, 'X', 'Y', 'Z', 'W', 1, 2, 3, 4});
  CHECK(load(glb).triangles.size() == 1);  // not counted in
  const std::size_t length = glb.size();
  for (unsigned i = 0; i < 4; ++i) glb[8 + i] = static_cast<unsigned char>(length >> 8U * i);
  CHECK(load(glb).triangles.size() == 1);  // counted in
}

TEST_CASE("a buffer without uri needs the GLB's binary part") {
  GltfBuilder builder = one_triangle();
  builder.json["buffers"] = {{{"byteLength", 36}}};
  CHECK_THAT(load_error(builder), Contains("buffer 0 has no uri and the file no binary part for it"));
  builder.json["buffers"][0]["uri"] = "https://example.org/mesh.bin";
  CHECK_THAT(load_error(builder),
             Contains("buffer 0 is at the address \"https://example.org/mesh.bin\"; download it"));
}

TEST_CASE("a required extension that is not supported is named, with a remedy") {
  GltfBuilder builder = one_triangle();
  const auto required = [&builder](const char* name) {
    builder.json["extensionsRequired"] = {"KHR_mesh_quantization", name};
    return load_error(builder);
  };
  CHECK_THAT(required("KHR_draco_mesh_compression"),
             StartsWith("kBadScene: needs the glTF extension \"KHR_draco_mesh_compression\"") &&
                 Contains("gltf-transform cp"));
  CHECK_THAT(required("EXT_meshopt_compression"), Contains("gltf-transform cp"));
  CHECK_THAT(required("EXT_mesh_gpu_instancing"), Contains("one node per instance"));
  CHECK_THAT(required("ACME_geometry"),
             Contains("\"ACME_geometry\"") && EndsWith("export it without this extension"));
  for (const char* const name :
       {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform",
        "KHR_materials_unlit", "EXT_texture_webp", "KHR_texture_basisu"}) {
    INFO(name);
    CHECK(required(name) == "no error");
  }
  builder.json["extensionsRequired"] = {3};
  CHECK_THAT(load_error(builder), Contains("extensionsRequired must hold texts only"));
}

TEST_CASE("geometry that only Draco has is an error even where Draco is not required") {
  GltfBuilder builder = one_triangle();
  builder.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                     {"attributes", {{"POSITION", 0}}}};
  CHECK(load(builder).triangles.size() == 1);  // with the fallback
  builder.json["accessors"][0].erase("bufferView");
  CHECK_THAT(load_error(builder), Contains("mesh 0 \"Body\", primitive 0 is compressed with Draco"));
}

TEST_CASE("instancing that is used but not required leaves a note") {
  GltfBuilder builder = one_triangle();
  builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  const auto scene = load(builder);
  REQUIRE(scene.report.notes.size() == 1);
  CHECK_THAT(scene.report.notes[0], Contains("EXT_mesh_gpu_instancing"));
}

TEST_CASE("a name from the file cannot disturb a terminal or flood a message") {
  GltfBuilder builder = one_triangle();
  builder.json["meshes"][0]["name"] = "evil\x1b[2J\n" + std::string(1000, 'x');
  builder.primitive()["mode"] = 9;
  const std::string message = load_error(builder);
  CHECK_THAT(message, Contains("\"evil?[2J?xxx") && Contains("xxx...\", primitive 0"));
  CHECK(message.size() < 250);
}
