#include "gnomon/tree/build_options.h"

#include <bit>
#include <string>

namespace gnomon {

namespace {

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (!ok) {
    throw Error(ErrorCode::kInvalidArgument,
                std::string("build option ") + option + " = " + value + " is outside its range " + range);
  }
}

// 0 means "the device decides" for the options that only say how to work.
void require_or_zero(std::uint32_t value, std::uint32_t low, std::uint32_t high, const char* option,
                     const char* range) {
  require(value == 0 || (value >= low && value <= high), option, std::to_string(value), range);
}

}  // namespace

const char* to_string(Heuristic heuristic) {
  switch (heuristic) {
    case Heuristic::kSah:
      return "sah";
  }
  return "unknown";
}

void BuildOptions::check() const {
  require(heuristic == Heuristic::kSah, "heuristic", std::to_string(static_cast<unsigned>(heuristic)),
          "{sah}");
  require(bins >= 2 && bins <= 64, "bins", std::to_string(bins), "2..64");
  require(max_leaf_size >= 1 && max_leaf_size <= 255, "max_leaf_size", std::to_string(max_leaf_size),
          "1..255");
  require(cost_traversal > 0.0F && cost_traversal <= 1000.0F, "cost_traversal",
          std::to_string(cost_traversal), "(0, 1000]");
  require(cost_triangle > 0.0F && cost_triangle <= 1000.0F, "cost_triangle", std::to_string(cost_triangle),
          "(0, 1000]");
  require(median_depth >= 1 && median_depth <= 64, "median_depth", std::to_string(median_depth), "1..64");
  require_or_zero(work_group_size, 1, 256, "work_group_size", "{0, powers of two up to 256}");
  require(work_group_size == 0 || std::has_single_bit(work_group_size), "work_group_size",
          std::to_string(work_group_size), "{0, powers of two up to 256}");
  require_or_zero(subtree_size, 32, 1048576, "subtree_size", "{0, 32..1048576}");
  require_or_zero(chunk_size, 64, 1048576, "chunk_size", "{0, 64..1048576}");
}

}  // namespace gnomon
