// gnomon compare from end to end on tiny scenes: rows, page, time, Ctrl-C and going on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compared_methods.h"
#include "run_program.h"

using Catch::Contains;
using nlohmann::json;
using program::Folder;
using program::run;

namespace {

std::vector<std::string> command(const std::string& page, const std::vector<std::string>& more = {},
                                 const std::string& rounds = "3", const std::string& rays = "2k") {
  std::vector<std::string> words{"compare",
                                 "gen:cottage:7k",
                                 "--methods",
                                 program::kComparedMethods,
                                 "--rays",
                                 "primary,shadow,light",
                                 "--ray-count",
                                 rays,
                                 "--judged-rays",
                                 "300",
                                 "--rounds",
                                 rounds,
                                 "-o",
                                 page};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<json> rows_of(const json& report, const std::string& task) {
  std::vector<json> rows;
  for (const json& row : report.at("devices").at(0).at("rows"))
    if (row.at("task") == task) rows.push_back(row);
  return rows;
}

// Rows without what the clock gave.
json timeless(const json& report) {
  json rows = report.at("devices").at(0).at("rows");
  for (json& row : rows) {
    // What Embree's allocator holds depends on which thread asked first.
    if (row.at("method").is_string() && row.at("method").get<std::string>().starts_with("embree"))
      row.erase("bytes");
    for (const char* field : {"wall_s", "cpu_s", "real_time", "cpu_time", "passes", "ratio", "build_ratio",
                              "trace_ratio", "build_wall_s", "build_cpu_s", "trace_wall_s", "trace_cpu_s"})
      row.erase(field);
  }
  return rows;
}

json read_report(const Folder& folder) {
  return json::parse(program::read_text(folder.file("r.json")));
}

}  // namespace

TEST_CASE("compare measures every method on the same rays and writes page, rows and charts") {
  const Folder folder;
  const auto begun = std::chrono::steady_clock::now();
  // None of what decides the rows is as it would be without a word.
  const std::vector<std::string> chosen{"--seed", "3",  "--clock",   "cpu",
                                        "--time", "9m", "--invalid", "reject"};
  std::vector<std::string> more{"--json", "--quiet", "--rows", folder.file("r.jsonl")};
  more.insert(more.end(), chosen.begin(), chosen.end());
  const auto outcome = run(command(folder.file("r.html"), more));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.status == 0);
  const json document = json::parse(outcome.out);
  REQUIRE(document.at("devices").at(0).at("advice").at(0).get<std::string>().size() > 20);
  const json report = read_report(folder);
  REQUIRE(report.at("schema") == 1);
  REQUIRE(report.at("complete") == true);

  std::set<std::string> methods;
  for (const json& row : rows_of(report, "build")) {
    CAPTURE(row.dump());
    methods.insert(row.at("method"));
    REQUIRE(row.at("wall_s").size() == 3);
    REQUIRE(row.at("bytes") > 0);
  }
  for (const char* name :
       {"sah-balanced", "sah-fast", "sah-best", "pah-window@light", "pah-window+spfh@light",
        "pah-window+lsph@light", "pah-window+sah@light", "sah-balanced/fast-hits", "auto"}) {
    CAPTURE(name);
    REQUIRE(methods.contains(name));
  }
  REQUIRE(methods.contains("embree-robust") == program::kHasPeers);
  REQUIRE_FALSE(methods.contains("pah-near-plane@camera"));  // not asked for

  const auto traces = rows_of(report, "trace");
  REQUIRE(traces.size() == methods.size() * 3);
  double in_rounds = 0.0;
  for (const json& row : traces) {
    CAPTURE(row.dump());
    REQUIRE(row.at("passes") > 1);  // so few rays
    for (const double seconds : row.at("wall_s")) in_rounds += seconds * row.at("passes").get<double>();
    REQUIRE(row.at("wall_s").size() == 3);
    REQUIRE(row.at("ray_count").get<int>() > 200);
    if (row.at("method").get<std::string>().starts_with("embree")) continue;
    REQUIRE(row.at("boxes_per_ray") > 1.0);
    REQUIRE(row.at("triangles_per_ray") > 0.0);
  }
  REQUIRE(in_rounds < took.count());
  // Trees differ, answers do not.
  for (const json& row : rows_of(report, "accuracy")) {
    CAPTURE(row.dump());
    const std::string method = row.at("method");
    if (method.starts_with("embree") || method.ends_with("fast-hits")) continue;
    REQUIRE(row.at("lost").get<int>() + row.at("false_hits").get<int>() +
                row.at("wrong_primitive").get<int>() ==
            0);
    REQUIRE(row.at("same_as") == (method == "sah-balanced" ? json(nullptr) : json("sah-balanced")));
    REQUIRE(row.at("judged") > 100);
  }
  // What the light's heuristic expects of the light's rays is what they cost, within sampling.
  bool predicted = false;
  for (const json& row : rows_of(report, "prediction")) {
    if (row.at("method") != "pah-window@light" || row.at("rays") != "light") continue;
    predicted = true;
    const double off = row.at("measured").get<double>() - row.at("predicted").get<double>();
    REQUIRE(std::abs(off) < 5.0 * row.at("standard_error").get<double>());
  }
  REQUIRE(predicted);

