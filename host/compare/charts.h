// The charts of a report. Feeds the page and the .svg files beside it.
#pragma once

#include <string>
#include <vector>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

struct Chart {
  std::string name;    // of its file
  std::string title;   // a sentence's worth
  std::string note;    // how to read it
  std::string inside;  // as part of a page
  std::string file;    // as a file
  bool moves = false;  // with the page's slider
};

// Those that the device's rows allow. Times are medians of rounds by the report's clock.
[[nodiscard]] std::vector<Chart> charts_of(const Report& report, const DeviceReport& device);

// A, B, C ... in the order of the methods.
[[nodiscard]] std::string letter_of(const DeviceReport& device, const std::string& method);
[[nodiscard]] unsigned group_of(const DeviceReport& device, const std::string& method);

// Where the page's slider stands at first.
inline constexpr double kFirstRays = 1e7;

}  // namespace gnomon::compare
