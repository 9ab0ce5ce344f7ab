// gnomon plan and trace --plan: decisions in full, the same hits, and clear words for what cannot be.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "run_program.h"

using nlohmann::json;
using program::run;

namespace {

json document_of(const std::vector<std::string>& arguments) {
  const auto outcome = run(arguments);
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  return json::parse(outcome.out);
}

}  // namespace

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
}

TEST_CASE("trace --plan answers as trace does, for less work") {
  for (const std::string kind : {"bounce", "shadow"}) {
    CAPTURE(kind);
    const std::vector<std::string> plain{"trace", "gen:cottage:8k", "--rays", kind,    "--count",
                                         "4k",    "--repeat",       "1",      "--json"};
    auto planned = plain;
    planned.insert(planned.end(), {"--plan", "auto"});
    auto baseline = plain;
    baseline.insert(baseline.end(), {"--plan", "sah"});
    const json before = document_of(plain);
    const json after = document_of(planned);
    const json sah = document_of(baseline);
    REQUIRE(before["plan"].is_null());
    REQUIRE(after["options"]["plan"] == "auto");
    REQUIRE(after["plan"]["decisions"][0]["kept"] != "sah");
    REQUIRE(sah["plan"]["decisions"][0]["kept"] == "sah");
    REQUIRE(after["hits"] == before["hits"]);
    REQUIRE(sah["hits"] == before["hits"]);
    REQUIRE(after["boxes_per_ray"] < 0.98 * sah["boxes_per_ray"].get<double>());
  }
}

TEST_CASE("plans that cannot be are refused before anything is loaded") {
  const auto unknown = run({"trace", "no-such-file.glb", "--plan", "best"});
  CHECK(unknown.status == 2);
  CHECK_THAT(unknown.err, Catch::Contains("best") && Catch::Contains("mix-rays"));
  const auto thread = run({"trace", "no-such-file.glb", "--plan", "auto", "--flavour", "thread"});
  CHECK(thread.status == 2);
  CHECK_THAT(thread.err, Catch::Contains("thread"));
  CHECK(run({"plan", "no-such-file.glb"}).status == 4);
  CHECK(run({"plan", "gen:cottage:8k", "--rays-in", "no-such.rays"}).status == 4);
  CHECK(run({"plan", "gen:cottage:8k", "--rays", "sideways"}).status == 2);
}
