// The formulas of the path tracer, on the host, against others written down here in double precision.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "gnomon/shared/path_math.h"

namespace {

// As the papers have it: direction number k of the second Sobol coordinate is the one before, xor its half.
std::uint32_t second_sobol(std::uint32_t index) {
  std::uint32_t result = 0;
  std::uint32_t direction = 1U << 31U;
  for (; index != 0; index >>= 1U, direction ^= direction >> 1U)
    if ((index & 1U) != 0) result ^= direction;
  return result;
}

std::array<float, 2> point(std::uint32_t pixel, std::uint32_t purpose, std::uint32_t sample) {
  const gn_u32 seed[2] = {11, 0};
  std::array<float, 2> out{};
  gn_sample_point(seed, pixel, purpose, sample, out.data());
  return out;
}

GnSurface surface(float color, float roughness, float metallic) {
  return {{color, color, color}, roughness, {0, 0, 0}, metallic};
}

GnScatter scatter(const GnSurface& made_of, double view_cosine) {
  const float view[3] = {static_cast<float>(std::sqrt(1.0 - view_cosine * view_cosine)), 0.0F,
                         static_cast<float>(view_cosine)};
  GnScatter out;
  gn_scatter_of(&made_of, view, &out);
  return out;
}

// Cosine times reflection, by the formulas of glTF's appendix B, in double precision.
double gltf_reflected(const GnSurface& s, const double* view, const double* light) {
  double half_way[3];
  double length = 0.0;
  for (int k = 0; k < 3; ++k) {
    half_way[k] = view[k] + light[k];
    length += half_way[k] * half_way[k];
  }
  for (double& x : half_way) x /= std::sqrt(length);
  const double along = half_way[0] * view[0] + half_way[1] * view[1] + half_way[2] * view[2];
  const double a2 = std::pow(s.roughness, 4.0);
  const double bell = a2 / (M_PI * std::pow(half_way[2] * half_way[2] * (a2 - 1.0) + 1.0, 2.0));
  const auto lambda = [&](double z) { return (std::sqrt(1.0 + a2 * (1.0 / (z * z) - 1.0)) - 1.0) / 2.0; };
  const double visible = 1.0 / (1.0 + lambda(view[2]) + lambda(light[2]));
  const double gloss = bell * visible / (4.0 * view[2] * light[2]);
  const double schlick = std::pow(1.0 - along, 5.0);
  const double color = s.base_color[0];
  const double dielectric = (1.0 - (0.04 + 0.96 * schlick)) * color / M_PI + (0.04 + 0.96 * schlick) * gloss;
  const double metal = (color + (1.0 - color) * schlick) * gloss;
  // Both at once where a surface is between the two is how glTF mixes the reflectances head on, too.
  return light[2] * (s.metallic == 0.0F ? dielectric : metal);
}

// Over the hemisphere, midpoints in height and turn.
template <typename F>
double integrate(F&& f, int heights = 700, int turns = 700) {
  double sum = 0.0;
  for (int i = 0; i < heights; ++i) {
    const double z = (i + 0.5) / heights;
    const double r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < turns; ++j) {
      const double turn = 2.0 * M_PI * (j + 0.5) / turns;
      const std::array<float, 3> light{static_cast<float>(r * std::cos(turn)),
                                       static_cast<float>(r * std::sin(turn)), static_cast<float>(z)};
      sum += f(light.data());
    }
  }
  return sum * 2.0 * M_PI / (static_cast<double>(heights) * turns);
}

}  // namespace

TEST_CASE("the second Sobol coordinate is the papers', and shuffled points lie evenly") {
  for (const std::uint32_t index : {0U, 1U, 2U, 3U, 7U, 100U, 65535U, 0x80000001U, 0xdeadbeefU})
    REQUIRE(gn_second_sobol(gn_reversed_bits(index)) == second_sobol(index));
  // Of 64 points from a multiple of 64 on, one in each of 64 strips of either coordinate and in each of 8 x 8
  // cells.
  for (const std::uint32_t first : {0U, 64U, 4032U}) {
    for (const std::uint32_t purpose : {0U, 3U, 77U}) {
      CAPTURE(first, purpose);
      std::set<int> strips, columns, cells;
      for (std::uint32_t i = 0; i < 64; ++i) {
        const auto p = point(5, purpose, first + i);
        REQUIRE(p[0] >= 0.0F);
        REQUIRE(p[0] < 1.0F);
        REQUIRE(p[1] >= 0.0F);
        REQUIRE(p[1] < 1.0F);
        strips.insert(static_cast<int>(64.0F * p[0]));
        columns.insert(static_cast<int>(64.0F * p[1]));
        cells.insert(8 * static_cast<int>(8.0F * p[0]) + static_cast<int>(8.0F * p[1]));
      }
      REQUIRE(strips.size() == 64);
      REQUIRE(columns.size() == 64);
      REQUIRE(cells.size() == 64);
    }
  }
}

