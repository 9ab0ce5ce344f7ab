// How samples become a picture: soft light is shared with neighbours on the same surface, and with nobody
// else.
#include "gnomon/render/film.h"

#include <catch2/catch.hpp>

using namespace gnomon;

namespace {

// Left half: a floor; right half: a wall or a floor further down. Soft light differs between them.
Film two_surfaces(const glm::vec3& right_normal, float right_height) {
  Film film(32, 16);
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x) {
      FilmPixel& pixel = film.pixels[y * 32 + x];
      const bool left = x < 16;
      pixel.hits = 1.0F;
      pixel.albedo = glm::vec3(0.5F);
      pixel.normal = left ? glm::vec3(0, 1, 0) : right_normal;
      pixel.position = {static_cast<float>(x), left ? 0.0F : right_height, static_cast<float>(y)};
      pixel.soft = glm::vec3(left ? 1.0F : 3.0F);
    }
  }
  return film;
}

}  // namespace

TEST_CASE("light does not leak across an edge or a step") {
  for (const Film& film : {two_surfaces({1, 0, 0}, 0.0F), two_surfaces({0, 1, 0}, -60.0F)}) {
    const Picture picture = develop(film, 1);
    for (std::uint32_t x = 0; x < 32; ++x) {
      CAPTURE(x);
      CHECK(picture.pixels[8 * 32 + x][0] == Approx(x < 16 ? 0.5F : 1.5F).epsilon(0.02));
    }
  }
}

TEST_CASE("noise in soft light is evened out on one surface, direct light is not touched") {
  Film film = two_surfaces({0, 1, 0}, 0.0F);
  for (std::size_t i = 0; i < film.pixels.size(); ++i) {
    film.pixels[i].soft = glm::vec3(i % 3 == 0 ? 6.0F : 0.0F);  // 2 on average
    film.pixels[i].direct = glm::vec3(i == 100 ? 7.0F : 0.0F);
  }
  const Picture picture = develop(film, 1);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    CAPTURE(i);
    CHECK(picture.pixels[i][1] - (i == 100 ? 7.0F : 0.0F) == Approx(1.0F).epsilon(0.15));
  }
}

TEST_CASE("with very many samples nothing is smoothed") {
  Film film(4, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    film.pixels[i].hits = 4096.0F;
    film.pixels[i].albedo = glm::vec3(4096.0F);
    film.pixels[i].normal = glm::vec3(0, 4096, 0);
    film.pixels[i].position = {4096.0F * static_cast<float>(i), 0, 0};
    film.pixels[i].soft = glm::vec3(4096.0F * static_cast<float>(i));
  }
  const Picture picture = develop(film, 4096);
  for (std::size_t i = 0; i < 4; ++i) CHECK(picture.pixels[i][2] == Approx(static_cast<float>(i)));
}
