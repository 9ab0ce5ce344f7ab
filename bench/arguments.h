// For programs of this folder that read their own arguments: those with many options use CLI11. Feeds the
// files of this folder.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gnomon::bench {

// Whether -h or --help is among the arguments; then `text` is printed, and there is nothing left to do.
inline bool taught(int argc, char** argv, const char* text) {
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) != "--help" && std::string_view(argv[i]) != "-h") continue;
    std::fputs(text, stdout);
    return true;
  }
  return false;
}

// A count of at least 1. Throws invalid_argument naming `what` for another text.
inline std::uint64_t count_from(const char* text, const std::string& what) {
  char* end = nullptr;
  const std::uint64_t count = std::strtoull(text, &end, 10);
  if (end == text || *end != '\0' || *text == '-' || count == 0)
    throw std::invalid_argument(what + " \"" + text + "\": a count is wanted; --help says more");
  return count;
}

}  // namespace gnomon::bench
