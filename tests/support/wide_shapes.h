// Binary trees for tests of the wide form: shapes that a collapse can go wrong on, with the options to build
// them.
#pragma once

#include <string>
#include <vector>

#include "gnomon/tree/build_options.h"
#include "support/shapes.h"

namespace gnomon::test {

struct WideShape {
  std::string name;
  std::vector<GnTriangle> triangles;
  BuildOptions options;
};

inline BuildOptions leaves_of(std::uint32_t max_leaf_size) {
  BuildOptions options;
  options.max_leaf_size = max_leaf_size;
  return options;
}

// Leaves as large as max_leaf_size allows, whatever they cost.
inline BuildOptions lazy_leaves_of(std::uint32_t max_leaf_size) {
  BuildOptions options = leaves_of(max_leaf_size);
  options.cost_traversal = 1000.0F;
  return options;
}

// Every leaf has more triangles than the wide form takes (GN_MAX_WIDE_LEAF); for triangles in one place.
inline BuildOptions leaves_too_large() {
  BuildOptions options;
  options.published_leaves.on = true;
  return options;
}

inline std::vector<WideShape> wide_shapes() {
  std::vector<WideShape> out;
  for (auto& [name, triangles] : awkward_inputs()) {
    out.push_back({name, triangles, {}});
    out.push_back({name + ", one a leaf", std::move(triangles), leaves_of(1)});
  }
  for (const std::uint32_t count : {7U, 8U, 9U, 16U, 17U, 31U, 32U, 33U, 64U, 65U}) {
    out.push_back({"soup of " + std::to_string(count), soup(count, 80 + count), leaves_of(1)});
    out.push_back(
        {"one leaf of " + std::to_string(count), soup(count, 80 + count, 5.0F), lazy_leaves_of(255)});
  }
  out.push_back({"soup", soup(1500, 81), {}});
  out.push_back({"grid", grid(20, 2.0F), {}});
  BuildOptions two_bins = leaves_of(1);
  two_bins.bins = 2;
  out.push_back({"deep", awkward_inputs()[8].second, two_bins});
  out.push_back({"leaves up to 255", soup(1500, 82, 4.0F), lazy_leaves_of(255)});
  out.push_back({"copies in leaves up to 255", repeated(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1000),
                 lazy_leaves_of(255)});
  return out;
}

}  // namespace gnomon::test
