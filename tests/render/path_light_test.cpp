// Path tracing finds the light that theory says is there, whichever way it looks for it.
#include <catch2/catch.hpp>

#include "render/path_checks.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr std::array kStrategies{PathStrategy::kBoth, PathStrategy::kLights, PathStrategy::kSurfaces};

}  // namespace

TEST_CASE("a square lamp lights a floor as its form factor says") {
  for (const PathStrategy strategy : kStrategies) {
    const Judged judged = lamp_over_floor(strategy);
    CAPTURE(static_cast<int>(strategy), judged.mean, judged.expected, judged.relative_error);
    CHECK(judged.bars < 4.0);
    CHECK(judged.relative_error < 0.01);
  }
}

TEST_CASE("in a closed box that shines everywhere radiance is the sum of all bounces") {
  for (const PathStrategy strategy : kStrategies) {
    const Judged judged = glowing_box(strategy);
    CAPTURE(static_cast<int>(strategy), judged.mean, judged.expected, judged.relative_error);
    CHECK(judged.bars < 4.0);
    CHECK(judged.relative_error < 0.01);
  }
}

TEST_CASE("point lights fall off with the squared distance and the slope, spots and suns as they should") {
  // 2 to the side, 3 up: cosine 3 / sqrt(13).
  const double square = 13.0;
  const double falloff = 3.0 / std::sqrt(square) / square;
  CHECK(irradiance_of(point_light({2.0F, 3.0F, 0.0F}, {26.0F, 26.0F, 26.0F})) ==
        Approx(26.0 * falloff).epsilon(1e-3));
  Light ranged = point_light({2.0F, 3.0F, 0.0F}, {26.0F, 26.0F, 26.0F});
  ranged.range = 5.0F;
  CHECK(irradiance_of(ranged) == Approx(26.0 * falloff * (1.0 - square * square / 625.0)).epsilon(2e-3));
  ranged.range = 3.0F;
  CHECK(irradiance_of(ranged) == 0.0);
  CHECK(irradiance_of(sun_light({0.6F, -0.8F, 0.0F}, {5.0F, 5.0F, 5.0F})) == Approx(4.0).epsilon(1e-3));
  CHECK(irradiance_of(sun_light({0.6F, 0.8F, 0.0F}, {5.0F, 5.0F, 5.0F})) == 0.0);
  // Straight down from 2 up, then turned so that the floor's spot lies in the soft edge.
  CHECK(irradiance_of(spot_light({0, 2, 0}, {0, -1, 0}, {8, 8, 8}, 0.3F, 0.5F)) == Approx(2.0).epsilon(1e-3));
  const double turned = 0.4;
  const auto axis = Vec3{static_cast<float>(std::sin(turned)), static_cast<float>(-std::cos(turned)), 0.0F};
  const double edge = (std::cos(turned) - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5));
  CHECK(irradiance_of(spot_light({0, 2, 0}, axis, {8, 8, 8}, 0.3F, 0.5F)) ==
        Approx(2.0 * edge * edge).epsilon(5e-3));
  CHECK(irradiance_of(spot_light({0, 2, 0}, {1, 0, 0}, {8, 8, 8}, 0.3F, 0.5F)) == 0.0);
}

TEST_CASE("in a white furnace a matt surface has its own reflectance, and in the open a dent of it more") {
  PathSceneBuilder convex;
  const auto matt = convex.material({0.25F, 0.5F, 1.0F});
  const Corner x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, w{-1, -1, -1};
  convex.triangle(matt, x, y, z);
  convex.triangle(matt, x, z, w);
  convex.triangle(matt, z, y, w);
  convex.triangle(matt, y, x, w);
  convex.look({0.5F, 0.6F, 5.0F}, {0.2F, 0.2F, 0.2F}, 0.1F);
  const TracedScene traced(convex.scene());
  for (const PathStrategy strategy : kStrategies) {
    CAPTURE(static_cast<int>(strategy));
    PathOptions options = small_picture(8, strategy);
    options.sky = Vec3{1.0F, 1.0F, 1.0F};
    PathTracer paths(context(), traced.tracer, traced.scene, options);
    paths.add_samples(16);
    REQUIRE(paths.coverage() == std::vector<float>(64, 1.0F));
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Vec3& pixel : paths.picture().pixels)
        REQUIRE(pixel[k] == Approx(convex.scene().materials[matt].base_color[k]).epsilon(1e-4));
    }
  }
  // Two walls that meet: what one reflects the other gets, so nothing is lost where all is reflected.
  PathSceneBuilder corner;
  const auto white = corner.material({1.0F, 1.0F, 1.0F});
  corner.quad(white, {-9, 0, 0}, {9, 0, 0}, {9, 0, 9}, {-9, 0, 9});
  corner.quad(white, {-9, 0, 0}, {9, 0, 0}, {9, 9, 0}, {-9, 9, 0});
  corner.look({0.0F, 1.0F, 3.0F}, {0.0F, 0.2F, 0.0F}, 0.3F);
  PathOptions options = small_picture(8, PathStrategy::kSurfaces);
  options.sky = Vec3{1.0F, 1.0F, 1.0F};
  for (const Vec3& pixel : TracedScene(corner.scene()).picture(options, 16).pixels)
    REQUIRE(pixel[1] == Approx(1.0).epsilon(1e-4));
}

TEST_CASE("light sampling, scattering and both together converge to the same picture") {
  const Disagreement both_lights = strategies_disagree(PathStrategy::kBoth, PathStrategy::kLights, 64);
  CAPTURE(both_lights.mean_square, both_lights.largest);
  CHECK(both_lights.mean_square < 1.8);
  CHECK(both_lights.largest < 6.0);
  const Disagreement both_surfaces = strategies_disagree(PathStrategy::kBoth, PathStrategy::kSurfaces, 64);
  CAPTURE(both_surfaces.mean_square, both_surfaces.largest);
  CHECK(both_surfaces.mean_square < 1.8);
  CHECK(both_surfaces.largest < 6.0);
}
