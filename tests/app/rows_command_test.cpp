// gnomon rows: what counts as a move, which rows belong together, what is no file of rows.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

json spread(double median, double min, double max) {
  return {{"median", median}, {"min", min}, {"max", max}, {"n", 7}};
}

json trace_row(const std::string& rays, double median) {
  return {{"schema", 1},
          {"bench", "spine"},
          {"task", "closest hit"},
          {"commit", "aaaa"},
          {"device", "one"},
          {"driver", "1"},
          {"threads", 1},
          {"scene", "city"},
          {"scene_hash", "0123456789abcdef"},
          {"triangles", 1000},
          {"seed", 1},
          {"clock", "process CPU time"},
          {"rays", rays},
          {"ray_count", 64},
          {"peer", "Embree"},
          {"peer_mode", "default"},
          {"gnomon_mrays_per_s", spread(median, 0.9 * median, 1.1 * median)},
          {"embree_mrays_per_s", spread(5, 4, 6)},
          {"ratio", spread(1, 0.9, 1.2)},
          {"differing_answers", 0}};
}

json prediction_row(double mean, double error) {
  return {{"schema", 1},
          {"bench", "reproduce"},
          {"task", "prediction"},
          {"commit", "aaaa"},
          {"scene", "Wood"},
          {"scene_hash", "0123456789abcdef"},
          {"seed", 1},
          {"rays", "parallel rays"},
          {"ray_count", 1000},
          {"scene_triangles", 50},
          {"area", "plane"},
          {"orientation", "parallel"},
          {"variant", "PAH3"},
          {"measure", "parallel rays"},
          {"real", {{"mean", mean}, {"standard_error", error}}},
          {"predicted", 5.0},
          {"error", 0.0}};
}

json case_row(const json& cost) {
  return {{"schema", 1},   {"bench", "accuracy"}, {"kind", "case"}, {"commit", "aaaa"},  {"device", "one"},
          {"driver", "1"}, {"case", 3},           {"name", "x"},    {"flavour", "wide"}, {"cost", cost}};
}

class Files {
 public:
  std::string put(const std::string& name, const std::vector<json>& rows) {
    std::string text;
    for (const json& row : rows) text += row.dump() + "\n";
    program::write_text(folder_.file(name), text);
    return folder_.file(name);
  }
  // The document of a diff, whose exit status must say the same as it does.
  json diff(const std::vector<json>& before, const std::vector<json>& after,
            const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"rows",   "diff", put("a.jsonl", before), put("b.jsonl", after),
                                   "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = run(words);
    CAPTURE(outcome.err);
    const json document = json::parse(outcome.out);
    CHECK(outcome.status == (document.at("same") == true ? 0 : 7));
    return document;
  }

 private:
  Folder folder_;
};

}  // namespace

TEST_CASE("a figure moved when its ranges have no value in common") {
  Files files;
  CHECK(files.diff({trace_row("primary", 10)}, {trace_row("primary", 10)}).at("same") == true);
  const json within =
      files.diff({trace_row("primary", 10)}, {trace_row("primary", 12.2)});  // 9..11, 10.98..13.42
  CHECK(within.at("same") == true);
  CHECK(within.at("matched") == 1);
  CHECK(within.at("figures") == 4);
  const json beyond = files.diff({trace_row("primary", 10)}, {trace_row("primary", 12.5)});  // 11.25 on
  REQUIRE(beyond.at("moves").size() == 1);
  const json move = beyond.at("moves")[0];
  CHECK(move.at("figure") == "gnomon_mrays_per_s");
  CHECK(move.at("verdict") == "better");
  CHECK(move.at("ratio") == 1.25);
  CHECK(move.at("identity").at("rays") == "primary");
  CHECK_FALSE(move.at("identity").contains("commit"));
  const json slower = files.diff({trace_row("primary", 12.5)}, {trace_row("primary", 10)});
  CHECK(slower.at("moves").at(0).at("verdict") == "worse");
}

