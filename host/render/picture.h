// Pictures as values: linear ones as light adds up, and the bytes a screen shows. Not for making them
// (render.h). Feeds all of host/render and the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

// Linear RGB radiance, row by row from the top left.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Vec3> pixels;
};

// sRGB bytes, three a pixel, row by row from the top left.
struct RgbImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> bytes;
};

}  // namespace gnomon
