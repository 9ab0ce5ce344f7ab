// Thousands of damaged scene files, the same ones on every run: each either loads as a valid scene or is
// refused with an Error. Built with address and undefined behaviour sanitizers, importers and parsers
// included, so a read one byte too far fails here. Not for what the messages say.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "file_damage.h"
#include "gltf_builder.h"
#include "gnomon/scene/obj_reader.h"
#include "gnomon/scene/triangle_check.h"

using namespace gnomon_test;

namespace {

constexpr int kRoundsPerSeed = 1500;

// A document with everything the importer reads.
GltfBuilder rich_document() {
  GltfBuilder b;
  b.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 1});
  b.add_indices(std::vector<std::uint16_t>{0, 1, 2, 3, 4});
  b.add_indices(std::vector<std::uint32_t>{0, 1, 3, 2});
  b.add_indices(std::vector<std::uint8_t>{0, 1, 2, 2, 1, 3});
  b.add_view(std::vector<std::int16_t>{0, 0, 0, 0, 900, 0, 0, 0, 0, 900, 0, 0}, 8);  // view 4
  b.add_view(std::vector<std::uint8_t>{1, 2});
  b.add_view(std::vector<float>{3, 0, 0, 0, 3, 0});
  b.add_accessor(Json::parse(
      R"({"bufferView": 4, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"})"));
  b.add_accessor(Json::parse(R"({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 2,
      "indices": {"bufferView": 5, "componentType": 5121}, "values": {"bufferView": 6, "byteOffset": 0}}})"));
  b.json.update(Json::parse(R"({
    "meshes": [
      {"name": "A", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5, "material": 1},
                                   {"attributes": {"POSITION": 0}, "indices": 2, "mode": 6, "material": 0}]},
      {"primitives": [{"attributes": {"POSITION": 0}, "indices": 3, "mode": 4, "material": 0},
                      {"attributes": {"POSITION": 4}, "material": 0}]},
      {"weights": [0.5], "primitives": [{"attributes": {"POSITION": 5}, "material": 0},
                                        {"attributes": {"POSITION": 0}, "mode": 1}]}],
    "materials": [
      {"name": "Lamp", "emissiveFactor": [1, 2, 3],
       "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
      {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "roughnessFactor": 0.5}}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 1, "znear": 0.1}}],
    "extensions": {"KHR_lights_punctual": {"lights": [
      {"type": "spot", "spot": {"outerConeAngle": 0.5}, "range": 3}, {"type": "point", "color": [1, 1, 1]}]}},
    "nodes": [
      {"children": [1, 2], "rotation": [0, 0, 0, 1], "mesh": 0},
      {"mesh": 1, "scale": [-1, 2, 1], "children": [3]},
      {"mesh": 2, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1], "skin": 0},
      {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
      {"extensions": {"KHR_lights_punctual": {"light": 1}}, "translation": [0, 1, 0]}],
    "scenes": [{"nodes": [0, 4]}],
    "scene": 0,
    "extensionsUsed": ["KHR_lights_punctual", "KHR_mesh_quantization"]})"));
  return b;
}

std::string rich_obj() {
  return "mtllib paint.mtl\n# a comment\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.4 0\nv -1e-3 +2 "
         ".5\n"
         "vn 0 0 1\nvt 0 0\nusemtl lamp\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng a b\nf 1//1 2//1 3//1 4//1 5//1\n"
         "usemtl none\nf -1 -2 \\\n-3\ns 1\nl 1 2 3\np 1\nf 1 2 3 6 5 4\n";
}

std::string rich_mtl() {
  return "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 2 3\nPr 0.25\nNs 10\nillum 2\nmap_Kd -s 1 2 3 -clamp on x.png\nd "
         "0.5\n"
         "newmtl other\nKe 0 0 0\nTr 0.5\nnorm -bm 1 n.png\n";
}

struct Tally {
  int loaded = 0;
  int refused = 0;
};

