// What samples add up to, pixel by pixel, and how it becomes a picture. Feeds render.cpp.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "gnomon/base/progress.h"
#include "gnomon/render/picture.h"
#include "gnomon/render/vector_math.h"

namespace gnomon {

// Sums over a pixel's samples. Soft light, what arrives from sky and other surfaces, is kept apart from what
// the surface itself is like: it changes slowly from pixel to pixel, so that neighbours may share it.
struct FilmPixel {
  glm::vec3 direct{0.0F};  // radiance seen without soft light
  glm::vec3 soft{0.0F};    // soft light on the surface
  glm::vec3 albedo{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec3 position{0.0F};  // from the camera
  float hits = 0.0F;         // samples that saw a surface
};

struct Film {
  Film(std::uint32_t film_width, std::uint32_t film_height)
      : width(film_width), height(film_height), pixels(std::size_t{film_width} * film_height) {}
  std::uint32_t width;
  std::uint32_t height;
  std::vector<FilmPixel> pixels;
};

// The picture after `samples` samples a pixel. Soft light is averaged over neighbours on the same smooth
// surface, the wider the fewer the samples (edge-avoiding a-trous wavelets, Dammertz et al. 2010); direct
// light is left as it is. Throws Error{kCancelled}.
[[nodiscard]] Picture develop(const Film& film, std::uint32_t samples, const Progress& progress = {});

}  // namespace gnomon
