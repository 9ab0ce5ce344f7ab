// Whose rays a tree is for is said by number, kind and name: those of the light that was asked for, as
// `gnomon info` numbers them.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::run;

namespace {

// One triangle on the ground, and above it lights in the order of their nodes, not of their definitions: each
// looks down.
const char* const kScene = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "directional", "name": "sun"}, {"type": "spot", "name": "lamp"}, {"type": "point"},
    {"type": "directional", "name": "moon"}]}},
  "nodes": [
    {"mesh": 0},
    {"translation": [0, 2, 0], "rotation": [-0.70710678, 0, 0, 0.70710678],
     "extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 3}}},
    {"rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"translation": [0, 1, 0], "extensions": {"KHR_lights_punctual": {"light": 2}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                 "min": [-4, 0, -4], "max": [4, 0, 4]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36,
               "uri": "data:application/octet-stream;base64,AACAwAAAAAAAAIDAAACAQAAAAAAAAIDAAAAAAAAAAAAAAIBA"}]
})";

const std::vector<std::string> kNames{"light 0 (spot \"lamp\")", "light 1 (directional \"moon\")",
                                      "light 2 (directional \"sun\")", "light 3 (point)"};

}  // namespace

TEST_CASE("the light whose rays count is named as it is in the scene, in words and in documents") {
  const program::Folder folder;
  const std::string scene = folder.file("lights.gltf");
  program::write_text(scene, kScene);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    std::vector<std::string> words{"build",  scene,  "--repeat", "1",
                                   "--axes", "spfh", "--light",  std::to_string(i)};
    const auto text = run(words);
    CAPTURE(i, text.err);
    REQUIRE(text.status == 0);
    CHECK_THAT(text.out, Contains("sah+spfh, rays of " + kNames[i] + "\n"));
    words.emplace_back("--json");
    CHECK(json::parse(run(words).out).at("options").at("rays_of") == kNames[i]);
  }
  // What does not fit is refused by the same name.
  const auto refused = run({"build", scene, "--heuristic", "solid-angle", "--light", "1"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("the rays of " + kNames[1] + " are parallel"));
}

TEST_CASE("info numbers lights as --light takes them, and counts them by kind") {
  const program::Folder folder;
  const std::string scene = folder.file("lights.gltf");
  program::write_text(scene, kScene);
  const auto text = run({"info", scene});
  CAPTURE(text.err);
  REQUIRE(text.status == 0);
  CHECK_THAT(text.out, Contains("4 (0 spot, 1 directional, 2 directional, 3 point)"));
  const json lights = json::parse(run({"info", scene, "--json"}).out).at("lights");
  CHECK(lights.at("directional") == 2);
  CHECK(lights.at("spot") == 1);
  CHECK(lights.at("point") == 1);
}
