// gnomon plan, and --plan of build, trace and render: decisions in full, the same answers, no plan where rays
// are few or another option says which tree, and clear words for what cannot be.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "json_document.h"

using nlohmann::json;
using program::document_of;
using program::run;

TEST_CASE("plan explains a decision for each kind of rays") {
  const json plan = document_of({"plan", "gen:cottage:8k", "--rays", "primary,shadow", "--json"});
  REQUIRE(plan["command"] == "plan");
  REQUIRE(plan["trees"][0]["name"] == "sah");
  REQUIRE(plan["decisions"].size() == 2);
  REQUIRE(plan["decisions"][0]["query"] == "closest");
  REQUIRE(plan["decisions"][1]["query"] == "any");
  for (const json& decision : plan["decisions"]) {
    CAPTURE(decision.dump());
    REQUIRE(decision["trials"].size() >= 1);
    REQUIRE_FALSE(decision["reason"].get<std::string>().empty());
    REQUIRE(plan["trees"][decision["tree"].get<std::size_t>()]["name"] == decision["kept"]);
    REQUIRE(decision["cost"] <= decision["baseline_cost"]);
  }
  // Shadow rays have an order to learn at the least.
  REQUIRE(plan["decisions"][1]["kept"] != "sah");
  const auto words = run({"plan", "gen:cottage:8k", "--rays", "shadow", "--expect", "10"});
  REQUIRE(words.status == 0);
  REQUIRE_THAT(words.out, Catch::Contains("cannot repay"));
  const auto gain = run({"plan", "gen:cottage:8k", "--rays", "shadow", "--expect", "1G"});
  REQUIRE_THAT(gain.out, Catch::Contains("over 1.0 billion rays that saves"));
}

TEST_CASE("trace --plan answers as trace does, for less work") {
  for (const std::string kind : {"bounce", "shadow"}) {
    CAPTURE(kind);
    const std::vector<std::string> plain{"trace", "gen:cottage:8k", "--rays", kind,    "--count",
                                         "4k",    "--repeat",       "1",      "--json"};
    auto planned = plain;
    planned.insert(planned.end(), {"--expect", "1G"});
    auto baseline = plain;
    baseline.insert(baseline.end(), {"--plan", "sah"});
    const json before = document_of(plain);
    const json after = document_of(planned);
    const json sah = document_of(baseline);
    // 12000 rays repay nothing.
    REQUIRE(before["options"]["plan"] == "auto");
    REQUIRE(before["plan"]["made"] == false);
    REQUIRE(before["plan"]["price_units"] > 0.05 * before["plan"]["work_units"].get<double>());
    REQUIRE(before["plan"]["seconds"] == 0.0);
    REQUIRE_THAT(before["plan"]["reason"].get<std::string>(),
                 Catch::Contains("too few") && Catch::Contains("in each of 3 passes"));
    REQUIRE(after["plan"]["made"] == true);
    const json& chosen = after["plan"]["chosen"][0];
    REQUIRE(chosen["tree"] == after["plan"]["decisions"][0]["kept"]);
    REQUIRE(chosen["measured_saving"] > 0.02);
    REQUIRE(chosen["predicted_saving"] > 0.02);
    REQUIRE(after["plan"]["seconds"] > 0.0);
    REQUIRE(sah["plan"]["chosen"][0]["tree"] == "sah");
    REQUIRE(after["hits"] == before["hits"]);
    REQUIRE(sah["hits"] == before["hits"]);
    REQUIRE(after["tree"]["hash"] != before["tree"]["hash"]);
    REQUIRE(after["boxes_per_ray"] < 0.98 * sah["boxes_per_ray"].get<double>());
  }
}

