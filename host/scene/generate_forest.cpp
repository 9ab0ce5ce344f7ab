// A wood with a path through it: trunks, branches and leaf cards on uneven ground, grass and stones between
// them.
#include <array>
#include <cmath>

#include "gnomon/scene/generator_list.h"
#include "gnomon/scene/plants.h"
#include "gnomon/scene/value_noise.h"

namespace gnomon {
namespace {

constexpr double kSpacing = 4.6;  // between trees

struct Forest {
  MeshSketch sketch;
  ValueNoise noise;
  SteadyRandom random;
  unsigned rows;  // of trees, each way
  MaterialId soil{}, path{}, stone{}, grass{};
  std::array<TreeKind, 4> kinds{};
  [[nodiscard]] double half() const { return 0.5 * kSpacing * rows; }
};

void add_materials(Forest& forest) {
  MeshSketch& sketch = forest.sketch;
  forest.soil = sketch.material("soil", {0.20F, 0.16F, 0.09F});
  forest.path = sketch.material("path", {0.42F, 0.33F, 0.22F});
  forest.stone = sketch.material("stone", {0.42F, 0.41F, 0.39F});
  forest.grass = sketch.material("grass", {0.24F, 0.38F, 0.10F});
  const MaterialId oak = sketch.material("oak bark", {0.27F, 0.19F, 0.12F});
  const MaterialId birch = sketch.material("birch bark", {0.72F, 0.69F, 0.63F});
  const MaterialId fir = sketch.material("fir bark", {0.24F, 0.15F, 0.10F});
  forest.kinds = {TreeKind{false, oak, sketch.material("oak leaf", {0.20F, 0.40F, 0.09F})},
                  TreeKind{true, fir, sketch.material("fir needle", {0.07F, 0.24F, 0.11F})},
                  TreeKind{false, birch, sketch.material("birch leaf", {0.46F, 0.52F, 0.12F})},
                  TreeKind{true, fir, sketch.material("larch needle", {0.22F, 0.36F, 0.10F})}};
}

// The path winds along z; the ground is trodden flat on it.
double path_at(double z) {
  return 1.6 * sin_turns(z / 31.0) + 0.7 * sin_turns(z / 13.0 + 0.2);
}
double ground_at(const Forest& forest, double x, double z) {
  const double away = std::abs(x - path_at(z)) / 2.5;
  const double rough = forest.noise.octaves(x / 3.1, z / 3.1, 3) * 0.35 * (away < 1.0 ? away * away : 1.0);
  return 3.2 * forest.noise.octaves(x / 34.0, z / 34.0, 2) + rough;
}

void draw_ground(Forest& forest, std::uint64_t goal) {
  const double half = 1.15 * forest.half();
  const unsigned cells = at_least(8, std::sqrt(share_of(forest.sketch, goal, 2)));
  const auto along = [&](unsigned i) { return half * (2.0 * i / cells - 1.0); };
  const auto point = [&](unsigned i, unsigned j) {
    return Point{along(i), ground_at(forest, along(i), along(j)), along(j)};
  };
  for (unsigned j = 0; j < cells; ++j) {
    for (unsigned i = 0; i < cells; ++i) {
      const double x = 0.5 * (along(i) + along(i + 1));
      const double z = 0.5 * (along(j) + along(j + 1));
      const double edge = std::abs(x - path_at(z)) + 0.8 * forest.noise.at(x, z);
      forest.sketch.use(edge < 1.4 ? forest.path
                                   : (forest.noise.at(x / 4.0, z / 4.0) > 0.5 ? forest.grass : forest.soil));
      forest.sketch.quad(point(i, j + 1), point(i + 1, j + 1), point(i + 1, j), point(i, j));
    }
  }
}

void draw_trees(Forest& forest, std::uint64_t goal) {
  std::uint64_t left = static_cast<std::uint64_t>(forest.rows) * forest.rows;
  for (unsigned j = 0; j < forest.rows; ++j) {
    for (unsigned i = 0; i < forest.rows; ++i) {
      const double z = kSpacing * (j + forest.random.between(0.1, 0.9)) - forest.half();
      double x = kSpacing * (i + forest.random.between(0.1, 0.9)) - forest.half();
      const double off = x - path_at(z);
      if (std::abs(off) < 3.4) x = path_at(z) + (off < 0.0 ? -3.4 : 3.4);
      const double height = forest.random.between(7.0, 15.0);
      const TreeKind& kind =
          forest.kinds[forest.noise.at(x / 9.0, z / 9.0) > 0.52 ? 1 + 2 * forest.random.below(2)
                                                                : 2 * forest.random.below(2)];
      draw_tree(forest.sketch, forest.random, {x, ground_at(forest, x, z) - 0.15, z}, height, kind,
                share_of(forest.sketch, goal, left--));
    }
  }
}

void draw_stones(Forest& forest, std::uint64_t goal) {
  const auto stones = at_least(3, std::sqrt(share_of(forest.sketch, goal, 1)) / 4.0);
  for (unsigned i = 0; i < stones; ++i) {
    const double each = share_of(forest.sketch, goal, stones - i);
    const unsigned rings = at_least(3, std::sqrt(each / 4.0));
    const double z = forest.half() * forest.random.between(-0.95, 0.95);
    const double x = path_at(z) + (i % 2 == 0 ? -1.0 : 1.0) * forest.random.between(1.2, 6.0);
    const double size = forest.random.between(0.12, 0.5);
    Frame frame = upright({x, ground_at(forest, x, z), z}, forest.random.unit());
    forest.sketch.use(forest.stone);
    forest.sketch.ellipsoid(frame, {size * forest.random.between(0.8, 1.5), 0.6 * size, size}, 2 * rings,
                            rings);
  }
}

// Tufts beside the path, until the count is reached.
void draw_grass(Forest& forest, std::uint64_t goal) {
  forest.sketch.use(forest.grass);
  while (forest.sketch.count() + kBladeTriangles <= goal) {
    const double z = forest.half() * forest.random.between(-1.0, 1.0);
    const double spread = forest.random.unit();
    const double x = path_at(z) + (forest.random.chance(0.5) ? -1.0 : 1.0) * (1.1 + 9.0 * spread * spread);
    for (unsigned k = 0; k < 9 && forest.sketch.count() + kBladeTriangles <= goal; ++k) {
      const double u = x + forest.random.between(-0.15, 0.15);
      const double v = z + forest.random.between(-0.15, 0.15);
      draw_grass_blade(forest.sketch, forest.random, {u, ground_at(forest, u, v) - 0.02, v},
                       forest.random.between(0.15, 0.45));
    }
  }
}

// A wayside lamp: a post with a glowing plate under its roof, and a point light in front of it.
void add_lights(Forest& forest) {
  MeshSketch& sketch = forest.sketch;
  sketch.sun({0.42, -0.8, -0.3}, {9.0F, 8.2F, 6.6F});
  const double z = 0.35 * forest.half();
  const Point foot{path_at(z) + 1.7, 0.0, z};
  const Frame post = upright({foot.x, ground_at(forest, foot.x, foot.z), foot.z});
  sketch.use(forest.kinds[1].bark);
  sketch.box(post, {-0.06, -0.3, -0.06}, {0.06, 2.2, 0.06});
  sketch.box(post, {-0.5, 2.2, -0.2}, {0.1, 2.26, 0.2});
  sketch.use(sketch.material("lamp plate", {0.2F, 0.2F, 0.2F}, 1.0F, {30.0F, 20.0F, 9.0F}));
  sketch.quad(post.at(-0.45, 2.19, -0.15), post.at(-0.1, 2.19, -0.15), post.at(-0.1, 2.19, 0.15),
              post.at(-0.45, 2.19, 0.15));
  sketch.point_light("lantern", post.at(-0.3, 1.9, 0.0), {9.0F, 6.0F, 3.0F});
}

void add_cameras(Forest& forest) {
  const double start = 0.8 * forest.half();
  const double end = 0.8 * forest.half() - 14.0;
  forest.sketch.camera("path", {path_at(start), ground_at(forest, path_at(start), start) + 1.7, start},
                       {path_at(end), ground_at(forest, path_at(end), end) + 2.6, end}, 1.0);
  const double half = forest.half();
  forest.sketch.camera("above", {-1.2 * half, 0.9 * half + 16.0, 1.6 * half}, {0.0, 3.0, 0.0}, 0.75);
}

}  // namespace

Scene make_forest(std::uint64_t triangles, std::uint64_t seed) {
  const double n = static_cast<double>(triangles);
  Forest forest{MeshSketch("forest", triangles), ValueNoise(seed), SteadyRandom(seed),
                at_least(4, std::sqrt(std::sqrt(n) / 7.0))};
  add_materials(forest);
  add_lights(forest);
  draw_ground(forest, forest.sketch.count() + static_cast<std::uint64_t>(0.12 * n));
  draw_stones(forest, forest.sketch.count() + static_cast<std::uint64_t>(0.03 * n));
  draw_trees(forest, static_cast<std::uint64_t>(0.9 * n));
  draw_grass(forest, triangles);
  add_cameras(forest);
  return forest.sketch.finish();
}

}  // namespace gnomon
