// Writes README's speed table from stored rows, between its markers, or checks that what stands there is what
// the rows say. Also keeps README's example equal to the file the tests compile.
//
//   readme_table ROWS.jsonl EXAMPLE.cpp README.md [--check]
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

#include "page_file.h"

namespace {

using nlohmann::json;

std::string spread(const json& s) {
  const auto number = [](const json& value) { return page::number(value, "%.2f"); };
  return number(s.at("median")) + " (" + number(s.at("min")) + "–" + number(s.at("max")) + ")";
}

// What one line of the table shows; rows of the two peer modes meet in it.
struct Line {
  std::string ours;
  std::map<std::string, std::string> ratio;
};

std::string table(const std::string& rows) {
  using Key = std::tuple<std::string, std::uint64_t, int, std::string>;  // scene, triangles, order, what
  std::map<Key, Line> lines;
  json last;
  std::istringstream in(rows);
  std::vector<json> all;
  for (std::string text; std::getline(in, text);) {
    if (text.empty()) continue;
    const json row = json::parse(text);
    if (row.at("schema") == 1 && row.at("bench") == "spine") all.push_back(row);
  }
  if (!all.empty()) last = all.back();
  for (const json& row : all) {
    // One table, one commit and device: the newest.
    if (row.at("commit") != last.at("commit") || row.at("device") != last.at("device")) continue;
    const bool build = row.at("task") == "build";
    const std::string what =
        build ? "build" : row.at("task").get<std::string>() + ", " + row.at("rays").get<std::string>();
    Line& line = lines[{row.at("scene"), row.at("triangles"), build ? 0 : 1, what}];
    line.ours = spread(row.at(build ? "gnomon_mtris_per_s" : "gnomon_mrays_per_s")) +
                (build ? " Mtris/s" : " Mrays/s");
    line.ratio[row.value("peer_mode", "default")] = spread(row.at("ratio"));
  }
  if (lines.empty()) throw std::runtime_error("no rows of bench spine, schema 1");
  std::string out =
      "One thread, process CPU time, paired in one process with " + last.at("peer").get<std::string>() +
      " on " + last.at("device").get<std::string>() + " (driver " + last.at("driver").get<std::string>() +
      "), " + std::to_string(last.at("ratio").at("n").get<int>()) + " rounds, commit " +
      last.at("commit").get<std::string>() +
      ".\nRatios are median (min–max) of Embree's time over ours: above 1 we are faster. Rates move with "
      "the machine, ratios less; those of builds most (host/notes/two-flavours.md).\n\n| scene | task | "
      "gnomon | against default | against ROBUST |\n"
      "|---|---|---|---|---|\n";
  for (const auto& [key, line] : lines) {
    const auto ratio = [&](const char* mode) {
      return line.ratio.contains(mode) ? line.ratio.at(mode) : "–";
    };
    out += "| " + std::get<0>(key) + ", " + std::to_string(std::get<1>(key)) + " triangles | " +
           std::get<3>(key) + " | " + line.ours + " | " + ratio("default") + " | " + ratio("ROBUST") + " |\n";
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const char* const usage =
      "usage: readme_table ROWS.jsonl EXAMPLE.cpp README.md [--check]\n\nWrites README's table of speed from "
      "rows of "
      "spine_bench, and its example from the file that tests compile; --check:\nexits 1 where README has "
      "another.\n";
  if (gnomon::bench::taught(argc, argv, usage)) return 0;
  if (argc < 4) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    const std::string before = page::read(argv[3]);
    const std::string example = "```cpp\n" + page::read(argv[2]) + "```\n";
    const std::string after = page::with_section(
        page::with_section(before, "speed", table(page::read(argv[1]))), "example", example);
    if (argc > 4 && std::string(argv[4]) == "--check") {
      if (after != before)
        std::fprintf(stderr, "README.md is behind its rows or example: run readme_table without --check\n");
      return after == before ? 0 : 1;
    }
    std::ofstream(argv[3], std::ios::binary) << after;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "readme_table: %s\n", error.what());
    return 1;
  }
  return 0;
}
