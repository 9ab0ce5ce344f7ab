// What makes pages from rows, or checks them: shared by the programs that do.
#pragma once

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

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

// The whole program PROGRAM ROWS.jsonl PAGE.md [--check]: writes what `text_of` makes of the rows' text, or,
// for
// --check, exits 1 where the page is another.
template <typename TextOf>
int run(int argc, char** argv, const char* program, TextOf text_of) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s ROWS.jsonl PAGE.md [--check]\n", program);
    return 2;
  }
  try {
    const std::string text = text_of(read(argv[1]));
    if (argc > 3 && std::string(argv[3]) == "--check") {
      if (read(argv[2]) == text) return 0;
      std::fprintf(stderr, "%s is not what %s gives; run %s %s %s\n", argv[2], argv[1], program, argv[1],
                   argv[2]);
      return 1;
    }
    std::ofstream out(argv[2], std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error(std::string("cannot write ") + argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
  return 0;
}

}  // namespace page
