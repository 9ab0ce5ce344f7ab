#include "gnomon/render/sky.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

const Point kHorizon{0.86, 0.93, 1.00};
const Point kZenith{0.22, 0.42, 0.82};
const Point kGround{0.58, 0.60, 0.62};
const Point kBounced{0.14, 0.13, 0.12};
constexpr double kHaze = 0.25;  // height over which ground turns into horizon

Point mix(const Point& a, const Point& b, double share) { return a + share * (b - a); }

}  // namespace

Point Sky::radiance(const Point& direction) const {
  const double height = direction.y;
  if (height < 0.0) return level_ * mix(kHorizon, kGround, std::min(1.0, -height / kHaze));
  return level_ * mix(kHorizon, kZenith, std::sqrt(std::min(1.0, height)));
}

Point Sky::bounced() const { return level_ * kBounced; }

}  // namespace gnomon
