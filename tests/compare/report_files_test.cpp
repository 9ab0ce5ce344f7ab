// A report as files: JSON, rows and CSV, written and read again.
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/compare/base64.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/report_json.h"
#include "support/sample_report.h"
#include "support/text.h"

using namespace gnomon::compare;
using Catch::Contains;
using gnomon::compare::test::sample_report;
using gnomon::test::count_of;

TEST_CASE("the same report gives the same bytes, another report others") {
  const Report report = sample_report();
  CHECK(report_page(report) == report_page(sample_report()));
  CHECK(to_json_text(report) == to_json_text(sample_report()));
  Report other = report;
  other.devices[0].builds[1].rounds.wall_s[0] = 0.625;
  CHECK(report_page(other) != report_page(report));
}

TEST_CASE("a report comes back from its JSON as it was, and draws the same page") {
  const Report report = sample_report();
  const Report back = from_json_text(to_json_text(report), "there");
  CHECK(back == report);
  CHECK(report_page(back) == report_page(report));
  CHECK(to_csv(back) == to_csv(report));
}

TEST_CASE("what is needed to repeat a comparison is in the page, in its JSON, and in every line of its CSV") {
  Report report = sample_report();
  report.version = "9.8.7";
  report.options = {{"rays", "primary,bounce"}, {"seed of rays", "4711"}, {"bins", "61"}};
  report.command = "gnomon compare scene.glb --rays primary,bounce --seed 4711 --clock cpu";
  report.clock = "cpu";
  const DeviceReport& device = report.devices[0];
  const std::string page = report_page(report);
  std::string repeat =
      page.substr(page.find("<h2>To repeat it</h2>"), page.find("</dl>") - page.find("<h2>To"));
  // Where lines may end is no part of the command.
  for (const std::string mark : {"<span class=\"whole\">", "</span>"})
    for (std::size_t at = 0; (at = repeat.find(mark, at)) != std::string::npos;)
      repeat.erase(at, mark.size());
  const auto document = nlohmann::json::parse(to_json_text(report));
  std::istringstream lines(to_csv(report));
  std::string line;
  std::getline(lines, line);
  for (const char* column : {"device", "driver", "scene", "scene_hash", "version", "commit", "command"})
    CHECK_THAT("," + line + ",", Contains("," + std::string(column) + ","));
  std::vector<std::string> csv;
  while (std::getline(lines, line)) csv.push_back(line);
  REQUIRE(csv.size() == 4 * 2);
  const std::string quoted_scene = "a </script> b";
  for (const std::string& fact : {report.version, report.commit, report.command, quoted_scene,
                                  report.scene_hash, device.name, device.driver}) {
    CAPTURE(fact);
    std::string escaped = fact;
    for (const auto& [plain, entity] : {std::pair{"<", "&lt;"}, std::pair{">", "&gt;"}})
      for (std::size_t at = 0; (at = escaped.find(plain, at)) != std::string::npos; ++at)
        escaped.replace(at, 1, entity);
    CHECK_THAT(repeat, Contains(escaped));
    for (const std::string& text : csv) CHECK_THAT(text, Contains(fact));
  }
  CHECK_THAT(repeat, Contains(device.platform) && Contains(device.opencl) && Contains("processor time"));
  for (const auto& [name, value] : report.options) {
    CHECK_THAT(repeat, Contains("<dt>" + name + "</dt><dd>" + value + "</dd>"));
    CHECK(document.at("options").at(name) == value);
  }
  for (const auto& [name, value] :
       {std::pair{"version", report.version}, std::pair{"commit", report.commit},
        std::pair{"command", report.command}, std::pair{"scene", report.scene},
        std::pair{"scene_hash", report.scene_hash}, std::pair{"clock", report.clock}})
    CHECK(document.at(name) == value);
  const auto& facts = document.at("devices").at(0);
  CHECK(facts.at("device") == device.name);
  CHECK(facts.at("driver") == device.driver);
  CHECK(facts.at("opencl") == device.opencl);
  CHECK(facts.at("platform") == device.platform);
}

TEST_CASE("each row of the JSON stands by itself") {
  const auto document = nlohmann::json::parse(to_json_text(sample_report()));
  CHECK(document.at("schema") == kSchema);
  std::set<std::string> names;
  for (const auto& row : document.at("devices").at(0).at("rows")) {
    CAPTURE(row.dump());
    for (const char* field : {"schema", "bench", "task", "name", "commit", "device", "driver", "scene",
                              "scene_hash", "triangles", "method"})
      REQUIRE(row.contains(field));
    REQUIRE(names.insert(row.at("name")).second);  // a name is one row's
    if (row.at("task") != "trace" || row.at("method") != "sah-best" || row.at("rays") != "primary") continue;
    REQUIRE(row.at("real_time") == 1e6);  // 1 s for 1000 rays, in ns
  }
  CHECK(names.size() == 4 * (1 + 2 + 2) + 3 * 2 + 4 + 3 + 1 + 1);
}

TEST_CASE("a report comes back from its rows, but for pictures and what a rerun needs") {
  Report report = sample_report();
  Report other = report;
  other.command = "another";
  const auto back = from_rows_text(to_rows_text(report) + to_rows_text(other), "there");
  REQUIRE(back.size() == 2);
  report.devices[0].pictures = other.devices[0].pictures = {};
  report.devices[0].done = other.devices[0].done = {};
  CHECK(back[0] == report);
  CHECK(back[1] == other);
  for (const char* text : {"{", R"({"bench": "spine", "schema": 1})",
                           R"({"bench": "compare", "schema": 1, "task": "build", "method": "m"})"}) {
    CAPTURE(text);
    REQUIRE_THROWS_WITH(from_rows_text(text, "old.jsonl"), Contains("old.jsonl, line 1"));
  }
}

