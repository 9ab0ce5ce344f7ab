// What makes pages from rows, or checks them: shared by the programs that do.
#pragma once

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "arguments.h"

namespace page {

inline std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string number(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

inline double geomean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

// A table's cell, behind the bar that ends the one before it.
inline std::string cell_of(const std::string& text) {
  std::string out(" ");
  out += text;
  out += " |";
  return out;
}

// A table's line, and its head, with a blank line above and the rule below.
inline std::string line_of(const std::vector<std::string>& cells) {
  std::string out("|");
  for (const std::string& cell : cells) out += cell_of(cell);
  return out + "\n";
}

inline std::string head_of(const std::vector<std::string>& cells) {
  std::string rule("|");
  for (std::size_t i = 0; i < cells.size(); ++i) rule += "---|";
  std::string out("\n");
  return out.append(line_of(cells)).append(rule).append("\n");
}

// Replaces what stands between "<!-- NAME begin -->" and "<!-- NAME end -->".
inline std::string with_section(const std::string& text, const std::string& name,
                                const std::string& content) {
  const std::string begin = "<!-- " + name + " begin -->\n";
  const std::string end = "<!-- " + name + " end -->";
  const auto from = text.find(begin);
  const auto to = text.find(end);
  if (from == std::string::npos || to == std::string::npos)
    throw std::runtime_error("no markers for " + name);
  return text.substr(0, from + begin.size()) + content + text.substr(to);
}

// One file that is to hold a text: writes it, or, to check, says where it is another.
inline bool settle(const std::string& file, const std::string& text, bool check) {
  if (std::ifstream(file).good() && read(file) == text) return true;
  if (check) {
    std::fprintf(stderr, "%s is not what its rows give; bench/figures.sh writes it anew\n", file.c_str());
    return false;
  }
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
  return true;
}

// The whole program PROGRAM ROWS.jsonl... PAGE.md [--check]: writes what `text_of` makes of all rows' text,
// or, for --check, exits 1 where the page is another.
template <typename TextOf>
int run(int argc, char** argv, const char* program, TextOf text_of) {
  const std::string usage =
      std::string("usage: ") + program +
      " ROWS.jsonl... PAGE.md [--check]\n\nWrites the page that stored rows give, from them alone; "
      "--check: exits 1 where the page is another.\nbash bench/figures.sh makes all of them.\n";
  if (gnomon::bench::taught(argc, argv, usage.c_str())) return 0;
  std::vector<std::string> files(argv + 1, argv + argc);
  const bool check = !files.empty() && files.back() == "--check";
  if (check) files.pop_back();
  if (files.size() < 2) {
    std::fputs(usage.c_str(), stderr);
    return 2;
  }
  const std::string page = files.back();
  files.pop_back();
  try {
    std::string rows;
    for (const std::string& file : files) rows += read(file);
    return settle(page, text_of(rows), check) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
}

}  // namespace page