TEST_CASE("a figure that one side lacks moved, and one of a single round has no spread to judge by") {
  Files files;
  const auto traced = [](const json& ratio) {
    std::istringstream lines(program::read_text(std::string(GNOMON_RESULTS_FOLDER) + "/compare.jsonl"));
    for (std::string line; std::getline(lines, line);) {
      json row = json::parse(line);
      if (row.at("task") != "trace") continue;
      row["ratio"] = ratio;
      return row;
    }
    throw std::runtime_error("no such row is stored");
  };
  const json many = traced(spread(2, 1.9, 2.1));
  const json none = traced(nullptr);
  json once = traced(spread(9, 9, 9));
  once["ratio"]["n"] = 1;
  const json same = files.diff({many}, {many});
  CHECK(same.at("same") == true);
  for (const auto& [before, after] : {std::pair{many, none}, std::pair{none, many}}) {
    const json moved = files.diff({before}, {after});
    REQUIRE(moved.at("moves").size() == 1);
    CHECK(moved.at("moves")[0].at("figure") == "ratio");
    CHECK(moved.at("moves")[0].at("ratio").is_null());
    CHECK(run({"rows", "diff", files.put("a.jsonl", {before}), files.put("b.jsonl", {after})}).status == 7);
  }
  CHECK(files.diff({none}, {none}).at("same") == true);
  for (const auto& [before, after] : {std::pair{many, once}, std::pair{once, many}}) {
    const json unjudged = files.diff({before}, {after});
    CHECK(unjudged.at("same") == true);
    CHECK(unjudged.at("not_judged").get<int>() == same.at("not_judged").get<int>() + 1);
    CHECK(unjudged.at("figures").get<int>() == same.at("figures").get<int>() - 1);
  }
}

TEST_CASE("a mean moved when it is more than three standard errors of the difference away") {
  Files files;
  CHECK(files.diff({prediction_row(5, 0.3)}, {prediction_row(6.4, 0.4)}).at("same") == true);  // 2.8 of 0.5
  const json moved = files.diff({prediction_row(5, 0.3)}, {prediction_row(6.6, 0.4)});
  CHECK(moved.at("moves").size() == 1);
  CHECK(moved.at("moves").at(0).at("figure") == "real");
}

TEST_CASE("a count moved when it differs, parts of objects each by itself") {
  Files files;
  const json moved =
      files.diff({case_row({{"lost", 3}, {"added", 1}})}, {case_row({{"lost", 2}, {"added", 1}})});
  REQUIRE(moved.at("moves").size() == 1);
  CHECK(moved.at("moves")[0].at("figure") == "cost.lost");
  CHECK(moved.at("moves")[0].at("verdict") == "better");
  CHECK(files.diff({case_row({{"lost", 3}})}, {case_row({{"lost", 3}, {"new", 1}})}).at("moves").size() == 1);
}

TEST_CASE("rows in one file only are named, and of the same measurement the last row counts") {
  Files files;
  const json apart = files.diff({trace_row("primary", 10), trace_row("shadow", 3)},
                                {trace_row("primary", 10), trace_row("bounce", 3)});
  CHECK(apart.at("moves").empty());
  CHECK(apart.at("only_before").at(0).at("rays") == "shadow");
  CHECK(apart.at("only_after").at(0).at("rays") == "bounce");
  json newer = trace_row("primary", 20);
  newer["commit"] = "bbbb";
  const json last = files.diff({trace_row("primary", 10), newer}, {trace_row("primary", 20)});
  CHECK(last.at("same") == true);
  CHECK(last.at("before").at("older") == 1);
  const std::vector<json> both{trace_row("primary", 10), newer};
  const json commits = files.diff(both, both, {"--commit-before", "aa", "--commit-after", "bb"});
  CHECK(commits.at("moves").at(0).at("ratio") == 2.0);
  CHECK(commits.at("before").at("sources").at("commit") == json::array({"aaaa"}));
}