TEST_CASE("a row's ratio is of the same round, the baseline's over its own") {
  std::size_t seen = 0;
  std::istringstream lines(to_rows_text(sample_report()));
  for (std::string line; std::getline(lines, line);) {
    const auto row = nlohmann::json::parse(line);
    CAPTURE(line);
    if (row.at("task") == "build" && row.at("method") == "sah-best") {
      REQUIRE(row.at("ratio") == nlohmann::json{{"median", 0.25}, {"min", 0.25}, {"max", 0.25}, {"n", 3}});
      ++seen;
    }
    if (row.at("task") == "trace" && row.at("method") == "sah-best" && row.at("rays") == "bounce") {
      REQUIRE(row.at("ratio") == nlohmann::json{{"median", 2.0}, {"min", 1.6}, {"max", 2.0}, {"n", 3}});
      ++seen;
    }
    if (row.at("task") == "size" && row.at("method") == "sah-fast") {
      REQUIRE(row.at("build_ratio").at("median") == 2.0);
      REQUIRE(row.at("trace_ratio").at("median") == 1.0);
      ++seen;
    }
  }
  CHECK(seen == 4);
}

TEST_CASE("a row's times are medians of a ray or triangle, of each clock by itself") {
  auto report = sample_report();
  for (TraceRow& trace : report.devices[0].traces) trace.rounds.cpu_s = {3.0, 9.0, 5.0};
  bool seen = false;
  std::istringstream lines(to_rows_text(report));
  for (std::string line; std::getline(lines, line);) {
    const auto row = nlohmann::json::parse(line);
    if (row.at("task") != "trace" || row.at("method") != "sah-fast" || row.at("rays") != "bounce") continue;
    CAPTURE(line);
    CHECK(row.at("real_time") == 8e6);  // 8 s for 1000 rays
    CHECK(row.at("cpu_time") == 5e6);
    CHECK(row.at("time_unit") == "ns");
    seen = true;
  }
  CHECK(seen);
}

TEST_CASE("a text that is no report is refused with its name and what to do") {
  for (const char* text :
       {"", "{", "[]", "{}", R"({"bench": "spine", "schema": 1})", R"({"bench": "compare", "schema": 2})"}) {
    CAPTURE(text);
    REQUIRE_THROWS_WITH(from_json_text(text, "old.json"),
                        Contains("old.json") && Contains("another name with -o"));
  }
}

TEST_CASE("the CSV has a line for each method and kind, with as many cells as the head") {
  const std::string csv = to_csv(sample_report());
  CHECK(count_of(csv, "\n") == 1 + 4 * 2);
  std::size_t commas = 0;
  for (std::size_t at = 0; at < csv.size();) {
    const std::size_t end = csv.find('\n', at);
    const std::size_t here = count_of(csv.substr(at, end - at), ",");
    if (at == 0) commas = here;
    CAPTURE(csv.substr(at, end - at));
    REQUIRE(here == commas);
    at = end + 1;
  }
}

TEST_CASE("each cell of the CSV stands under its name") {
  auto report = sample_report();
  for (AccuracyRow& row : report.devices[0].accuracies) {
    row.lost = 1;
    row.false_hits = 2;
    row.wrong_primitive = 3;
    row.any_closest_disagree = 4;
  }
  for (TraceRow& row : report.devices[0].traces) row.boxes_per_ray = 25.0;
  std::istringstream lines(to_csv(report));
  std::string head;
  std::string line;
  std::getline(lines, head);
  while (std::getline(lines, line) && line.find(",sah-best,bounce,") == std::string::npos) {
  }
  const auto cells = [](const std::string& text) {
    std::vector<std::string> out{""};
    bool quoted = false;
    for (const char c : text) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted)
        out.emplace_back();
      else
        out.back() += c;
    }
    return out;
  };
  const std::vector<std::string> names = cells(head);
  const std::vector<std::string> values = cells(line);
  REQUIRE(values.size() == names.size());
  std::map<std::string, std::string> of;
  for (std::size_t i = 0; i < names.size(); ++i) of[names[i]] = values[i];
  const std::map<std::string, std::string> expected{{"method", "sah-best"},
                                                    {"rays", "bounce"},
                                                    {"build_s", "4"},
                                                    {"build_rounds", "3"},
                                                    {"bytes", "2097152"},
                                                    {"sah_cost", "40"},
                                                    {"tree_hash", "0123456789abcdef"},
                                                    {"ray_count", "1000"},
                                                    {"trace_ns_per_ray", "2e+06"},
                                                    {"trace_ns_min", "2e+06"},
                                                    {"trace_ns_max", "2500000"},
                                                    {"trace_rounds", "3"},
                                                    {"boxes_per_ray", "25"},
                                                    {"triangles_per_ray", "6"},
                                                    {"judged", "100"},
                                                    {"lost", "1"},
                                                    {"false_hits", "2"},
                                                    {"wrong_primitive", "3"},
                                                    {"any_closest_disagree", "4"},
                                                    {"max_t_error_ulp", "0.5"},
                                                    {"predicted_cost", "30"},
                                                    {"measured_cost", "36"},
                                                    {"measured_standard_error", "0.5"}};
  for (const auto& [name, value] : expected) {
    CAPTURE(name);
    CHECK(of[name] == value);
  }
}

TEST_CASE("bytes come back from base64") {
  for (const std::string& bytes :
       {std::string(), std::string("\0", 1), std::string("\xff\x00\x7f", 3), std::string("four")})
    CHECK(from_base64(to_base64(bytes)) == bytes);
  CHECK(to_base64("any carnal pleas") == "YW55IGNhcm5hbCBwbGVhcw==");
  CHECK_THROWS_AS(from_base64("AA*A"), gnomon::Error);
}
