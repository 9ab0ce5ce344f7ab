// What a caller may ask of a builder, with ranges. Feeds the reference builder and the device builder alike.
#pragma once

#include <cstdint>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {

// Which estimate of a box's hit probability decides the splits (Goldsmith & Salmon 1987; MacDonald & Booth
// 1990).
enum class Heuristic : std::uint32_t {
  kSah = 0,  // surface area: rays uniform in origin and direction
};
[[nodiscard]] const char* to_string(Heuristic heuristic);

struct BuildOptions {
  Heuristic heuristic = Heuristic::kSah;
  std::uint32_t bins = 16;          // per axis, 2..64
  std::uint32_t max_leaf_size = 8;  // triangles, 1..255
  float cost_traversal = 1.0F;      // of visiting an inner node, in the unit of cost_triangle; (0, 1000]
  float cost_triangle = 1.0F;       // of testing one triangle; (0, 1000]
  std::uint32_t median_depth =
      64;  // from this depth on nodes are halved by count: bounds depth at + log2(n); 1..64

  // How the device works, never what it builds: 0 asks the device.
  std::uint32_t work_group_size = 0;  // power of two up to 256; 1: the serial flavour
  std::uint32_t subtree_size = 0;     // triangles one work-group builds alone; 32..1048576
  std::uint32_t chunk_size = 0;       // triangles one work-group bins in a large node; 64..1048576

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

}  // namespace gnomon
