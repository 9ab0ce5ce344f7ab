// Hills and crags over a square kilometre.
#include <cmath>

#include "gnomon/scene/generator_list.h"
#include "gnomon/scene/mesh_sketch.h"
#include "gnomon/scene/value_noise.h"

namespace gnomon {
namespace {

constexpr double kSide = 1000.0;

// Rolling ground with ridges where two noises cross their middle; metres above the valley.
double height_at(const ValueNoise& noise, double x, double z) {
  const double broad = noise.octaves(x / 420.0, z / 420.0, 8);
  const double folded = 1.0 - std::abs(2.0 * noise.octaves(x / 260.0 + 40.0, z / 260.0 - 12.0, 6) - 1.0);
  const double ridge = folded * folded * folded;
  return 150.0 * broad * broad + 130.0 * ridge * broad;
}

struct Ground {
  MaterialId grass, meadow, rock, snow;
};

Ground add_materials(MeshSketch& sketch) {
  return {sketch.material("grass", {0.20F, 0.33F, 0.11F}), sketch.material("meadow", {0.38F, 0.40F, 0.16F}),
          sketch.material("rock", {0.38F, 0.34F, 0.31F}),
          sketch.material("snow", {0.90F, 0.92F, 0.95F}, 0.6F)};
}

MaterialId cover_of(const Ground& ground, double height, double steepness) {
  if (steepness > 0.85) return ground.rock;
  if (height > 118.0) return ground.snow;
  if (height > 92.0) return ground.rock;
  return height > 62.0 ? ground.meadow : ground.grass;
}

}  // namespace

Scene make_terrain(std::uint64_t triangles, std::uint64_t seed) {
  MeshSketch sketch("terrain", triangles);
  const Ground ground = add_materials(sketch);
  const ValueNoise noise(seed);
  const double cells = static_cast<double>(triangles) / 2.0;
  const unsigned nu = at_least(4, std::sqrt(cells) - 0.5);
  const unsigned nv = at_least(4, cells / nu);
  const auto x_of = [&](unsigned i) { return kSide * (static_cast<double>(i) / nu - 0.5); };
  const auto z_of = [&](unsigned j) { return kSide * (static_cast<double>(j) / nv - 0.5); };
  std::vector<double> rows(2 * static_cast<std::size_t>(nu + 1));
  for (unsigned j = 0; j <= nv; ++j) {
    double* const near = &rows[(j % 2) * static_cast<std::size_t>(nu + 1)];
    const double* const far = &rows[(1 - j % 2) * static_cast<std::size_t>(nu + 1)];
    for (unsigned i = 0; i <= nu; ++i) near[i] = height_at(noise, x_of(i), z_of(j));
    for (unsigned i = 0; i < nu && j > 0; ++i) {
      const double rise_x = (far[i + 1] - far[i]) * nu / kSide;
      const double rise_z = (near[i] - far[i]) * nv / kSide;
      sketch.use(cover_of(ground, far[i], std::sqrt(rise_x * rise_x + rise_z * rise_z)));
      sketch.quad({x_of(i), near[i], z_of(j)}, {x_of(i + 1), near[i + 1], z_of(j)},
                  {x_of(i + 1), far[i + 1], z_of(j - 1)}, {x_of(i), far[i], z_of(j - 1)});
    }
  }
  const double eye_height = height_at(noise, 0.0, 0.46 * kSide) + 70.0;
  sketch.camera("lookout", {0.0, eye_height, 0.46 * kSide}, {-40.0, 45.0, -120.0}, 0.85);
  sketch.camera("above", {-380.0, 420.0, 380.0}, {40.0, 20.0, -40.0}, 0.8);
  sketch.sun({0.75, -0.55, -0.25}, {4.2F, 3.8F, 3.2F});
  return sketch.finish();
}

}  // namespace gnomon
