// A plain sky: what rays that miss see, and the dim light that comes from everywhere. Feeds render.cpp.
#pragma once

#include "gnomon/render/vector_math.h"

namespace gnomon {

class Sky {
 public:
  // level: radiance near the horizon; the zenith is bluer and darker, the ground below the horizon dim and
  // brown.
  explicit Sky(double level) : level_(level) {}

  // Along a unit direction; y is up.
  [[nodiscard]] Point radiance(const Point& direction) const;
  // A guess at what a white surface out in the open sends on: light that bounced.
  [[nodiscard]] Point bounced() const;

 private:
  double level_;
};

}  // namespace gnomon
