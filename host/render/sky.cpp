#include "gnomon/render/sky.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

const Point kHorizon{0.76, 0.87, 1.00};
const Point kZenith{0.20, 0.43, 0.90};
const Point kGround{0.56, 0.61, 0.66};
const Point kBounced{0.14, 0.13, 0.12};
constexpr double kHaze = 0.25;  // height over which ground turns into horizon

Point mix(const Point& a, const Point& b, double share) {
  return a + share * (b - a);
}

}  // namespace

Point Sky::radiance(const Point& direction) const {
  const double height = direction.y;
  if (height < 0.0) return level_ * mix(kHorizon, kGround, std::min(1.0, -height / kHaze));
  return level_ * mix(kHorizon, kZenith, std::sqrt(std::min(1.0, height)));
}

Point Sky::bounced() const {
  return level_ * kBounced;
}

}  // namespace gnomon
