// A comparison from its options to its files. Feeds the subcommand `compare`.
#pragma once

#include <string>
#include <vector>

#include "console.h"
#include "gnomon/compare/run_device.h"
#include "scene_source.h"

namespace gnomon::app {

struct CompareOptions {
  SceneOptions scene;
  bool no_cache = false;
  std::vector<std::string> devices;
  std::vector<std::string> kinds = compare::default_kinds();
  std::vector<std::string> methods;
  compare::RunOptions run;
  std::string time = "150s";
  std::string clock = "wall";
  std::string page = "report.html";
  std::string rows;  // a file that rows are appended to; empty: none
  bool afresh = false;
};

// Measures, or goes on from rows that are there, and writes page, rows and charts. Returns the exit status: 6
// where a method that promises exact hits has wrong ones. Throws Error as its parts do; what is finished is
// kept.
[[nodiscard]] int compare_methods(const CompareOptions& options, Console& console);

}  // namespace gnomon::app
