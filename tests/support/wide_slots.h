// What slots of wide nodes measure, in double precision, for tests of the wide form.
#pragma once

#include <cstdint>

#include "gnomon/tree/wide.h"

namespace gnomon::test {

inline double half_area(const Node& node) {
  const auto extent = [&](int k) {
    return static_cast<double>(node.hi[k]) - static_cast<double>(node.lo[k]);
  };
  return extent(0) * (extent(1) + extent(2)) + extent(1) * extent(2);
}

inline bool is_leaf(std::uint32_t link) {
  return (link & GN_LEAF_LINK) != 0;
}

inline double slot_half_area(const WideNode& node, std::uint32_t slot) {
  Node box{};
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = node.planes[2 * k][slot];
    box.hi[k] = node.planes[2 * k + 1][slot];
  }
  return half_area(box);
}

}  // namespace gnomon::test
