// How the bytes of a glTF buffer become coordinates and indices, and every way they can be out of place.
#include <catch2/catch.hpp>
#include <limits>

#include "gltf_builder.h"

using namespace gnomon_test;
using Catch::Contains;
using Catch::StartsWith;
using gnomon::Scene;
using gnomon::Triangle;

namespace {

constexpr const char* kPlace = "mesh 0 \"Body\", primitive 0";

// A mesh whose POSITION is the given accessor.
GltfBuilder with_positions(GltfBuilder builder, const Json& accessor) {
  builder.add_mesh({{"attributes", {{"POSITION", builder.add_accessor(accessor)}}}});
  return builder;
}

// A document with one indexed triangle whose index accessor can be changed: accessor 1, buffer view 1.
GltfBuilder indexed() {
  GltfBuilder builder = one_triangle();
  builder.primitive()["indices"] = builder.add_indices(std::vector<std::uint16_t>{0, 1, 2});
  return builder;
}

template <typename T>
Triangle quantized(const std::vector<T>& values, int type, bool is_normalized) {
  GltfBuilder builder;
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  // Padded to a stride of a multiple of four, as the extension demands.
  const int stride = sizeof(T) == 1 ? 4 : 8;
  const Json accessor = {{"bufferView", builder.add_view(values, stride)},
                         {"componentType", type},
                         {"normalized", is_normalized},
                         {"count", 3},
                         {"type", "VEC3"}};
  return load(with_positions(builder, accessor)).triangles.at(0);
}

}  // namespace

TEST_CASE("interleaved vertices are read at their stride and offset") {
  GltfBuilder builder;
  const std::vector<float> data{9, 9, 0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0};
  const int view = builder.add_view(data, 20);
  const Scene scene = load(with_positions(
      builder,
      {{"bufferView", view}, {"byteOffset", 8}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}}));
  const Triangle& t = scene.triangles.at(0);
  CHECK(t.v0[0] == 0);
  CHECK(t.v1[0] == 1);
  CHECK(t.v2[1] == 1);
}

TEST_CASE("KHR_mesh_quantization: integers are plain numbers unless normalized") {
  const Triangle plain = quantized<std::int16_t>({0, 0, 0, 0, 300, -2, 5, 0, 0, 400, 7, 0}, kShort, false);
  CHECK(plain.v1[0] == 300);
  CHECK(plain.v1[1] == -2);
  CHECK(plain.v2[1] == 400);
  const Triangle bytes = quantized<std::int8_t>({0, 0, 0, 0, 127, -128, -127, 0, 0, 1, 0, 0}, kByte, true);
  CHECK(bytes.v1[0] == 1);
  CHECK(bytes.v1[1] == -1);
  CHECK(bytes.v1[2] == -1);
  CHECK(bytes.v2[1] == static_cast<float>(1.0 / 127.0));
  const Triangle ubytes =
      quantized<std::uint8_t>({0, 0, 0, 0, 255, 0, 51, 0, 0, 255, 0, 0}, kUnsignedByte, true);
  CHECK(ubytes.v1[0] == 1);
  CHECK(ubytes.v1[2] == 0.2F);
  const Triangle ushorts =
      quantized<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 0, 13107, 0, 0}, kUnsignedShort, true);
  CHECK(ushorts.v1[0] == 1);
  CHECK(ushorts.v2[1] == 0.2F);
  const Triangle shorts =
      quantized<std::int16_t>({0, 0, 0, 0, 32767, -32768, 0, 0, 0, 1, 0, 0}, kShort, true);
  CHECK(shorts.v1[0] == 1);
  CHECK(shorts.v1[1] == -1);
}

TEST_CASE("a sparse accessor overrides some elements of its buffer view") {
  GltfBuilder builder = one_triangle();
  const int indices = builder.add_view(std::vector<std::uint8_t>{0, 2});
  const int values = builder.add_view(std::vector<float>{5, 5, 5, 0, 7, 0});
  builder.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
      {"values", {{"bufferView", values}}}};
  const Triangle t = load(builder).triangles.at(0);
  CHECK(t.v0[0] == 5);
  CHECK(t.v1[0] == 1);
  CHECK(t.v2[1] == 7);
}

