#include "gnomon/areas/cone_weights.h"

#include <numbers>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

constexpr double kPiD = std::numbers::pi;
// Below it the closed form's terms cancel to their cube, and a cap is as good as a disc: either way 2^-36.
constexpr double kFlatCap = 1e-4;

// Mean of |height + radius x| over a disc of radius 1, x one of its coordinates.
double disc_mean(double height, double radius) {
  if (height >= radius) return height;
  const double q = height / radius;
  const double root = std::sqrt(1.0 - q * q);
  return radius * 2.0 / kPiD * (q * (std::asin(q) + q * root) + 2.0 / 3.0 * root * root * root);
}

// Integral of max(d_i, 0) over a cap of half angle gamma whose axis is at angle alpha to axis i and whose rim
// crosses the horizon d_i = 0. By Stokes, the integral of d over a region of the sphere is half of that of r
// x dr round its edge: here the rim's arc |t| < rim above the horizon, then back along the horizon. root =
// sqrt(sin^2 gamma - cos^2 alpha) gives both angles' sines: their cosines alone would lose small angles.
double positive_part(double cos_gamma, double sin_gamma, double cos_alpha, double root) {
  const double rim = std::atan2(root, -cos_gamma * cos_alpha);
  const double horizon = std::atan2(root, cos_gamma);
  return horizon + sin_gamma * sin_gamma * cos_alpha * rim - cos_gamma * root;
}

// E|d_i| for n_i = cos_alpha >= 0.
double mean_magnitude(double cos_alpha, double sin_alpha, double gamma) {
  if (gamma < kFlatCap) return disc_mean(cos_alpha, gamma * sin_alpha);
  const double cos_gamma = std::cos(gamma);
  const double sin_gamma = std::sin(gamma);
  const double half_sine = std::sin(0.5 * gamma);
  const double cap_area = 4.0 * kPiD * half_sine * half_sine;
  const double signed_integral = kPiD * sin_gamma * sin_gamma * cos_alpha;
  const double root_squared = (sin_gamma - cos_alpha) * (sin_gamma + cos_alpha);
  if (root_squared > 0.0) {
    const double positive = positive_part(cos_gamma, sin_gamma, cos_alpha, std::sqrt(root_squared));
    return (2.0 * positive - signed_integral) / cap_area;
  }
  // The cap is on one side of the horizon, or what it leaves out is.
  return (cos_gamma >= 0.0 ? signed_integral : 2.0 * kPiD - signed_integral) / cap_area;
}

}  // namespace

Vec3d cone_weights(const Vec3d& direction, double half_angle) {
  if (!is_finite(direction) || !(magnitude(direction) > 0.0))
    throw Error(ErrorCode::kInvalidArgument, "cone weights: direction must be finite and not zero");
  if (!(half_angle >= 0.0 && half_angle <= kPiD))
    throw Error(ErrorCode::kInvalidArgument, "cone weights: half_angle must be between 0 and pi radians");
  const Vec3d n = unit_of(direction);
  Vec3d weights{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double other = n[(i + 1) % 3];
    const double another = n[(i + 2) % 3];
    weights[i] = mean_magnitude(std::abs(n[i]), std::sqrt(other * other + another * another), half_angle);
  }
  return weights;
}

double weighted_measure(const Vec3d& weights, const Box3d& box) {
  if (is_empty(box)) return 0.0;
  const Vec3d d = box.hi - box.lo;
  return weights[0] * d[1] * d[2] + weights[1] * d[0] * d[2] + weights[2] * d[0] * d[1];
}

}  // namespace gnomon
