#include "gnomon/tree/pair_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {

namespace {

using Vector = std::array<double, 3>;

struct Determinant {
  double value;
  double permanent;  // the same sum of magnitudes
};

// det(d, a, b)
Determinant determinant(const float d[3], const Vector& a, const Vector& b) {
  Determinant sum{0.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    sum.value += d[i] * (a[j] * b[k] - a[k] * b[j]);
    sum.permanent += std::fabs(d[i]) * (std::fabs(a[j] * b[k]) + std::fabs(a[k] * b[j]));
  }
  return sum;
}

}  // namespace

double pair_error_bound(const Ray& ray, const Triangle& triangle) {
  const float* const corners[3] = {triangle.v0, triangle.v1, triangle.v2};
  std::array<Vector, 3> r{};
  std::size_t axis = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::fabs(ray.direction[k]) > std::fabs(ray.direction[axis])) axis = k;
    for (std::size_t i = 0; i < 3; ++i) r[i][k] = static_cast<double>(corners[i][k]) - ray.origin[k];
  }
  double sum = 0.0;
  double permanents = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Determinant weight = determinant(ray.direction, r[(i + 1) % 3], r[(i + 2) % 3]);
    sum += weight.value;
    permanents += weight.permanent;
  }
  const auto [low, high] = std::minmax({r[0][axis], r[1][axis], r[2][axis]});
  const double spread = high - low;
  const double share = sum == 0.0 ? 1.0 : std::min(1.0, 0x1p-40 * permanents / std::fabs(sum));
  const double largest = std::max(std::fabs(low), std::fabs(high));
  return (share * spread + 0x1p-43 * largest) / std::fabs(static_cast<double>(ray.direction[axis]));
}

}  // namespace gnomon
