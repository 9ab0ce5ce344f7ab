// Counts as colours whose order the eye sees: dark is little, bright is much. Feeds the command line.
#pragma once

#include <array>
#include <span>

#include "gnomon/render/picture.h"

namespace gnomon {

// A colour for a share in [0, 1] (clamped): lightness rises evenly from near black to pale yellow while the
// hue goes once through violet, red and orange. Mixed in OKLab (Ottosson 2020), where even steps look even.
[[nodiscard]] std::array<std::uint8_t, 3> heat_color(double share);

// What a heat map's colours mean.
struct HeatScale {
  double max = 0.0;  // the largest value
  double white =
      0.0;  // shown at the bright end: the 99.5th percentile, so that a few pixels do not darken the rest
  double mean = 0.0;
};
[[nodiscard]] HeatScale heat_scale(std::span<const float> values);

// The values of a picture's pixels, 0 to scale.white.
[[nodiscard]] RgbImage heat_map(std::uint32_t width, std::uint32_t height, std::span<const float> values,
                                const HeatScale& scale);

}  // namespace gnomon
