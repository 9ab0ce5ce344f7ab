// Thousands of damaged scene files, the same ones on every run: each either loads as a valid scene or is refused
// with an Error. Built with address and undefined behaviour sanitizers, importers and parsers included, so a read
// one byte too far fails here. Not for what the messages say.
#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

#include "gltf_builder.h"
#include "gnomon/scene/obj_reader.h"
#include "gnomon/scene/triangle_check.h"

using namespace gnomon_test;

namespace {

constexpr int kRoundsPerSeed = 1500;

// mt19937_64 gives the same numbers everywhere; the standard distributions need not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : static_cast<std::size_t>(engine_() % limit); }
  template <typename T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }

 private:
  std::mt19937_64 engine_;
};

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
  return "mtllib paint.mtl\n# a comment\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.4 0\nv -1e-3 +2 .5\n"
         "vn 0 0 1\nvt 0 0\nusemtl lamp\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng a b\nf 1//1 2//1 3//1 4//1 5//1\n"
         "usemtl none\nf -1 -2 \\\n-3\ns 1\nl 1 2 3\np 1\nf 1 2 3 6 5 4\n";
}

std::string rich_mtl() {
  return "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 2 3\nPr 0.25\nNs 10\nillum 2\nmap_Kd -s 1 2 3 -clamp on x.png\nd 0.5\n"
         "newmtl other\nKe 0 0 0\nTr 0.5\nnorm -bm 1 n.png\n";
}

const std::vector<std::string>& nasty_numbers() {
  static const std::vector<std::string> numbers{
      "0", "-1", "1", "2", "3", "4", "7", "255", "256", "65535", "2147483647", "2147483648", "4294967295",
      "4294967296", "9007199254740992", "9007199254740993", "18446744073709551615", "-9223372036854775808", "1e30",
      "1e308", "1e-400", "0.5", "null", "\"x\"", "[]", "{}", "true", "nan", "-inf", "5126", "5121", "12345678901234567890"};
  return numbers;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Replaces one run of digits in a text.
void replace_number(std::string& text, Dice& dice) {
  std::size_t at = dice.below(text.size());
  while (at < text.size() && !is_digit(text[at])) ++at;
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (at < end) text.replace(at, end - at, dice.one_of(nasty_numbers()));
}

// One step of damage to a file of any kind; `other` is where splices come from.
void damage(std::string& file, const std::string& other, Dice& dice) {
  if (file.empty()) return;
  switch (dice.below(6)) {
    case 0: file[dice.below(file.size())] ^= static_cast<char>(1U << dice.below(8)); break;
    case 1: file[dice.below(file.size())] = static_cast<char>(dice.below(256)); break;
    case 2: file.resize(dice.below(file.size())); break;
    case 3: replace_number(file, dice); break;
    case 4: {  // a piece of another file
      const std::size_t from = dice.below(other.size());
      const std::size_t length = dice.below(std::min<std::size_t>(other.size() - from, 64) + 1);
      file.replace(dice.below(file.size()), dice.below(length + 1), other, from, length);
      break;
    }
    default: {  // a piece of itself, gone
      const std::size_t from = dice.below(file.size());
      file.erase(from, dice.below(32));
      break;
    }
  }
}

// One value somewhere in a JSON document, reached by one random step or more from its root.
Json& some_value(Json& root, Dice& dice) {
  Json* at = &root;
  do {
    auto next = at->begin();
    std::advance(next, static_cast<std::ptrdiff_t>(dice.below(at->size())));
    at = &*next;
  } while (at->is_structured() && !at->empty() && dice.below(8) != 0);
  return *at;
}

// Damage that stays JSON and so gets past the parser.
void damage_document(GltfBuilder& builder, Dice& dice) {
  Json& value = some_value(builder.json, dice);
  switch (dice.below(4)) {
    case 0: {
      const Json nasty = Json::parse(dice.one_of(nasty_numbers()), nullptr, false);
      value = nasty.is_discarded() ? Json(-1) : nasty;
      break;
    }
    case 1: value = some_value(builder.json, dice); break;
    case 2:
      if (value.is_number()) value = dice.below(16);
      break;
    default:
      builder.binary[dice.below(builder.binary.size())] ^= static_cast<unsigned char>(1U << dice.below(8));
      break;
  }
}

struct Tally {
  int loaded = 0;
  int refused = 0;
};

bool is_valid(const gnomon::Scene& scene) {
  bool valid = !scene.triangles.empty() && scene.material_ids.size() == scene.triangles.size();
  for (const auto& triangle : scene.triangles) valid &= gnomon::fault_of(triangle) == gnomon::TriangleFault::kNone;
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

std::string as_string(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

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
    for (std::size_t steps = 1 + dice.below(4); steps > 0; --steps) damage_document(builder, dice);
    INFO("round " << round);
    const bool as_glb = dice.below(2) == 0;
    try_import([&] { return as_glb ? load(builder.glb(), small_options()) : load(builder, small_options()); }, tally);
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
    try_import([&] { return gnomon::import_obj_bytes({obj.begin(), obj.end()}, folder.path(), small_options()); },
               tally);
  }
  check_both(tally);
}