TEST_CASE("points of different pixels and purposes know nothing of each other") {
  // Correlations of first coordinates over 20,000 samples stay within four of their error bars.
  constexpr int kCount = 20'000;
  const auto correlation = [&](std::uint32_t pixel, std::uint32_t purpose, std::size_t coordinate) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kCount; ++i)
      sum += (static_cast<double>(point(1, 1, i)[0]) - 0.5) *
             (static_cast<double>(point(pixel, purpose, i)[coordinate]) - 0.5);
    return 12.0 * sum / kCount;
  };
  for (const auto& [pixel, purpose, coordinate] :
       std::vector<std::array<std::uint32_t, 3>>{{1, 2, 0}, {2, 1, 0}, {1, 1, 1}, {7, 9, 1}, {1, 5, 0}}) {
    CAPTURE(pixel, purpose, coordinate);
    CHECK(std::abs(correlation(pixel, purpose, coordinate)) < 4.0 / std::sqrt(double{kCount}));
  }
  CHECK(correlation(1, 1, 0) == Approx(1.0).epsilon(0.02));
}

TEST_CASE("cosines and sines, frames and unit vectors are right to a few bits") {
  for (int i = 0; i < 4096; ++i) {
    const float turns = static_cast<float>(i) / 4096.0F;
    float got[2];
    gn_cos_sin(turns, got);
    CAPTURE(turns);
    REQUIRE(std::abs(static_cast<double>(got[0]) - std::cos(2.0 * M_PI * i / 4096.0)) < 6e-7);
    REQUIRE(std::abs(static_cast<double>(got[1]) - std::sin(2.0 * M_PI * i / 4096.0)) < 6e-7);
  }
  for (const std::array<float, 3> direction : {std::array{0.0F, 0.0F, 1.0F},
                                               {0.0F, 0.0F, -1.0F},
                                               {1.0F, 2.0F, -3.0F},
                                               {1e-20F, 3e-20F, 0.0F},
                                               {2e14F, -1e14F, 5e13F},
                                               {1e-4F, 0.0F, -1.0F}}) {
    std::array<float, 3> n = direction;
    REQUIRE(gn_make_unit(n.data()) == 1);
    GnBasis basis;
    gn_basis_about(n.data(), &basis);
    CAPTURE(n[0], n[1], n[2]);
    for (const float* axis : {basis.x, basis.y, basis.z})
      REQUIRE(gn_dot(axis, axis) == Approx(1.0).margin(2e-6));
    float y[3];
    gn_cross(basis.z, basis.x, y);
    for (int k = 0; k < 3; ++k) REQUIRE(y[k] == Approx(basis.y[k]).margin(2e-6));
  }
  float zero[3] = {0.0F, 0.0F, 0.0F};
  REQUIRE(gn_make_unit(zero) == 0);
}

