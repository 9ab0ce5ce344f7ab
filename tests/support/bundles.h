// Rays that run together, in every way a packet of them may be made of. Feeds the tests of packets.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/flavours.h"

namespace gnomon::test {

using Point = std::array<float, 3>;

// In tiles of 8 x 8, so that 64 in a row see a small part.
template <typename Make>
Rays tiled(std::uint32_t tiles, const Make& make) {
  Rays rays;
  const float side = 8.0F * static_cast<float>(tiles);
  for (std::uint32_t i = 0; i < 64 * tiles * tiles; ++i) {
    const std::uint32_t tile = i / 64;
    const auto x = static_cast<float>(8 * (tile % tiles) + i % 8);
    const auto y = static_cast<float>(8 * (tile / tiles) + i / 8 % 8);
    rays.push_back(make((x + 0.5F) / side - 0.5F, (y + 0.5F) / side - 0.5F));
  }
  return rays;
}

inline Rays camera_rays(std::uint32_t tiles, const Point& eye, const Point& forward, float width) {
  return tiled(tiles, [&](float x, float y) {
    return ray(eye, {forward[0] + width * x, forward[1] + width * y, forward[2] - 0.3F * width * x});
  });
}

inline Rays sun_rays(std::uint32_t tiles, const Point& direction, float width) {
  return tiled(tiles, [&](float x, float y) {
    return ray({5 + width * x + 3 * y * y, 12 + x, 5 + width * y}, direction);
  });
}

// From a wavy floor to a point, with lengths that vary: the apex has to be found, and is off by rounding.
inline Rays shadow_rays(std::uint32_t tiles, const Point& light, float width) {
  return tiled(tiles, [&](float x, float y) {
    const Point from{5 + width * x, std::sin(9 * x * y), 5 + width * y};
    const Point way{light[0] - from[0], light[1] - from[1], light[2] - from[2]};
    const float length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    return ray(from, {way[0] / length, way[1] / length, way[2] / length}, 0.0F, 0.999F * length);
  });
}

inline std::vector<std::pair<std::string, Rays>> bundles(std::uint32_t tiles) {
  return {{"camera", camera_rays(tiles, {5, 4, 30}, {-0.1F, 0.05F, -1}, 0.5F)},
          {"camera along x, inside", camera_rays(tiles, {5, 5, 5}, {1, 0.6F, 0.7F}, 0.4F)},
          {"camera, wide", camera_rays(tiles, {5, 5, 12}, {0.2F, -0.3F, -1}, 2.0F)},
          {"sun along y", sun_rays(tiles, {0, -1, 0}, 6.0F)},
          {"sun along -0", sun_rays(tiles, {-0.0F, -1, -0.0F}, 3.0F)},
          {"sun, next to y", sun_rays(tiles, {-1e-25F, -0.7F, 3e-20F}, 3.0F)},
          {"sun, oblique", sun_rays(tiles, {0.4F, -0.8F, 0.45F}, 6.0F)},
          {"sun, one component zero", sun_rays(tiles, {0.3F, -0.9F, 0}, 2.0F)},
          {"light", shadow_rays(tiles, {3.3F, 11.7F, 6.1F}, 4.0F)},
          {"light, near", shadow_rays(tiles, {5.1F, 1.5F, 5.2F}, 1.0F)}};
}

}  // namespace gnomon::test
