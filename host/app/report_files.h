// The files of a comparison: the page and what stands beside it. Feeds `compare`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "gnomon/compare/report.h"

namespace gnomon::app {

// NAME.html, NAME.json, NAME.csv, NAME-CHART.svg.
class ReportFiles {
 public:
  // Throws Error: kInvalidArgument (not .html), kIo (no such folder).
  explicit ReportFiles(const std::string& page);

  [[nodiscard]] std::filesystem::path rows() const { return with(".json"); }
  [[nodiscard]] bool has_rows() const { return std::filesystem::exists(rows()); }
  // Throws Error: kIo, kBadScene (no report).
  [[nodiscard]] compare::Report read_rows() const;
  void keep_rows(const compare::Report& report) const;
  // Returns the number of charts. Throws Error{kIo}.
  std::size_t write_all(const compare::Report& report) const;

 private:
  [[nodiscard]] std::filesystem::path with(const std::string& ending) const;
  std::filesystem::path page_;
};

// Appends the report as rows, one a line. Throws Error{kIo}.
void append_rows(const std::string& file, const compare::Report& report);

}  // namespace gnomon::app
