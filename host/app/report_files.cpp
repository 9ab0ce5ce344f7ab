#include "report_files.h"

#include <fstream>
#include <iterator>
#include <span>

#include "gnomon/base/error.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/report_json.h"
#include "gnomon/scene/write_file.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(ErrorCode::kIo, "cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& file, const std::string& text) {
  write_file(file, std::as_bytes(std::span(text)));
}

}  // namespace

ReportFiles::ReportFiles(const std::string& page) : page_(page) {
  if (page_.extension() != ".html")
    throw Error(ErrorCode::kInvalidArgument, "-o " + page + ": the page's name must end with .html");
  const fs::path folder = page_.parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw Error(ErrorCode::kIo, "there is no folder " + folder.string() + " to write " + page + " in");
  if (fs::is_directory(page_)) throw Error(ErrorCode::kIo, "cannot write " + page + ": it is a folder");
}

compare::Report ReportFiles::read_rows() const {
  return compare::from_json_text(read_text(rows()), rows().string());
}

void ReportFiles::keep_rows(const compare::Report& report) const {
  write_text(rows(), to_json_text(report));
}

std::size_t ReportFiles::write_all(const compare::Report& report) const {
  keep_rows(report);
  write_text(with(".csv"), to_csv(report));
  const auto charts = compare::chart_files(report);
  for (const auto& [name, svg] : charts) write_text(with("-" + name + ".svg"), svg);
  write_text(page_, compare::report_page(report));
  return charts.size();
}

void append_rows(const std::string& file, const compare::Report& report) {
  const std::string text = to_rows_text(report);
  append_to_file(file, std::as_bytes(std::span(text)));
}

fs::path ReportFiles::with(const std::string& ending) const {
  return page_.parent_path() / (page_.stem().string() + ending);
}

}  // namespace gnomon::app
