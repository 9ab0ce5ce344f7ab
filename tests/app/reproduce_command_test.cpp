// gnomon reproduce: a set-up of one's own from end to end, and configurations that cannot be.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

const char* const kOneSetUp =
    R"({"configs": [{"scene": "Random100", "area": "plane", "orientation": "parallel",
  "kind": "plane", "point": [5, 5, -4], "normal": [0, 0, 1], "half_width": 5, "half_height": 5, "forward_size": 20,
  "used_by_variants": ["Standard", "Full", "Facing", "Longest"]}]})";

}  // namespace

TEST_CASE("a set-up is built by every variant, measured, and written as rows") {
  const Folder folder;
  const auto configs = folder.path() / "configs.json";
  const auto rows = folder.path() / "rows.jsonl";
  program::write_text(configs, kOneSetUp);
  const auto outcome = run({"reproduce", "--configs", configs.string(), "--scenes", folder.path().string(),
                            "--rays", "200", "--prediction-rays", "500", "--rows", rows.string(), "--quiet"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  REQUIRE_THAT(outcome.out, Contains("Random100 plane parallel") && Contains("PAH3"));
  std::map<std::string, double> cost;
  std::istringstream lines(program::read_text(rows));
  for (std::string line; std::getline(lines, line);) {
    const json row = json::parse(line);
    REQUIRE(row.at("schema") == 1);
    REQUIRE(row.at("bench") == "reproduce");
    if (row.at("task") != "cost") continue;
    cost[row.at("variant")] = row.at("local").at("mean");
    // Every measure that the thesis exports, and those that matter.
    for (const char* field : {"predicted", "overlap", "fallback_share", "planes_tried", "axis_share",
                              "axis_fallback_share", "local_hit_share", "hit_share", "break_even_hit_share",
                              "closest", "any", "build_ms", "total", "global"}) {
      CAPTURE(field, line);
      REQUIRE(row.contains(field));
    }
    REQUIRE(row.at("planes_tried") >= 1.0);
    if (row.at("members") == "octree-vertices") REQUIRE(row.at("planes_tried") <= 3.1);
    const json& axes = row.at("axis_share");
    REQUIRE(axes.at("x").get<double>() + axes.at("y").get<double>() + axes.at("z").get<double>() ==
            Approx(1.0));
  }
  for (const char* variant : {"Standard", "Full", "Facing", "Longest", "SAH3", "PAH3"}) {
    CAPTURE(variant);
    REQUIRE(cost.contains(variant));
    REQUIRE(cost[variant] > 2.0);
  }
  REQUIRE(cost["PAH3"] < cost["SAH3"]);  // by a third here
}

TEST_CASE("configurations that are not there or not right are named") {
  const Folder folder;
  const auto configs = folder.path() / "configs.json";
  const auto missing = run({"reproduce", "--configs", configs.string(), "--scenes", "x"});
  REQUIRE(missing.status == 1);
  REQUIRE_THAT(missing.err, Contains("configs.json"));
  for (const char* text : {"{", R"({"configs": [{"scene": "Random100"}]})"}) {
    program::write_text(configs, text);
    const auto outcome = run({"reproduce", "--configs", configs.string(), "--scenes", "x"});
    CAPTURE(text, outcome.err);
    REQUIRE(outcome.status != 0);
    REQUIRE_THAT(outcome.err, Contains("configs.json"));
  }
}
