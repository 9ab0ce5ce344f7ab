#include "gnomon/render/sample_pattern.h"

#include <algorithm>
#include <cmath>

#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

// 1 / p and 1 / p^2 for the plastic number p, the real root of x^3 = x + 1.
constexpr double kStepX = 0.75487766624669276;
constexpr double kStepY = 0.56984029099805327;

double fraction(double value) {
  return value - std::floor(value);
}

}  // namespace

Point2 sample_point(std::uint64_t seed, std::uint64_t pixel, std::uint32_t purpose, std::uint32_t index) {
  SteadyRandom shift(mix_bits(seed) + purpose, pixel);
  const double x = shift.unit();
  const double y = shift.unit();
  return {fraction(x + kStepX * index), fraction(y + kStepY * index)};
}

Point cosine_direction(const Point& normal, const Point2& sample) {
  const Tangents tangents = tangents_of(normal);
  const double radius = std::sqrt(sample.x);
  return radius * cos_turns(sample.y) * tangents.x + radius * sin_turns(sample.y) * tangents.y +
         std::sqrt(std::max(0.0, 1.0 - sample.x)) * normal;
}

}  // namespace gnomon
