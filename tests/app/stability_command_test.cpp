// gnomon stability: what it lists, runs, prints, writes and refuses.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

const std::vector<const char*> kCounts{
    "rays", "hits", "lost", "false_hits", "wrong_primitive", "any_closest_disagree", "invalid_rays"};

std::vector<json> lines_of(const std::string& file) {
  std::istringstream text(program::read_text(file));
  std::vector<json> rows;
  for (std::string line; std::getline(text, line);) rows.push_back(json::parse(line));
  return rows;
}

}  // namespace

TEST_CASE("all cases are listed, by ascending numbers, for people and for machines") {
  const auto outcome = run({"stability", "--list", "--json"});
  REQUIRE(outcome.status == 0);
  const json cases = json::parse(outcome.out).at("cases");
  REQUIRE(cases.size() >= 38);
  for (std::size_t i = 1; i < cases.size(); ++i) CHECK(cases[i - 1].at("case") < cases[i].at("case"));
  const auto text = run({"stability", "--list"});
  for (const json& one : cases) CHECK_THAT(text.out, Contains(one.at("name").get<std::string>()));
}

TEST_CASE("chosen cases run for every flavour and give one row each") {
  const auto outcome = run({"stability", "--only", "1,14", "--rays-per-case", "64", "--json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  REQUIRE(document.at("ok") == true);
  const json& rows = document.at("rows");
  REQUIRE(rows.size() % 2 == 0);
  REQUIRE(rows.size() >= 2);
  for (const json& row : rows) {
    CHECK((row.at("case") == 1 || row.at("case") == 14));
    CHECK(row.at("ok") == true);
    CHECK(row.at("lost") == 0);
    for (const char* key : kCounts) CHECK(row.at(key).is_number());
    for (const char* key :
         {"commit", "device", "driver", "seed", "builder", "flavour", "t_error_ulp", "t_error_steps"})
      CHECK(row.contains(key));
    if (row.at("case") == 1) CHECK(row.at("hits") == row.at("rays"));
    if (row.at("case") == 14) CHECK(row.at("invalid_rays") == row.at("rays"));
  }
  const auto text = run({"stability", "--only", "1", "--rays-per-case", "64"});
  CHECK_THAT(text.out, Contains("at shared corners") && Contains("thread") && Contains("\nok"));
}

TEST_CASE("one builder and one flavour can be chosen, and only such as there are") {
  const auto outcome = run({"stability", "--only", "1", "--rays-per-case", "16", "--builder", "fast",
                            "--flavour", "thread", "--json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const json rows = json::parse(outcome.out).at("rows");
  REQUIRE(rows.size() == 1);
  CHECK(rows.at(0).at("builder") == "fast");
  CHECK(rows.at(0).at("flavour") == "thread");
  const auto refused = run({"stability", "--only", "1", "--flavour", "wider"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("no flavour \"wider\"") && Contains("thread"));
  CHECK_THAT(run({"stability", "--only", "1", "--builder", "slow"}).err, Contains("balanced, fast"));
  CHECK(run({"stability", "--rays", "100", "--builder", "fast"}).status == 2);
}

TEST_CASE("the same seed gives the same rows, another seed others") {
  const auto rows = [](const char* seed) {
    return json::parse(
               run({"stability", "--only", "17", "--rays-per-case", "64", "--json", "--seed", seed}).out)
        .at("rows");
  };
  const json first = rows("5");
  CHECK(first == rows("5"));
  CHECK(first[0].at("hits") != rows("6")[0].at("hits"));
}

TEST_CASE("a scene given is what case 18 runs on") {
  const auto outcome = run(
      {"stability", "gen:random:300", "gen:terrain:500", "--only", "18", "--rays-per-case", "50", "--json"});
  REQUIRE(outcome.status == 0);
  CHECK(json::parse(outcome.out).at("rows")[0].at("triangles").get<int>() < 900);
}

TEST_CASE("numbers that are none and cases that are not there are refused") {
  for (const char* only : {"x", "1,,2", "-3", "1e99"}) {
    CAPTURE(only);
    CHECK(run({"stability", "--only", only}).status == 2);
  }
  const auto outcome = run({"stability", "--only", "1,999"});
  CHECK(outcome.status == 2);
  CHECK_THAT(outcome.err, Contains("no case 999"));
  CHECK(run({"stability", "--rays-per-case", "0"}).status == 2);
}

TEST_CASE("a long run gives one row that says all about it, appended to a file") {
  const Folder folder;
  const std::string file = folder.file("rows.jsonl");
  for (int i = 0; i < 2; ++i) {
    const auto outcome = run({"stability", "gen:random:2000", "--rays", "36000", "--rows", file, "--json"});
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE(json::parse(outcome.out).at("rows").size() == 1);
  }
  // bench/results/schema.json says what such a row holds
  const auto checked = run({"rows", "check", file});
  CHECK(checked.err == "");
  CHECK(checked.status == 0);
  const std::vector<json> rows = lines_of(file);
  REQUIRE(rows.size() == 2);
  const json& row = rows[0];
  CHECK(row.at("rays") == 36000);
  CHECK(row.at("kind") == "soak");
  CHECK(row.at("stopped") == false);
  CHECK(row.at("at_corners").get<int>() > 7000);
  CHECK(row.at("at_edges").get<int>() > 7000);
  CHECK(row.at("exactly").get<int>() > 5000);
  CHECK(row.at("lost") == 0);
  CHECK(row.at("false_hits") == 0);
  CHECK(row.at("flavours_differ") == 0);
  CHECK(row.at("range_rounded") == 0);
  if (row.at("fp64") == true) {
    CHECK(row.at("tolerance_ulp") == 0.5625);
    CHECK(row.at("t_error_ulp").at("max") <= row.at("tolerance_ulp"));
  }
  const json flavours = row.at("options").at("flavours");
  CHECK((flavours.size() == 6 ||
         flavours == json::array({"thread"})));  // packets among them where there are any
  CHECK(row.at("parts").size() == 9);            // three offsets, three builders
  std::uint64_t hits = 0;
  for (const json& step : row.at("t_error_steps")) hits += step[1].get<std::uint64_t>();
  CHECK(hits == row.at("hits"));
  CHECK(rows[1].at("t_error_steps") == row.at("t_error_steps"));
}

TEST_CASE("Ctrl-C ends a long run with what it has, and the rows are kept") {
  const Folder folder;
  const std::string file = folder.file("rows.jsonl");
  program::Setup setup;
  setup.terminal = true;
  setup.interrupt_at = "rays judged";
  const auto outcome = run({"stability", "gen:random:500", "--rays", "1e9", "--rows", file, "--json"}, setup);
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 130);
  const json row = json::parse(outcome.out).at("rows")[0];
  CHECK(row.at("stopped") == true);
  CHECK(row.at("rays").get<std::uint64_t>() > 0);
  CHECK(row.at("lost") == 0);
  REQUIRE(lines_of(file).size() == 1);
  CHECK(lines_of(file)[0].at("rays") == row.at("rays"));
}

TEST_CASE("rows that cannot be written are an error") {
  const auto outcome = run({"stability", "--only", "14", "--rows", "/no/such/folder/rows.jsonl"});
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.err, Contains("/no/such/folder/rows.jsonl"));
}