TEST_CASE(
    "boxes along a sun's rays are kept where they are traced, with the same hits, and refused elsewhere") {
  const std::vector<std::string> plain{"trace", "gen:terrain:8k", "--rays", "shadow", "--count",
                                       "4k",    "--repeat",       "1",      "--json"};
  for (const std::string flavour : {"auto", "wide", "packet"}) {
    CAPTURE(flavour);
    auto framed = plain;
    framed.insert(framed.end(), {"--flavour", flavour, "--plan", "light-rays"});
    const json before = document_of(plain);
    const json after = document_of(framed);
    REQUIRE(after["plan"]["chosen"][0]["tree"] == "light-rays");
    REQUIRE(after["plan"]["decisions"][0]["light_space"]["obliquity"] > 1.3);
    REQUIRE(after["plan"]["trees"].back()["boxes_in_frame"] == true);
    REQUIRE(after["hits"] == before["hits"]);
    REQUIRE(after["tree"]["hash"] != before["tree"]["hash"]);
  }
  const json plan = document_of({"plan", "gen:terrain:8k", "--rays", "shadow", "--json"});
  REQUIRE(plan["decisions"][0]["light_space"]["obliquity"] > 1.3);
  auto compact = plain;
  compact.insert(compact.end(), {"--flavour", "compact", "--plan", "light-rays"});
  for (const std::vector<std::string>& refused :
       {compact, std::vector<std::string>{"build", "gen:terrain:8k", "--plan", "light-rays"}}) {
    const auto answer = run(refused);
    REQUIRE(answer.status != 0);
    REQUIRE_THAT(answer.err, Catch::Contains("light-rays") && Catch::Contains("wide or packet"));
  }
}

TEST_CASE(
    "a tree of part of the scene is kept where it is traced, with the same hits, and refused elsewhere") {
  // Down from one point onto a small part of the terrain.
  std::vector<float> rays;
  for (int i = 0; i < 4096; ++i) {
    const float x = 0.24F * (static_cast<float>(i % 64) / 63.0F - 0.5F);
    const float z = 0.24F * (static_cast<float>(i / 64) / 63.0F - 0.5F);
    rays.insert(rays.end(), {0.0F, 700.0F, 0.0F, 0.0F, x, -1.0F, z, INFINITY});
  }
  const program::Folder folder;
  const std::string file = folder.file("down.rays");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(rays.data()), static_cast<std::streamsize>(4 * rays.size()));
  const std::vector<std::string> plain{"trace", "gen:terrain:20k", "--rays-in", file, "--repeat",
                                       "1",     "--json"};
  const json before = document_of(plain);
  REQUIRE(before["hits"] == 4096);
  for (const std::string query : {"closest", "any"}) {
    for (const std::string flavour : {"auto", "wide", "packet"}) {
      CAPTURE(query, flavour);
      auto local = plain;
      local.insert(local.end(), {"--query", query, "--flavour", flavour, "--plan", "local-rays"});
      const json after = document_of(local);
      REQUIRE(after["plan"]["chosen"][0]["tree"] == "local-rays");
      REQUIRE(after["plan"]["decisions"][0]["local"]["trees"][0]["triangles"] < 2000);
      REQUIRE(after["plan"]["trees"].back()["local"].size() == 1);
      REQUIRE(after["hits"] == before["hits"]);
    }
  }
  const auto words = run({"plan", "gen:terrain:20k", "--rays-in", file, "--plan", "local-rays"});
  REQUIRE(words.status == 0);
  REQUIRE_THAT(words.out, Catch::Contains("trees of their own for"));
  auto compact = plain;
  compact.insert(compact.end(), {"--flavour", "compact", "--plan", "local-rays"});
  for (const std::vector<std::string>& refused :
       {compact, std::vector<std::string>{"build", "gen:terrain:20k", "--plan", "local-rays"}}) {
    const auto answer = run(refused);
    REQUIRE(answer.status != 0);
    REQUIRE_THAT(answer.err, Catch::Contains("local-rays") && Catch::Contains("wide or packet"));
  }
}