TEST_CASE("a sparse accessor without a buffer view overrides zeros") {
  GltfBuilder builder;
  const int indices = builder.add_view(std::vector<std::uint16_t>{1, 2});
  const int values = builder.add_view(std::vector<float>{1, 0, 0, 0, 1, 0});
  const Scene scene = load(
      with_positions(builder, {{"componentType", kFloat},
                               {"count", 3},
                               {"type", "VEC3"},
                               {"sparse",
                                {{"count", 2},
                                 {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                                 {"values", {{"bufferView", values}}}}}}));
  const Triangle& t = scene.triangles.at(0);
  CHECK(t.v0[0] == 0);
  CHECK(t.v1[0] == 1);
  CHECK(t.v2[1] == 1);
}

TEST_CASE("sparse indices apply to index accessors as well") {
  GltfBuilder builder = indexed();
  builder.json["accessors"][1]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", builder.add_view(std::vector<std::uint32_t>{0})}, {"componentType", kUnsignedInt}}},
      {"values", {{"bufferView", builder.add_view(std::vector<std::uint16_t>{2})}}}};
  CHECK_THAT(load_error(builder), Contains("1 triangles of zero area"));  // 2 1 2
}

TEST_CASE("an accessor without data is zeros: its triangles have no area") {
  const GltfBuilder builder = with_positions({}, {{"componentType", kFloat}, {"count", 6}, {"type", "VEC3"}});
  CHECK_THAT(load_error(builder),
             StartsWith("kBadScene: contains no triangles") && Contains("2 triangles of zero area"));
}

TEST_CASE("four thousand million vertices without data are refused, not made") {
  const Json accessor = {{"componentType", kFloat}, {"count", 4000000000U}, {"type", "VEC3"}};
  CHECK_THAT(load_error(with_positions({}, accessor)),
             Contains(kPlace) && Contains("accessor 0 claims 4000000000 elements without any data"));
}

TEST_CASE("more triangles than max_triangles are refused before they are made") {
  GltfBuilder builder = one_triangle();
  for (int i = 0; i < 4; ++i) builder.json["nodes"].push_back({{"mesh", 0}});
  gnomon::ImportOptions options;
  options.max_triangles = 5;
  CHECK(load(builder, options).triangles.size() == 5);
  options.max_triangles = 4;
  CHECK_THAT(load_error(builder, options), Contains("more triangles than the limit of 4"));
}

TEST_CASE("a range that leaves its buffer is an error that names it") {
  GltfBuilder builder = indexed();
  SECTION("a view longer than its buffer") {
    builder.json["bufferViews"][0]["byteLength"] = 1000;
    CHECK_THAT(
        load_error(builder),
        Contains(kPlace) && Contains("accessor 0, buffer view 0 reaches past buffer 0, which has 42 bytes"));
  }
  SECTION("an offset past the buffer, close to overflow") {
    builder.json["bufferViews"][0]["byteOffset"] = (1ULL << 53U) - 4;
    CHECK_THAT(load_error(builder), Contains("reaches past buffer 0"));
  }
  SECTION("an accessor longer than its view") {
    builder.json["accessors"][0]["count"] = 4;
    CHECK_THAT(load_error(builder),
               Contains(kPlace) && Contains("accessor 0, buffer view 0 has 36 bytes, too few"));
  }
  SECTION("an accessor so long that its size would overflow") {
    builder.json["accessors"][0]["count"] = 1ULL << 53U;
    CHECK_THAT(load_error(builder), Contains("too few for 9007199254740992 elements every 12 bytes"));
  }
  SECTION("an accessor that starts past its view") {
    builder.json["accessors"][0]["byteOffset"] = 40;
    CHECK_THAT(load_error(builder), Contains("too few for 3 elements"));
  }
  SECTION("a stride smaller than an element") {
    builder.json["bufferViews"][0]["byteStride"] = 8;
    CHECK_THAT(load_error(builder), Contains("a stride of 8 bytes is too small for elements of 12"));
  }
  SECTION("a stride that glTF does not allow") {
    builder.json["bufferViews"][0]["byteStride"] = 13;
    CHECK_THAT(load_error(builder), Contains("bufferViews[0].byteStride must be a multiple of 4"));
  }
  SECTION("a buffer shorter than it says") {
    builder.json["buffers"] = {{{"byteLength", 100}, {"uri", "data:;base64," + base64(builder.binary)}}};
    CHECK_THAT(load_error(builder), Contains("buffer 0 should have 100 bytes and has 42"));
  }
  SECTION("a data URI that is not base64") {
    builder.json["buffers"] = {{{"byteLength", 3}, {"uri", "data:;base64,AB!D"}}};
    CHECK_THAT(load_error(builder), Contains("buffer 0 has a data URI whose character 2 is not base64"));
    builder.json["buffers"][0]["uri"] = "data:text/plain,hello";
    CHECK_THAT(load_error(builder), Contains("buffer 0 has a data URI that is not base64"));
  }
}

