// A report as one HTML file that needs nothing else: words, charts, pictures, rows, and a slider. Feeds the
// command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

// The same report, the same bytes.
[[nodiscard]] std::string report_page(const Report& report);

// Names and texts of the charts as files; with several devices each has its own, numbered from 1.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> chart_files(const Report& report);

}  // namespace gnomon::compare
