// From linear light to what a screen shows. Not for heat maps. Feeds the command line.
#pragma once

#include <span>

#include "gnomon/render/picture.h"

namespace gnomon {

// The factor that brings the logarithmic mean luminance to a middle grey, or less where more than a tenth of
// the pixels would blow out; 1 for a black picture. Pixels whose weight is above a half count; without
// weights all do.
[[nodiscard]] double auto_exposure(const Picture& picture, std::span<const float> weights = {});

// Times exposure, through a filmic curve (Narkowicz 2015, a fit to ACES) on each channel, to sRGB.
// Values that are not finite come out black.
[[nodiscard]] RgbImage tone_map(const Picture& picture, double exposure);

// One linear value in [0, 1] as an sRGB byte (IEC 61966-2-1).
[[nodiscard]] std::uint8_t to_srgb_byte(double linear);

}  // namespace gnomon
