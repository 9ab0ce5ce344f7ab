// Boxes to weigh, in float, and as the double-precision reference takes them.
#pragma once

#include <cmath>

#include "gnomon/areas/box.h"
#include "support/shapes.h"

namespace gnomon::test {

struct Box {
  float lo[3];
  float hi[3];
  [[nodiscard]] Box3d exact() const {
    Box3d box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = lo[k];
      box.hi[k] = hi[k];
    }
    return box;
  }
};

// Boxes of sizes from `smallest` to `largest` about points of a cube of side 20 around the origin.
inline Box random_box(Random& random, float smallest, float largest) {
  Box box{};
  const float size = smallest * std::pow(largest / smallest, random.between(0, 1));
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = random.between(-10, 10);
    box.hi[k] = box.lo[k] + size * random.between(0.05F, 1);
  }
  return box;
}

}  // namespace gnomon::test