bool is_valid(const gnomon::Scene& scene) {
  bool valid = !scene.triangles.empty() && scene.material_ids.size() == scene.triangles.size();
  for (const auto& triangle : scene.triangles)
    valid &= gnomon::fault_of(triangle) == gnomon::TriangleFault::kNone;
  for (const std::uint32_t id : scene.material_ids) valid &= id < scene.materials.size();
  for (const auto& light : scene.lights) {
    for (const std::uint32_t index : light.triangles) valid &= index < scene.triangles.size();
  }
  return valid;
}

// Any exception but Error leaves the test case and fails it.
template <typename Import>
void try_import(const Import& import, Tally& tally) {
  try {
    const gnomon::Scene scene = import();
    ++tally.loaded;
    REQUIRE(is_valid(scene));
  } catch (const gnomon::Error& error) {
    ++tally.refused;
    REQUIRE(std::string(error.what()).size() > 10);
  }
}

// Both outcomes must be common: damage that is always noticed early, or never, would test little.
void check_both(const Tally& tally) {
  INFO(tally.loaded << " loaded, " << tally.refused << " refused");
  CHECK(tally.loaded > kRoundsPerSeed / 50);
  CHECK(tally.refused > kRoundsPerSeed / 50);
}

gnomon::ImportOptions small_options() {
  gnomon::ImportOptions options;
  options.max_triangles = 1U << 16U;
  return options;
}

std::string as_string(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

void fuzz_bytes(const std::string& seed_file, const std::string& other, std::uint64_t seed) {
  Dice dice(seed);
  Tally tally;
  for (int round = 0; round < kRoundsPerSeed; ++round) {
    std::string file = seed_file;
    for (std::size_t steps = 1 + dice.below(3); steps > 0; --steps) damage(file, other, dice);
    INFO("round " << round << " of seed " << seed);
    try_import([&] { return load(file, small_options()); }, tally);
  }
  check_both(tally);
}

}  // namespace

TEST_CASE("the files that are going to be damaged load") {
  const gnomon::Scene scene = load(rich_document());
  CHECK(scene.triangles.size() == 3 + 2 + 2 + 1 + 1);
  CHECK(scene.cameras.size() == 1);
  CHECK(scene.lights.size() == 6);
  CHECK(scene.report.primitives_skipped == 1);
}

TEST_CASE("a damaged .gltf loads or is refused") {
  fuzz_bytes(rich_document().text(), as_string(one_triangle().glb()), 1);
}

TEST_CASE("a damaged .glb loads or is refused") {
  fuzz_bytes(as_string(rich_document().glb()), rich_document().text(), 2);
}

TEST_CASE("a .gltf that is well-formed JSON with wrong values loads or is refused") {
  Dice dice(3);
  Tally tally;
  const GltfBuilder whole = rich_document();
  for (int round = 0; round < 2 * kRoundsPerSeed; ++round) {
    GltfBuilder builder = whole;
    expose_view(builder, dice);
    for (std::size_t steps = 1 + dice.below(4); steps > 0; --steps) damage_document(builder, dice);
    INFO("round " << round);
    const bool as_glb = dice.below(2) == 0;
    try_import([&] { return as_glb ? load(builder.glb(), small_options()) : load(builder, small_options()); },
               tally);
  }
  check_both(tally);
}

TEST_CASE("a damaged .obj loads or is refused, with a damaged .mtl") {
  const TemporaryFolder folder;
  Dice dice(4);
  Tally tally;
  for (int round = 0; round < kRoundsPerSeed; ++round) {
    std::string obj = rich_obj();
    std::string mtl = rich_mtl();
    for (std::size_t steps = 1 + dice.below(4); steps > 0; --steps) damage(obj, mtl, dice);
    for (std::size_t steps = dice.below(3); steps > 0; --steps) damage(mtl, obj, dice);
    folder.write("paint.mtl", mtl);
    INFO("round " << round << "\n" << obj);
    try_import(
        [&] {
          return gnomon::import_obj_bytes({obj.begin(), obj.end()}, folder.path(), small_options());
        },
        tally);
  }
  check_both(tally);
}