  // A plan's decision for each kind of rays asked for, and for each light alone.
  std::set<std::string> decided;
  for (const json& row : rows_of(report, "decision")) {
    CAPTURE(row.dump());
    decided.insert(row.at("rays").get<std::string>());
    REQUIRE(row.at("method") == "auto");
    REQUIRE(row.at("reason").get<std::string>().size() > 3);
    REQUIRE(row.at("cost") <= row.at("baseline_cost"));
    REQUIRE(row.at("planning_share") > 0.0);
  }
  for (const char* rays : {"primary", "shadow", "light"}) {
    CAPTURE(rays);
    REQUIRE(decided.contains(rays));
  }
  // Sizes rise fourfold to the scene's own; the whole scene's build has a ratio to the baseline's.
  std::set<int> sizes;
  for (const json& row : rows_of(report, "size")) {
    CAPTURE(row.dump());
    sizes.insert(row.at("size").get<int>());
    REQUIRE(row.at("thinned") == true);  // no cottage has fewer triangles
    REQUIRE(row.at("build_wall_s").size() >= 1);
    REQUIRE(row.at("build_ratio").at("median") > 0.0);
    REQUIRE(row.at("trace_ratio").at("median") > 0.0);
  }
  REQUIRE(sizes.size() >= 2);
  REQUIRE(*sizes.rbegin() == report.at("triangles"));
  // The same rays through each tree of a light.
  std::map<std::string, std::set<int>> counts;
  std::map<std::string, std::set<std::string>> area_methods;
  for (const json& row : rows_of(report, "area")) {
    CAPTURE(row.dump());
    counts[row.at("area")].insert(row.at("ray_count").get<int>());
    area_methods[row.at("area")].insert(row.at("method").get<std::string>());
    REQUIRE(row.at("boxes_per_ray") > 0.0);
  }
  REQUIRE_FALSE(counts.empty());
  for (const auto& [area, rays] : counts) {
    CAPTURE(area);
    REQUIRE(rays.size() == 1);
    REQUIRE(area_methods.at(area) == std::set<std::string>{"auto", "pah", "sah-balanced"});
    REQUIRE(decided.contains(area));
  }
  // Rows of a file are what their schema says, and their own twins.
  REQUIRE(run({"rows", "check", folder.file("r.jsonl"), "-q"}).err == "");
  REQUIRE(run({"rows", "diff", folder.file("r.jsonl"), folder.file("r.jsonl"), "-q"}).status == 0);

  const auto names = folder.names();
  std::size_t charts = 0;
  for (const std::string& name : names) charts += name.ends_with(".svg") ? 1 : 0;
  REQUIRE(charts == document.at("charts"));
  REQUIRE(charts >= 10);
  const std::string page = program::read_text(folder.file("r.html"));
  REQUIRE_THAT(
      page, Contains("pareto-accuracy") && Contains("data:image/png;base64,") && !Contains("not complete"));

  // The command that the report names, and no other word, gives the same counts again: only times differ.
  std::istringstream said(report.at("command").get<std::string>());
  std::vector<std::string> words{std::istream_iterator<std::string>(said), {}};
  REQUIRE(words.at(0) == "gnomon");
  REQUIRE(words.back() == folder.file("r.html"));
  for (const char* option : {"--rays", "--methods", "--ray-count", "--judged-rays", "--rounds", "--seed",
                             "--time", "--clock", "--invalid"}) {
    CAPTURE(option);
    REQUIRE(std::count(words.begin(), words.end(), option) == 1);
  }
  for (std::size_t i = 0; i < chosen.size(); i += 2) {
    CAPTURE(chosen[i]);
    REQUIRE(*(std::find(words.begin(), words.end(), chosen[i]) + 1) == chosen[i + 1]);
  }
  words.erase(words.begin());
  words.back() = folder.file("repeated.html");
  const auto repeated = run(words);
  CAPTURE(repeated.err);
  REQUIRE(repeated.status == 0);
  const json second = json::parse(program::read_text(folder.file("repeated.json")));
  REQUIRE(second.at("options") == report.at("options"));
  REQUIRE(second.at("clock") == report.at("clock"));
  REQUIRE(timeless(second) == timeless(report));