TEST_CASE("an index that names nothing is an error that names it") {
  GltfBuilder builder = indexed();
  SECTION("vertex") {
    builder.binary[builder.binary.size() - 2] = 3;
    CHECK_THAT(load_error(builder), Contains(kPlace) && Contains("index 2 is 3, and there are 3 vertices"));
  }
  SECTION("POSITION accessor") {
    builder.primitive()["attributes"]["POSITION"] = 17;
    CHECK_THAT(load_error(builder), Contains(kPlace) && Contains("accessor 17 does not exist, there are 2"));
  }
  SECTION("index accessor") {
    builder.primitive()["indices"] = 2;
    CHECK_THAT(load_error(builder),
               Contains("meshes[0].primitives[0].indices names accessor 2 and there are 2"));
  }
  SECTION("buffer view of positions") {
    builder.json["accessors"][0]["bufferView"] = 5;
    CHECK_THAT(load_error(builder),
               Contains(kPlace) && Contains("buffer view 5 does not exist, there are 2"));
  }
  SECTION("buffer view of indices") {
    builder.json["accessors"][1]["bufferView"] = 5;
    CHECK_THAT(load_error(builder), Contains("names accessor 1, which has no bufferView that exists"));
  }
  SECTION("buffer") {
    builder.json["bufferViews"][0]["buffer"] = 1;
    CHECK_THAT(load_error(builder), Contains("buffer 1 does not exist, there are 1"));
  }
  SECTION("mesh") {
    builder.json["nodes"][0]["mesh"] = 1;
    CHECK_THAT(load_error(builder), Contains("node 0: mesh 1 does not exist, there are 1"));
  }
  SECTION("material") {
    builder.primitive()["material"] = 0;
    CHECK_THAT(load_error(builder), Contains(kPlace) && Contains("material 0 does not exist, there are 0"));
  }
}

TEST_CASE("a wrong component type or shape is an error that names it") {
  GltfBuilder builder = indexed();
  SECTION("positions of 32 bit integers") {
    builder.json["accessors"][0]["componentType"] = kUnsignedInt;
    CHECK_THAT(load_error(builder),
               Contains(kPlace) && Contains("POSITION (accessor 0) must be VEC3 of floats"));
  }
  SECTION("positions of two numbers") {
    builder.json["accessors"][0]["type"] = "VEC2";
    CHECK_THAT(load_error(builder), Contains("POSITION (accessor 0) must be VEC3"));
  }
  SECTION("indices of floats") {
    builder.json["accessors"][1]["componentType"] = kFloat;
    CHECK_THAT(load_error(builder), Contains("indices (accessor 1) must be SCALAR of unsigned"));
  }
  SECTION("a type that does not exist") {
    builder.json["accessors"][1]["type"] = "VEC9";
    CHECK_THAT(load_error(builder), StartsWith("kBadScene: tinygltf cannot read it") && Contains("VEC9"));
  }
  SECTION("a mode that does not exist") {
    builder.primitive()["mode"] = 7;
    CHECK_THAT(load_error(builder), Contains(kPlace) && Contains("mode 7 does not exist"));
  }
}

TEST_CASE("sparse entries out of order or range are an error that names them") {
  GltfBuilder builder = one_triangle();
  const auto sparse = [&builder](const std::vector<std::uint8_t>& indices, int type) {
    builder.json["accessors"][0]["sparse"] = {
        {"count", indices.size()},
        {"indices", {{"bufferView", builder.add_view(indices)}, {"componentType", type}}},
        {"values", {{"bufferView", builder.add_view(std::vector<float>(6, 1.0F))}}}};
    return load_error(builder);
  };
  CHECK_THAT(sparse({1, 3}, kUnsignedByte), Contains(kPlace) && Contains("sparse indices: entry 1 is 3"));
  CHECK_THAT(sparse({1, 1}, kUnsignedByte), Contains("entry 1 is 1, they must ascend and stay below 3"));
  CHECK_THAT(sparse({0, 1, 2}, kUnsignedByte), Contains("sparse values, buffer view") && Contains("too few"));
  CHECK_THAT(sparse({0, 1}, kUnsignedInt), Contains("sparse indices, buffer view") && Contains("too few"));
  CHECK_THAT(sparse({0, 1}, kFloat), Contains("sparse indices must be unsigned"));
}