TEST_CASE("trees of parts are planned with where they pay, traced by every flavour, kept and read again") {
  const std::string city = "gen:city:30k";
  for (const std::string kind : {"bounce", "shadow"}) {
    const std::vector<std::string> plain{"trace", city,       "--rays", kind,    "--count",
                                         "4k",    "--repeat", "1",      "--json"};
    const auto traced = [&](const std::vector<std::string>& more) {
      auto arguments = plain;
      arguments.insert(arguments.end(), more.begin(), more.end());
      return document_of(arguments);
    };
    const json before = traced({});
    const json after = traced({"--expect", "1G"});
    REQUIRE(after["plan"]["trees"][0]["name"] == "best");
    REQUIRE(after["plan"]["chosen"][0]["tree"] == "best-rays");
    REQUIRE(after["plan"]["chosen"][0]["measured_saving"] > 0.3);
    REQUIRE(after["hits"] == before["hits"]);
    REQUIRE(after["boxes_per_ray"] < 0.8 * before["boxes_per_ray"].get<double>());
    if (kind == "shadow") continue;
    for (const std::string flavour : {"wide", "packet", "compact"}) {
      CAPTURE(flavour);
      REQUIRE(traced({"--plan", "best-rays", "--flavour", flavour})["hits"] == before["hits"]);
    }
    REQUIRE(traced({"--plan", "best", "--flavour", "thread"})["hits"] == before["hits"]);
  }
  const program::Folder folder;
  const std::string file = folder.file("parts.gnb");
  const auto built = run({"build", city, "--repeat", "1", "--plan", "best-rays", "-o", file});
  REQUIRE(built.status == 0);
  const json checked =
      document_of({"validate", city, "--tree", file, "--json", "--count", "300", "--max-rays", "50"});
  REQUIRE(checked["ok"] == true);
  const json info = document_of({"info", city, "--tree", file, "--json"});
  REQUIRE(info["tree"]["builder"] == "best");
  REQUIRE(info["tree"]["fitted_to_rays"] == true);
  const auto words = run({"plan", city, "--rays", "bounce"});
  REQUIRE_THAT(words.out, Catch::Contains("of best") && Catch::Contains("building best"));
}

TEST_CASE("options that say which tree leave no plan, and exclude one") {
  for (const std::vector<std::string>& own : std::vector<std::vector<std::string>>{
           {"--builder", "fast"}, {"--max-leaf", "4"}, {"--axes", "lsph"}}) {
    CAPTURE(own);
    std::vector<std::string> arguments{"trace", "gen:cottage:8k", "--count", "1k", "--expect",
                                       "1G",    "--json"};
    arguments.insert(arguments.end(), own.begin(), own.end());
    const json document = document_of(arguments);
    REQUIRE(document["options"]["plan"].is_null());
    REQUIRE(document["plan"]["made"] == false);
    REQUIRE_THAT(document["plan"]["reason"].get<std::string>(), Catch::Contains(own[0]));
    arguments.insert(arguments.end(), {"--plan", "auto"});
    REQUIRE(run(arguments).status == 2);
  }
}

TEST_CASE("build keeps one tree for all rays to come, where it is told of them") {
  const program::Folder folder;
  const std::vector<std::string> plain{"build", "gen:cottage:8k", "--repeat", "1", "--json"};
  const json untold = document_of(plain);
  REQUIRE(untold["plan"]["made"] == false);
  REQUIRE_THAT(untold["plan"]["reason"].get<std::string>(), Catch::Contains("--expect"));
  auto told = plain;
  told.insert(told.end(), {"--expect", "1G", "-o", folder.file("planned.gnb")});
  const json planned = document_of(told);
  REQUIRE(planned["plan"]["made"] == true);
  REQUIRE(planned["plan"]["decisions"].size() == 3);
  REQUIRE(planned["plan"]["chosen"].size() == 1);
  REQUIRE(planned["plan"]["chosen"][0]["rays"] == "all");
  REQUIRE(planned["plan"]["chosen"][0]["measured_saving"] > 0.0);
  REQUIRE(planned["tree"]["hash"] != untold["tree"]["hash"]);
  // No builder makes the same tree, and none is asked to.
  const json checked = document_of({"validate", "gen:cottage:8k", "--tree", folder.file("planned.gnb"),
                                    "--json", "--count", "500", "--max-rays", "100"});
  REQUIRE(checked["ok"] == true);
  REQUIRE(checked["reference_hash"] == nullptr);
  const json info = document_of({"info", "gen:cottage:8k", "--tree", folder.file("planned.gnb"), "--json"});
  REQUIRE(info["tree"]["fitted_to_rays"] == true);
  const json traced = document_of({"trace", "gen:cottage:8k", "--tree", folder.file("planned.gnb"), "--count",
                                   "2k", "--repeat", "1", "--json"});
  REQUIRE(traced["tree"]["hash"] == planned["tree"]["hash"]);
  REQUIRE(traced["hits"] ==
          document_of({"trace", "gen:cottage:8k", "--count", "2k", "--repeat", "1", "--json"})["hits"]);
  auto few = plain;
  few.insert(few.end(), {"--expect", "1k"});
  REQUIRE(document_of(few)["plan"]["made"] == false);
}

