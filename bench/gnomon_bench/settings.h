// What gnomon_bench is asked to measure, as its command line says it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/tree/build_options.h"
#include "gnomon/tree/wide.h"

namespace gnomon::bench {

// A block tests eight triangles at the price of about two visits: leaves near that size are right, and the
// collapse merges smaller ones anyway.
inline BuildOptions options_for_wide_trees() {
  BuildOptions options;
  options.cost_triangle = 0.25F;
  return options;
}

struct Settings {
  std::vector<std::string> scenes{"atrium", "city", "terrain", "random"};
  std::uint64_t triangles = 1'000'000;
  std::vector<std::string> rays{"primary",  "bounce",      "bounce-shuffled", "shadow",
                                "sun-axis", "sun-oblique", "random"};
  std::vector<std::string> flavours{"auto", "wide"};
  std::vector<std::string> builders{"balanced"};
  std::uint64_t ray_count = 262'144;
  std::uint64_t seed = 1;
  int rounds = 7;
  bool all_threads = false;
  bool build = true;
  BuildOptions options = options_for_wide_trees();
  CollapseOptions collapse;
};

void add_options(CLI::App& program, Settings& settings);

}  // namespace gnomon::bench
