// What the thesis published, one row a test, read from a CSV file. Feeds the comparison with our own figures.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "gnomon/measure/set_up.h"

namespace gnomon {

struct PublishedRow {
  std::string flag;  // why the row is not what it says; mostly empty
  double local_cost = 0.0;
  double total_cost = 0.0;   // with the fallback
  double global_cost = 0.0;  // of the global tree alone
  double hit_share = 0.0;    // of any tree
  double predicted_pah = 0.0;
  double predicted_sah = 0.0;
  double overlap_4 = 0.0;  // culled, to level 4
  double overlap_7 = 0.0;
  double overlap_10 = 0.0;
  double overlap_15 = 0.0;
  double overlap_all = 0.0;
  double max_level = 0.0;
  double planes_tried = 0.0;  // axes, an inner node
};

// By key_of.
using PublishedResults = std::map<std::string, PublishedRow>;
[[nodiscard]] std::string key_of(const SetUp& set_up, std::string_view variant);

// Reads comma-separated rows, columns by the names in the first; no quoting. Throws Error: kIo (cannot be
// read), kInvalidArgument (a column is missing, a row is short, a number is none), naming file, line and
// column.
[[nodiscard]] PublishedResults read_published_results(const std::filesystem::path& file);

}  // namespace gnomon