TEST_CASE("build plans for the rays of a record, as many as it counted") {
  const program::Folder folder;
  const std::string record = folder.file("rays.gnr");
  const json rendered = document_of({"render", "gen:cottage:8k", "-o", folder.file("a.png"), "--width", "64",
                                     "--height", "48", "--samples", "2", "--record", record, "--json"});
  REQUIRE(rendered["plan"]["made"] == false);
  REQUIRE_THAT(rendered["plan"]["reason"].get<std::string>(), Catch::Contains("too few"));
  const json few = document_of({"build", "gen:cottage:8k", "--repeat", "1", "--rays-in", record, "--json"});
  REQUIRE(few["plan"]["made"] == false);
  // All the rays that the picture traced, each with a cost.
  const double rays = rendered["rays"].get<double>();
  REQUIRE(few["plan"]["work_units"] > rays);
  REQUIRE(few["plan"]["work_units"] < 1000.0 * rays);
  const json many = document_of({"build", "gen:cottage:8k", "--repeat", "1", "--rays-in", record, "--kinds",
                                 "shadow", "--expect", "1G", "--json"});
  REQUIRE(many["plan"]["made"] == true);
  REQUIRE(many["plan"]["decisions"].size() == 1);
  REQUIRE(many["plan"]["decisions"][0]["query"] == "any");
}

TEST_CASE("a planned picture is the plain one to the last byte, by less work") {
  const program::Folder folder;
  const std::vector<std::string> plain{"render", "gen:cottage:8k", "--width", "64",    "--height",
                                       "48",     "--samples",      "2",       "--json"};
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    auto arguments = plain;
    arguments.insert(arguments.end(), {"-o", folder.file(name), "--heat-map", folder.file("heat-" + name)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return document_of(arguments);
  };
  const json before = picture("plain.png", {});
  const json after = picture("planned.png", {"--expect", "1G"});
  const json named = picture("named.png", {"--plan", "mix"});
  REQUIRE(after["plan"]["made"] == true);
  REQUIRE(after["plan"]["chosen"].size() == 2);
  REQUIRE(after["plan"]["decisions"][0]["query"] == "closest");
  REQUIRE(after["plan"]["decisions"][1]["query"] == "any");
  REQUIRE(after["plan"]["chosen"][1]["measured_saving"] > 0.02);
  REQUIRE(named["plan"]["chosen"][0]["tree"] == "mix");
  REQUIRE(named["plan"]["chosen"][1]["tree"] == "mix");
  REQUIRE(after["rays"] == before["rays"]);
  const std::string bytes = program::read_text(folder.file("plain.png"));
  REQUIRE(program::read_text(folder.file("planned.png")) == bytes);
  REQUIRE(program::read_text(folder.file("named.png")) == bytes);
  REQUIRE(after["heat_map"]["mean_boxes"] < before["heat_map"]["mean_boxes"]);
}

TEST_CASE("plans that cannot be are refused before anything is loaded") {
  const auto unknown = run({"trace", "no-such-file.glb", "--plan", "finest"});
  CHECK(unknown.status == 2);
  CHECK_THAT(unknown.err, Catch::Contains("finest") && Catch::Contains("mix-rays"));
  const auto thread = run({"trace", "no-such-file.glb", "--plan", "auto", "--flavour", "thread"});
  CHECK(thread.status == 2);
  CHECK_THAT(thread.err, Catch::Contains("thread"));
  const auto preview = run({"render", "no-such-file.glb", "-o", "a.png", "--plan", "mix"});
  CHECK(preview.status == 2);
  CHECK_THAT(preview.err, Catch::Contains("--samples"));
  CHECK(run({"build", "no-such-file.glb", "--plan", "finest"}).status == 2);
  CHECK(run({"plan", "no-such-file.glb"}).status == 4);
  CHECK(run({"plan", "gen:cottage:8k", "--rays-in", "no-such.rays"}).status == 4);
  CHECK(run({"plan", "gen:cottage:8k", "--rays", "sideways"}).status == 2);
}
