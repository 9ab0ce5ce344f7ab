// gnomon detect: lights and groups of a scene's rays, of recorded ones, nothing where nothing is, and a file
// of areas.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "json_document.h"

using nlohmann::json;
using program::document_of;
using program::Folder;
using program::run;

namespace {

// Groups of one kind of rays and of one kind of group.
std::size_t groups_of(const json& document, const std::string& rays, const std::string& kind) {
  std::size_t count = 0;
  for (const json& group : document["groups"]) count += group["of"] == rays && group["kind"] == kind;
  return count;
}

}  // namespace

TEST_CASE("detect finds the atrium's sun and lamps in its shadow rays, and its camera") {
  const json found = document_of({"detect", "gen:atrium:20k", "--json"});
  REQUIRE(found["command"] == "detect");
  REQUIRE(found["lights"].size() == 8);
  REQUIRE(groups_of(found, "shadow", "bundle") == 1);
  REQUIRE(groups_of(found, "shadow", "converging") >= 5);
  REQUIRE(groups_of(found, "primary", "diverging") == 1);
  REQUIRE(found["samples"][1]["rays"] == "bounce");
  REQUIRE(found["samples"][1]["groups"] == 0);
  for (const json& group : found["groups"]) {
    CAPTURE(group.dump());
    REQUIRE(group["coverage"] >= 0.01);
    REQUIRE(group["log10_chance"] <= -6.0);
  }
  const auto words = run({"detect", "gen:city:20k", "--rays", "random"});
  REQUIRE(words.status == 0);
  REQUIRE_THAT(words.out, Catch::Contains("Nowhere"));
}

TEST_CASE("detect reads records, and writes areas whole or not at all") {
  const Folder folder;
  const std::string record = folder.file("rays.gnr"), areas = folder.file("areas.json");
  const auto drawn = run({"render", "gen:atrium:20k", "-o", folder.file("picture.png"), "--samples", "4",
                          "--width", "64", "--height", "64", "--record", record, "-q"});
  CAPTURE(drawn.err);
  REQUIRE(drawn.status == 0);
  const json found = document_of(
      {"detect", "gen:atrium:20k", "--rays-in", record, "--kinds", "shadow", "-o", areas, "--json"});
  REQUIRE(found["samples"].size() == 1);
  REQUIRE(found["groups"].size() >= 4);
  std::ifstream file(areas);
  const json written = json::parse(file);
  REQUIRE(written["configs"].size() == found["lights"].size() + found["groups"].size());
  const auto nowhere =
      run({"detect", "gen:atrium:20k", "--rays", "shadow", "-o", folder.file("none/areas.json")});
  REQUIRE(nowhere.status != 0);
  REQUIRE_THAT(nowhere.err, Catch::Contains("areas.json"));
}

TEST_CASE("detect says what is wrong with its input") {
  REQUIRE(run({"detect", "nowhere.glb"}).status == 4);
  REQUIRE(run({"detect", "gen:atrium:20k", "--least", "2"}).status == 2);
  REQUIRE(run({"detect", "gen:atrium:20k", "--kinds", "shadow"}).status == 2);
  REQUIRE(run({"detect"}).status == 2);
}
