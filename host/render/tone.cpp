#include "gnomon/render/tone.h"

#include <algorithm>
#include <cmath>

#include "gnomon/render/vector_math.h"

namespace gnomon {
namespace {

constexpr double kMiddleGrey = 0.20;
constexpr double kDarkest = 1e-3;     // of the brightest: darker pixels count as this dark in the mean
constexpr double kBrightShare = 0.9;  // of the pixels, all but the tenth that may blow out
constexpr double kBrightLimit = 1.1;  // where those should stay below, after exposure
constexpr float kCounts = 0.5F;       // weight from which a pixel counts

double filmic(double x) {
  return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

double luminance_of(const Vec3& pixel) {
  const double value = luminance(to_point(pixel));
  return std::isfinite(value) ? value : 0.0;
}

}  // namespace

std::uint8_t to_srgb_byte(double linear) {
  const double x = linear > 0.0 ? std::min(linear, 1.0) : 0.0;
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

double auto_exposure(const Picture& picture, std::span<const float> weights) {
  const bool weighted =
      std::any_of(weights.begin(), weights.end(), [](float weight) { return weight > 0.0F; });
  std::vector<double> counted;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    if (!weighted || weights[i] > kCounts) counted.push_back(luminance_of(picture.pixels[i]));
  }
  if (counted.empty()) return 1.0;
  const double brightest = *std::max_element(counted.begin(), counted.end());
  if (brightest <= 0.0) return 1.0;
  double sum = 0.0;
  for (const double value : counted) sum += std::log(std::max(value, kDarkest * brightest));
  const double by_mean = kMiddleGrey / std::exp(sum / static_cast<double>(counted.size()));
  const auto bright =
      counted.begin() + static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(counted.size() - 1));
  std::nth_element(counted.begin(), bright, counted.end());
  return *bright > 0.0 ? std::min(by_mean, kBrightLimit / *bright) : by_mean;
}

RgbImage tone_map(const Picture& picture, double exposure) {
  RgbImage image{picture.width, picture.height, {}};
  image.bytes.reserve(3 * picture.pixels.size());
  for (const Vec3& pixel : picture.pixels) {
    for (const float channel : pixel) {
      const double light = exposure * static_cast<double>(channel);
      image.bytes.push_back(std::isfinite(light) ? to_srgb_byte(filmic(std::max(light, 0.0))) : 0);
    }
  }
  return image;
}

}  // namespace gnomon
