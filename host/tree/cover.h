// Whether boxes hold all of a triangle between them, as the leaves must in which a triangle's parts are. In
// double precision; not for builders. Feeds the checks of trees.
#pragma once

#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// Boxes of nodes by triangle.
class TriangleBoxes {
 public:
  explicit TriangleBoxes(std::size_t triangles) : boxes_(triangles) {}
  void add(std::size_t triangle, const Node& box) { boxes_[triangle].push_back(box); }
  [[nodiscard]] std::span<const Node> of(std::size_t triangle) const { return boxes_[triangle]; }

 private:
  std::vector<std::vector<Node>> boxes_;
};

// False where a strip of the triangle as wide as rounding to float makes one, or a corner, is in none of the
// boxes.
[[nodiscard]] bool boxes_cover(const GnTriangle& triangle, std::span<const Node> boxes);

}  // namespace gnomon