TEST_CASE("surfaces reflect what glTF's formulas say, as much one way as the other") {
  for (const GnSurface& s : {surface(0.7F, 0.3F, 0.0F), surface(0.7F, 0.3F, 1.0F), surface(0.2F, 0.9F, 0.0F),
                             surface(1.0F, 1.0F, 1.0F), surface(0.5F, 0.08F, 1.0F)}) {
    for (const double view_cosine : {0.1, 0.5, 0.95}) {
      const GnScatter from = scatter(s, view_cosine);
      for (const double height : {0.2, 0.6, 0.97}) {
        for (const double turns : {0.0, 0.3, 0.5}) {
          const double r = std::sqrt(1.0 - height * height);
          const double light[3] = {r * std::cos(2.0 * M_PI * turns), r * std::sin(2.0 * M_PI * turns),
                                   height};
          const float in[3] = {static_cast<float>(light[0]), static_cast<float>(light[1]),
                               static_cast<float>(light[2])};
          const double view[3] = {std::sqrt(1.0 - view_cosine * view_cosine), 0.0, view_cosine};
          float reflected[3], density, back[3];
          gn_reflected(&from, in, reflected, &density);
          CAPTURE(s.roughness, s.metallic, view_cosine, height, turns);
          REQUIRE(reflected[0] == Approx(gltf_reflected(s, view, light)).epsilon(2e-4).margin(1e-7));
          GnScatter reversed;
          gn_scatter_of(&s, in, &reversed);
          gn_reflected(&reversed, from.view, back, &density);
          REQUIRE(back[0] * in[2] == Approx(reflected[0] * from.view[2]).epsilon(2e-4).margin(1e-7));
        }
      }
    }
  }
  // Rough and no metal: Lambert alone.
  const float up[3] = {0.0F, 0.0F, 1.0F};
  float reflected[3], density;
  const GnScatter matt = scatter(surface(0.5F, 1.0F, 0.0F), 0.5);
  gn_reflected(&matt, up, reflected, &density);
  REQUIRE(reflected[0] == Approx(0.5 / M_PI));
  const float below[3] = {0.6F, 0.0F, -0.8F};
  gn_reflected(&matt, below, reflected, &density);
  REQUIRE(reflected[0] == 0.0F);
  REQUIRE(density == 0.0F);
}

TEST_CASE("directions come as often as their density says, and bring what the surface reflects") {
  for (const GnSurface& s : {surface(0.7F, 1.0F, 0.0F), surface(0.7F, 0.5F, 0.0F), surface(0.9F, 0.4F, 1.0F),
                             surface(0.3F, 0.8F, 0.3F)}) {
    for (const double view_cosine : {0.2, 0.8}) {
      CAPTURE(s.roughness, s.metallic, view_cosine);
      const GnScatter from = scatter(s, view_cosine);
      const auto share_above = [&](float height) {
        return integrate([&](const float* light) {
          float reflected[3], density;
          gn_reflected(&from, light, reflected, &density);
          return light[2] > height ? static_cast<double>(density) : 0.0;
        });
      };
      const double albedo = integrate([&](const float* light) {
        float reflected[3], density;
        gn_reflected(&from, light, reflected, &density);
        return static_cast<double>(reflected[0]);
      });
      constexpr std::uint32_t kCount = 1U << 16U;
      double drawn = 0.0, above = 0.0, brought = 0.0;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto p = point(3, 1, i);
        float light[3], reflected[3], density;
        if (gn_scatter_towards(&from, point(3, 2, i)[0], p.data(), light) == 0) continue;
        gn_reflected(&from, light, reflected, &density);
        drawn += 1.0 / kCount;
        above += light[2] > 0.7F ? 1.0 / kCount : 0.0;
        brought += static_cast<double>(reflected[0]) / static_cast<double>(density) / kCount;
      }
      REQUIRE(drawn == Approx(share_above(0.0F)).epsilon(0.01));
      REQUIRE(above == Approx(share_above(0.7F)).epsilon(0.015));
      REQUIRE(brought == Approx(albedo).epsilon(0.01));
      REQUIRE(albedo < 1.0);
    }
  }
}

TEST_CASE("the shares of two ways to find the same light are one together") {
  for (const float a : {1e-6F, 0.3F, 1.0F, 50.0F, 3e8F}) {
    for (const float b : {1e-5F, 0.7F, 20.0F, 1e6F}) {
      CAPTURE(a, b);
      REQUIRE(gn_weight(a, b) + gn_weight(b, a) == Approx(1.0).epsilon(1e-5));
      REQUIRE((gn_weight(a, b) > 0.5F) == (a > b));
    }
  }
  REQUIRE(gn_weight(1.0F, 0.0F) == Approx(1.0));
}

TEST_CASE("pixels are walked tile by tile, each once, and the walk goes beyond ragged edges only") {
  GnPathFrame frame{};
  frame.width = 21;
  frame.height = 13;
  frame.tiles_across = 3;
  std::vector<int> seen(std::size_t{21} * 13);
  std::uint32_t beyond = 0;
  for (std::uint32_t cell = 0; cell < 3U * 2U * 64U; ++cell) {
    const std::uint32_t pixel = gn_pixel_of(&frame, cell);
    if (pixel == GN_NONE) {
      beyond += 1;
    } else {
      seen.at(pixel) += 1;
    }
  }
  REQUIRE(seen == std::vector<int>(seen.size(), 1));
  REQUIRE(beyond == 3 * 2 * 64 - 21 * 13);
  REQUIRE(gn_pixel_of(&frame, 9) == 22);
}