  // All is finished: the same command measures nothing and writes the same bytes.
  const std::string csv = program::read_text(folder.file("r.csv"));
  const auto again = run(command(folder.file("r.html"), chosen));
  CAPTURE(again.err);
  REQUIRE(again.status == 0);
  REQUIRE_THAT(again.err, Contains("going on from"));
  REQUIRE(program::read_text(folder.file("r.html")) == page);
  REQUIRE(program::read_text(folder.file("r.csv")) == csv);

  // Other options are other work.
  auto others = chosen;
  others[1] = "2";
  const auto other = run(command(folder.file("r.html"), others));
  REQUIRE(other.status == 0);
  REQUIRE_THAT(other.err, Contains("measuring anew"));
  REQUIRE(program::read_text(folder.file("r.html")) != page);
}

TEST_CASE("Ctrl-C keeps what is finished, and the same command goes on from there") {
  const Folder folder;
  program::Setup setup;
  setup.terminal = true;
  setup.environment["TERM"] = "xterm";
  setup.interrupt_at = "trace shadow";
  // Enough rounds that the progress line, which is not drawn at every step, shows the stage.
  const auto longer = command(folder.file("r.html"), {}, "20", "50k");
  const auto stopped = run(longer, setup);
  CAPTURE(stopped.err);
  REQUIRE(stopped.status == 130);
  REQUIRE_THAT(stopped.err, Contains("the same command goes on from there"));
  const json kept = read_report(folder);
  REQUIRE(kept.at("complete") == false);
  const auto builds = rows_of(kept, "build");
  REQUIRE_FALSE(builds.empty());
  REQUIRE(builds.front().at("wall_s").size() == 20);
  REQUIRE_FALSE(std::filesystem::exists(folder.file("r.html")));

  const auto resumed = run(longer);
  CAPTURE(resumed.err);
  REQUIRE(resumed.status == 0);
  const json whole = read_report(folder);
  REQUIRE(whole.at("complete") == true);
  REQUIRE(rows_of(whole, "build") == builds);  // not measured again
  std::set<std::string> kinds;
  for (const json& row : rows_of(whole, "trace")) kinds.insert(row.at("rays").get<std::string>());
  REQUIRE(kinds == std::set<std::string>{"light", "primary", "shadow"});
}

TEST_CASE("where time is short less is measured, and the page says what was left out") {
  const Folder folder;
  const auto outcome = run(command(folder.file("r.html"), {"--time", "0.01s"}));
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const json report = read_report(folder);
  REQUIRE(report.at("complete") == true);
  REQUIRE_FALSE(rows_of(report, "left_out").empty());
  REQUIRE(rows_of(report, "build").size() == 1);  // the baseline always runs
  REQUIRE_THAT(program::read_text(folder.file("r.html")),
               Contains("What was left out") && Contains("the budget is"));
  REQUIRE_THAT(outcome.err, Contains("left out: "));
}

TEST_CASE("what a budget leaves goes to what it cut short, and rows stay one of each, in order") {
  const Folder folder;
  // More rays than any time here is enough for.
  const auto begun = std::chrono::steady_clock::now();
  const auto outcome = run(command(folder.file("r.html"), {"--time", "6s"}, "3", "30M"));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(took.count() < 12.0);  // the kernels may have to be compiled
  const json report = read_report(folder);
  std::vector<std::string> order;
  std::map<std::string, std::uint64_t> counts;
  for (const std::string task : {"trace", "accuracy"}) {
    std::set<std::pair<std::string, std::string>> seen;
    order.clear();
    for (const json& row : rows_of(report, task)) {
      const std::string kind = row.at("rays");
      CHECK(seen.emplace(kind, row.at("method")).second);
      if (order.empty() || order.back() != kind) order.push_back(kind);
      if (task == "trace") counts[kind] = row.at("ray_count");
    }
    CHECK(order == std::vector<std::string>{"primary", "shadow", "light"});
  }
  std::map<std::string, int> said;
  for (const json& row : rows_of(report, "left_out")) {
    const std::string what = row.at("what");
    const std::string reason = row.at("reason");
    if (!what.starts_with("trace ") || reason.find("rays instead of 30000000") == std::string::npos) continue;
    ++said[what.substr(6)];
    // Of those that were drawn: shadow rays are those of points that were met.
    CHECK(std::stoull(reason) >= counts.at(what.substr(6)));
    CHECK(counts.at(what.substr(6)) * 2 > std::stoull(reason));
  }
  CHECK(said == std::map<std::string, int>{{"primary", 1}, {"shadow", 1}, {"light", 1}});
}