TEST_CASE("devices are told apart unless asked not to be, drivers are not") {
  Files files;
  json other = trace_row("primary", 10);
  other["device"] = "two";
  other["driver"] = "2";
  const json apart = files.diff({trace_row("primary", 10)}, {other});
  CHECK(apart.at("matched") == 0);
  CHECK(apart.at("only_after").size() == 1);
  const json across = files.diff({trace_row("primary", 10)}, {other}, {"--across-devices"});
  CHECK(across.at("same") == true);
  CHECK(across.at("matched") == 1);
  other["device"] = "one";
  CHECK(files.diff({trace_row("primary", 10)}, {other}).at("same") == true);
}

TEST_CASE("the table names what tells rows apart, both figures and the ratio") {
  Files files;
  const auto outcome =
      run({"rows", "diff", files.put("a.jsonl", {trace_row("primary", 10), trace_row("shadow", 3)}),
           files.put("b.jsonl", {trace_row("primary", 20), trace_row("shadow", 3)})});
  CHECK(outcome.status == 7);
  CHECK_THAT(outcome.out, Contains("2 measurements in both, 8 figures compared, 1 moved"));
  CHECK_THAT(outcome.out, Contains("spine, primary") && Contains("10 (9 to 11, n 7)") && Contains("2.000") &&
                              Contains("better"));
  const auto apart =
      run({"rows", "diff", files.put("a.jsonl", {trace_row("primary", 10), trace_row("shadow", 3)}),
           files.put("b.jsonl", {trace_row("primary", 10), trace_row("bounce", 3)})});
  CHECK_THAT(apart.out,
             Contains("only before:\n  spine, shadow\n") && Contains("only after:\n  spine, bounce\n"));
}

TEST_CASE("what is no file of rows exits 4 and names file, line and fault") {
  const Folder folder;
  const std::string good = trace_row("primary", 10).dump() + "\n";
  const auto refusal = [&](const std::string& text) {
    program::write_text(folder.file("x.jsonl"), text);
    const auto outcome = run({"rows", "check", folder.file("x.jsonl")});
    CHECK(outcome.status == 4);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  const auto with = [&](const std::string& field, const json& value) {
    json row = trace_row("primary", 10);
    row[field] = value;
    return good + row.dump() + "\n";
  };
  CHECK_THAT(refusal(good + "{\"bench\": "), Contains("x.jsonl, line 2: not a JSON object"));
  CHECK_THAT(refusal(""), Contains("no rows"));
  CHECK_THAT(refusal(with("bench", "sprint")), Contains("line 2") && Contains("sprint"));
  CHECK_THAT(refusal(with("schema", 2)), Contains("schema 2"));
  CHECK_THAT(refusal(with("bench", 5)), Contains("line 2"));
  CHECK_THAT(refusal(with("triangles", -1)), Contains("triangles is not a count"));
  CHECK_THAT(refusal(with("ratio", 1.5)), Contains("ratio is not a spread"));
  CHECK_THAT(refusal(with("ratio", spread(1, 1.1, 1.2))), Contains("ratio is not a spread"));
  CHECK_THAT(refusal(with("extra", 1)), Contains("extra is unknown"));
  json missing = trace_row("primary", 10);
  missing.erase("ray_count");
  CHECK_THAT(refusal(missing.dump()), Contains("line 1: field ray_count is missing"));
  const auto nowhere = run({"rows", "diff", folder.file("none.jsonl"), folder.file("none.jsonl")});
  CHECK(nowhere.status == 4);
  CHECK(run({"rows"}).status == 2);
  CHECK(run({"rows", "diff", "only-one"}).status == 2);
}

TEST_CASE("stored rows are what their schema says, and each is its own twin") {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GNOMON_RESULTS_FOLDER)) {
    if (entry.path().extension() != ".jsonl") continue;
    const std::string file = entry.path().string();
    CAPTURE(file);
    ++count;
    const auto checked = run({"rows", "check", file});
    CHECK(checked.err == "");
    CHECK(checked.status == 0);
    CHECK(run({"rows", "diff", file, file, "-q"}).status == 0);
  }
  CHECK(count >= 13);
}
