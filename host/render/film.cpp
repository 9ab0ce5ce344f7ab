#include "gnomon/render/film.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {
namespace {

// A pixel's means over the samples that saw a surface.
struct Surface {
  glm::vec3 soft{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec3 position{0.0F};
  bool seen = false;
};
using Surfaces = std::vector<Surface>;

Surfaces surfaces_of(const Film& film) {
  Surfaces surfaces(film.pixels.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const FilmPixel& pixel = film.pixels[i];
    if (pixel.hits <= 0.0F) continue;
    const float length = glm::length(pixel.normal);
    surfaces[i] = {pixel.soft / pixel.hits, length > 0.0F ? pixel.normal / length : pixel.normal,
                   pixel.position / pixel.hits, true};
  }
  return surfaces;
}

// Four times the samples need half the width.
unsigned levels_for(std::uint32_t samples) {
  const double levels = 5.0 - std::log2(static_cast<double>(samples) / 4.0) / 2.0;
  return static_cast<unsigned>(std::clamp(std::lround(levels), 0L, 5L));
}

// How much two pixels see the same smooth surface: normals agree, and neither lies off the other's plane,
// seen from each other. Has no unit of length.
float likeness(const Surface& a, const Surface& b) {
  const float along = glm::dot(a.normal, b.normal);
  if (along <= 0.0F) return 0.0F;
  const glm::vec3 offset = b.position - a.position;
  const float distance = glm::length(offset);
  const float off_plane =
      std::max(std::abs(glm::dot(a.normal, offset)), std::abs(glm::dot(b.normal, offset)));
  const float slope = distance > 0.0F ? off_plane / distance : 0.0F;
  return std::exp(-8.0F * slope - 24.0F * (1.0F - along));
}

constexpr std::array<float, 5> kSpline{0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};

glm::vec3 mean_around(const Film& film, const Surfaces& surfaces, std::int64_t x, std::int64_t y,
                      std::int64_t step) {
  const Surface& centre = surfaces[static_cast<std::size_t>(y * film.width + x)];
  glm::vec3 sum{0.0F};
  float weights = 0.0F;
  for (std::int64_t j = -2; j <= 2; ++j) {
    for (std::int64_t i = -2; i <= 2; ++i) {
      const std::int64_t column = x + i * step;
      const std::int64_t row = y + j * step;
      if (column < 0 || row < 0 || column >= film.width || row >= film.height) continue;
      const Surface& other = surfaces[static_cast<std::size_t>(row * film.width + column)];
      if (!other.seen) continue;
      const float spline =
          kSpline[static_cast<std::size_t>(i + 2)] * kSpline[static_cast<std::size_t>(j + 2)];
      const float weight = spline * likeness(centre, other);
      sum += weight * other.soft;
      weights += weight;
    }
  }
  return weights > 0.0F ? sum / weights : centre.soft;
}

void smooth(const Film& film, Surfaces& surfaces, std::int64_t step, const Progress& progress) {
  std::vector<glm::vec3> smoothed(surfaces.size());
  for (std::int64_t y = 0; y < film.height; ++y) {
    report(progress, "smooth", static_cast<double>(y) / film.height);
    for (std::int64_t x = 0; x < film.width; ++x) {
      const auto i = static_cast<std::size_t>(y * film.width + x);
      if (surfaces[i].seen) smoothed[i] = mean_around(film, surfaces, x, y, step);
    }
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) surfaces[i].soft = smoothed[i];
}

}  // namespace

Picture develop(const Film& film, std::uint32_t samples, const Progress& progress) {
  Surfaces surfaces = surfaces_of(film);
  for (unsigned level = 0; level < levels_for(samples); ++level)
    smooth(film, surfaces, std::int64_t{1} << level, progress);
  Picture picture{film.width, film.height, std::vector<Vec3>(film.pixels.size())};
  for (std::size_t i = 0; i < film.pixels.size(); ++i) {
    const glm::vec3 sum = film.pixels[i].direct + film.pixels[i].albedo * surfaces[i].soft;
    picture.pixels[i] = to_vec3(Point(sum) / static_cast<double>(samples));
  }
  return picture;
}

}  // namespace gnomon