TEST_CASE("a scene from a file is made smaller by leaving triangles out, and the page says so") {
  const Folder folder;
  REQUIRE(run({"scene", "cottage", "--triangles", "7k", "-o", folder.file("c.glb"), "-q"}).status == 0);
  const auto outcome = run({"compare", folder.file("c.glb"), "--methods", "sah-fast", "--rays", "primary",
                            "--ray-count", "2k", "--rounds", "1", "-o", folder.file("r.html"), "--quiet"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto sizes = rows_of(read_report(folder), "size");
  REQUIRE(sizes.size() == 6);
  for (const json& row : sizes) REQUIRE(row.at("thinned") == true);
  REQUIRE_THAT(program::read_text(folder.file("r.html")), Contains("triangles left out evenly"));
}

TEST_CASE("several devices have a section each, and one table of rounds that took turns") {
  const Folder folder;
  program::Setup setup;
  setup.environment["POCL_DEVICES"] = "pthread basic";
  const auto outcome = run({"compare", "gen:random:7k", "--methods", "sah-balanced/portable", "--rays",
                            "primary", "--devices", "0,1", "--ray-count", "2k", "--judged-rays", "100",
                            "--rounds", "2", "-o", folder.file("r.html"), "--rows", folder.file("r.jsonl")},
                           setup);
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const json report = read_report(folder);
  REQUIRE(report.at("devices").size() == 2);
  std::set<std::string> hashes;
  for (const json& device : report.at("devices")) {
    std::size_t across = 0;
    for (const json& row : device.at("rows")) {
      if (row.at("task") == "build" && row.at("method") == "sah-balanced")
        hashes.insert(row.at("tree_hash").get<std::string>());
      if (row.at("task") == "size") REQUIRE(row.at("thinned") == false);
      if (row.at("task") != "across") continue;
      CAPTURE(row.dump());
      ++across;
      REQUIRE(row.at("wall_s").size() == 2);
      REQUIRE(row.at("ratio").at("n") == 2);
      REQUIRE((row.at("rays").is_null() || row.at("ray_count") == 2000));
    }
    REQUIRE(across == 2);
  }
  REQUIRE(hashes.size() == 1);
  REQUIRE_THAT(program::read_text(folder.file("r.html")), Contains("<table class=\"devices\">"));
  REQUIRE(run({"rows", "check", folder.file("r.jsonl"), "-q"}).err == "");
}

TEST_CASE("a file of rays is a kind of rays") {
  const Folder folder;
  REQUIRE(run({"trace", "gen:cottage:7k", "--count", "1000", "--rays-out", folder.file("my.rays"), "--quiet"})
              .status == 0);
  const auto outcome = run({"compare", "gen:cottage:7k", "--methods", "sah-fast", "--rays",
                            folder.file("my.rays"), "--rounds", "1", "-o", folder.file("r.html"), "--quiet"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto traces = rows_of(read_report(folder), "trace");
  REQUIRE(traces.size() == 2);
  REQUIRE(traces[0].at("ray_count") == 1000);
}

TEST_CASE("what makes no sense is refused before anything is measured") {
  const Folder folder;
  const std::string page = folder.file("r.html");
  const auto refused = [&](const std::vector<std::string>& words, int status, const std::string& message) {
    std::vector<std::string> all{"compare", "gen:random:100"};
    all.insert(all.end(), words.begin(), words.end());
    const auto outcome = run(all);
    CAPTURE(outcome.err, words);
    REQUIRE(outcome.status == status);
    REQUIRE_THAT(outcome.err, Contains(message));
  };
  refused({"-o", folder.file("r.txt")}, 2, "must end with .html");
  refused({"-o", folder.file("nowhere/r.html")}, 1, "no folder");
  refused({"-o", page, "--time", "soon"}, 2, "write 60s");
  refused({"-o", page, "--methods", "bvh9"}, 2, "sah-balanced");
  refused({"-o", page, "--rays", "sideways"}, 4, "anything else is a file of rays");
  refused({"-o", page, "--devices", "no such device"}, 3, "no such device");
  refused({"-o", page, "--rounds", "0"}, 2, "--rounds");
  refused({"-o", page, "--rows", folder.file("nowhere/rows.jsonl")}, 1, "No such file");
  std::filesystem::create_directory(folder.file("folder.html"));
  refused({"-o", folder.file("folder.html")}, 1, "it is a folder");
  program::write_text(folder.file("r.json"), "not a report");
  refused({"-o", page}, 4, "not a report that can be gone on from");
}
