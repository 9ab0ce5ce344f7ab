#include "gnomon/render/heat_map.h"

#include <algorithm>
#include <cmath>

#include "gnomon/render/tone.h"
#include "gnomon/render/vector_math.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr double kWhiteShare = 0.995;

// OKLab to linear sRGB.
Point linear_srgb(double lightness, double a, double b) {
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3.0);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3.0);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3.0);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool is_shown(const Point& color) {
  return std::min({color.x, color.y, color.z}) >= 0.0 && std::max({color.x, color.y, color.z}) <= 1.0;
}

}  // namespace

std::array<std::uint8_t, 3> heat_color(double share) {
  const double t = share > 0.0 ? std::min(share, 1.0) : 0.0;
  const double lightness = 0.14 + 0.83 * t;
  const double turns = (-85.0 + 190.0 * t) / 360.0;
  // As colourful as the screen allows at this lightness, up to a limit.
  double chroma = 0.22;
  Point color = linear_srgb(lightness, chroma * cos_turns(turns), chroma * sin_turns(turns));
  while (chroma > 0.0 && !is_shown(color)) {
    chroma -= 0.002;
    color = linear_srgb(lightness, chroma * cos_turns(turns), chroma * sin_turns(turns));
  }
  return {to_srgb_byte(color.x), to_srgb_byte(color.y), to_srgb_byte(color.z)};
}

HeatScale heat_scale(std::span<const float> values) {
  if (values.empty()) return {};
  std::vector<float> sorted(values.begin(), values.end());
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto white = sorted.begin() + static_cast<std::ptrdiff_t>(kWhiteShare * last);
  std::nth_element(sorted.begin(), white, sorted.end());
  HeatScale scale{0.0, static_cast<double>(*white), 0.0};
  for (const float value : values) {
    scale.max = std::max(scale.max, static_cast<double>(value));
    scale.mean += static_cast<double>(value) / static_cast<double>(values.size());
  }
  return scale;
}

RgbImage heat_map(std::uint32_t width, std::uint32_t height, std::span<const float> values,
                  const HeatScale& scale) {
  constexpr std::size_t kSteps = 1024;
  std::array<std::array<std::uint8_t, 3>, kSteps> table{};
  for (std::size_t i = 0; i < kSteps; ++i) table[i] = heat_color(static_cast<double>(i) / (kSteps - 1));
  RgbImage image{width, height, {}};
  image.bytes.reserve(3 * values.size());
  for (const float value : values) {
    const double share = scale.white > 0.0 ? std::min(1.0, static_cast<double>(value) / scale.white) : 0.0;
    const auto& color = table[static_cast<std::size_t>(std::lround(share * (kSteps - 1)))];
    image.bytes.insert(image.bytes.end(), color.begin(), color.end());
  }
  return image;
}

}  // namespace gnomon
