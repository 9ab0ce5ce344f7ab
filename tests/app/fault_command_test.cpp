// The program on a device that fails: an error with a message and an exit status, nothing alive at its end,
// and no file that is half written.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <sstream>

#include "run_program.h"

using program::Folder;
using program::run;

namespace {

// What the preloaded layer says at the end: the call that failed, and the references still held.
struct Report {
  std::string failed;
  std::vector<long> alive;
};

Report read_report(const std::string& file) {
  std::istringstream text(program::read_text(file));
  Report report;
  text >> report.failed;
  for (long count = 0; text >> count;) report.alive.push_back(count);
  return report;
}

// Runs with ever later calls failing, about one in `every` of them, until none is reached; each time in a
// fresh folder, where `file` is either not there or whole.
void fail_calls(const std::vector<std::string>& arguments, const std::string& file, double every,
                std::size_t least_kinds) {
  std::uintmax_t whole = 0;
  {
    const Folder folder;
    std::vector<std::string> words = arguments;
    words.push_back(folder.file(file));
    const auto outcome = run(words);
    CAPTURE(outcome.err);
    REQUIRE(outcome.status == 0);
    whole = std::filesystem::file_size(folder.file(file));
  }
  std::set<std::string> kinds;
  for (double at = 1.0;; at = std::max(at + 1.0, at * every)) {
    const Folder folder;
    const Folder reports;
    const std::string report_file = reports.file("report");
    program::Setup setup;
    setup.environment = {{"LD_PRELOAD", GNOMON_FAULT_LAYER},
                         {"GNOMON_FAULT_AT", std::to_string(static_cast<std::uint64_t>(at))},
                         {"GNOMON_FAULT_REPORT", report_file}};
    std::vector<std::string> words = arguments;
    words.push_back(folder.file(file));
    const auto outcome = run(words, setup);
    const Report report = read_report(report_file);
    CAPTURE(at, report.failed, outcome.status, outcome.err);
    REQUIRE(report.alive == std::vector<long>(6, 0));
    REQUIRE(outcome.status < 1000);
    if (outcome.status == 0) {
      REQUIRE(std::filesystem::file_size(folder.file(file)) == whole);
    } else {
      REQUIRE(outcome.err.find("error:") != std::string::npos);
      REQUIRE(folder.names().empty());
      kinds.insert(report.failed);
    }
    if (report.failed == "none") {
      REQUIRE(outcome.status == 0);
      break;
    }
  }
  REQUIRE(kinds.size() >= least_kinds);
}

}  // namespace

TEST_CASE("trace --hits-out writes all hits or no file") {
  fail_calls({"trace", "gen:random:300", "--count", "200", "--repeat", "1", "--hits-out"}, "hits.bin", 1.12,
             6);
}

TEST_CASE("stability --rows writes all rows or none") {
  fail_calls({"stability", "--only", "12", "--rays-per-case", "20", "--rows"}, "rows.jsonl", 1.2, 5);
}

TEST_CASE("render -o writes a whole picture or none") {
  fail_calls({"render", "gen:random:300", "--width", "32", "--height", "24", "--preview", "1", "-o"},
             "picture.png", 1.3, 4);
}
