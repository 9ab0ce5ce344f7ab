// A house of few large triangles in a garden of many small ones, by itself or inside a walled yard.
#include <algorithm>
#include <cmath>

#include "gnomon/scene/cottage_parts.h"
#include "gnomon/scene/generator_list.h"

namespace gnomon {
namespace {

CottageMaterials add_materials(MeshSketch& sketch) {
  CottageMaterials m{};
  m.plaster = sketch.material("plaster", {0.86F, 0.81F, 0.71F});
  m.roof = sketch.material("roof", {0.45F, 0.20F, 0.13F}, 0.8F);
  m.timber = sketch.material("timber", {0.32F, 0.21F, 0.13F});
  m.oak = sketch.material("oak", {0.50F, 0.33F, 0.18F}, 0.6F);
  m.floor = sketch.material("floor", {0.46F, 0.33F, 0.22F}, 0.6F);
  m.lawn = sketch.material("lawn", {0.21F, 0.34F, 0.10F});
  m.path = sketch.material("path", {0.55F, 0.51F, 0.45F});
  m.brick = sketch.material("brick", {0.53F, 0.31F, 0.23F});
  m.paint = sketch.material("paint", {0.30F, 0.48F, 0.52F}, 0.7F);
  m.cloth = sketch.material("cloth", {0.62F, 0.20F, 0.18F});
  m.pottery = sketch.material("pottery", {0.25F, 0.36F, 0.55F}, 0.3F);
  m.stone = sketch.material("stone", {0.58F, 0.56F, 0.52F});
  m.grass = sketch.material("grass", {0.29F, 0.46F, 0.13F});
  m.shade = sketch.material("lampshade", {0.85F, 0.72F, 0.50F});
  m.books = {sketch.material("book red", {0.48F, 0.10F, 0.09F}),
             sketch.material("book green", {0.13F, 0.28F, 0.16F}),
             sketch.material("book blue", {0.13F, 0.18F, 0.36F}),
             sketch.material("book tan", {0.62F, 0.48F, 0.29F})};
  const MaterialId stem = sketch.material("stem", {0.18F, 0.40F, 0.12F});
  const MaterialId eye = sketch.material("flower eye", {0.85F, 0.62F, 0.10F});
  m.flowers = {FlowerKind{stem, sketch.material("poppy", {0.80F, 0.12F, 0.08F}), eye},
               FlowerKind{stem, sketch.material("daisy", {0.92F, 0.91F, 0.88F}), eye},
               FlowerKind{stem, sketch.material("cornflower", {0.20F, 0.27F, 0.75F}), eye},
               FlowerKind{stem, sketch.material("marigold", {0.92F, 0.50F, 0.06F}), eye}};
  m.apple = {false, sketch.material("bark", {0.29F, 0.21F, 0.15F}),
             sketch.material("apple leaf", {0.20F, 0.42F, 0.10F})};
  m.birch = {false, sketch.material("birch bark", {0.75F, 0.72F, 0.66F}),
             sketch.material("birch leaf", {0.44F, 0.55F, 0.14F})};
  return m;
}

void draw_trees(Cottage& cottage, std::uint64_t goal) {
  struct Spot {
    Point foot;
    double height;
    bool birch;
  };
  constexpr unsigned kTrees = 4;
  const std::array<Spot, kTrees> spots{{{{6.7, -0.1, 5.6}, 6.0, false},
                                        {{-7.6, -0.1, 1.0}, 7.6, true},
                                        {{-6.9, -0.1, -7.2}, 6.6, false},
                                        {{7.7, -0.1, -4.5}, 8.4, true}}};
  for (unsigned i = 0; i < kTrees; ++i) {
    draw_tree(cottage.sketch, cottage.random, spots[i].foot, spots[i].height,
              spots[i].birch ? cottage.material.birch : cottage.material.apple,
              share_of(cottage.sketch, goal, kTrees - i));
  }
}

// Beds under the front windows and along the path.
void draw_flowers(Cottage& cottage, std::uint64_t goal) {
  SteadyRandom& random = cottage.random;
  while (cottage.sketch.count() + kFlowerTriangles <= goal) {
    const double side = random.chance(0.5) ? -1.0 : 1.0;
    double x = side * random.between(1.0, 4.2);
    double z = cottage.half_z + random.between(0.2, 1.0);
    if (random.chance(0.5)) {
      x = -0.15 + side * random.between(0.75, 1.5);
      z = cottage.half_z + random.between(1.2, 8.0);
    }
    const double height = random.between(0.22, 0.55);
    draw_flower(cottage.sketch, random, {x, -0.01, z}, height, cottage.material.flowers[random.below(4)]);
  }
}

// Tufts all over the lawn but not in the house.
void draw_lawn(Cottage& cottage, std::uint64_t goal) {
  SteadyRandom& random = cottage.random;
  cottage.sketch.use(cottage.material.grass);
  while (cottage.sketch.count() + kBladeTriangles <= goal) {
    const double x = random.between(-9.9, 9.9);
    const double z = random.between(-10.9, 10.9);
    const bool in_house = std::abs(x) < cottage.half_x + 0.2 && std::abs(z) < cottage.half_z + 0.2;
    const bool on_path = std::abs(x + 0.15) < 0.65 && z > 0.0;
    if (in_house || on_path) continue;
    for (unsigned k = 0; k < 7 && cottage.sketch.count() + kBladeTriangles <= goal; ++k) {
      const double dx = random.between(-0.07, 0.07);
      const Point foot{x + dx, -0.01, z + random.between(-0.07, 0.07)};
      draw_grass_blade(cottage.sketch, random, foot, random.between(0.06, 0.22));
    }
  }
}

Scene make(const char* name, std::uint64_t triangles, std::uint64_t seed, bool walled) {
  const double n = static_cast<double>(triangles);
  Cottage cottage{MeshSketch(name, triangles), SteadyRandom(seed)};
  cottage.material = add_materials(cottage.sketch);
  MeshSketch& sketch = cottage.sketch;
  const auto until = [&](double part) { return sketch.count() + static_cast<std::uint64_t>(part * n); };
  sketch.sun({-0.55, -0.62, -0.56}, {5.5F, 5.0F, 4.2F});
  sketch.point_light("lamp", {-1.2, 1.72, 0.0}, {14.0F, 10.0F, 6.0F});
  draw_ground(cottage);
  draw_house(cottage);
  if (walled) {
    draw_yard_walls(cottage);
  } else {
    draw_fence(cottage, until(0.08));
  }
  draw_furniture(cottage, until(0.18));
  draw_trees(cottage, until(0.38));
  draw_flowers(cottage, sketch.count() + static_cast<std::uint64_t>(share_of(sketch, triangles, 2)));
  draw_lawn(cottage, triangles);
  if (walled) {
    sketch.camera("yard", {-7.4, 2.6, 10.4}, {0.6, 1.7, 0.0}, 0.95);
  } else {
    sketch.camera("garden", {-8.6, 2.9, 14.2}, {0.5, 1.7, 0.0}, 0.75);
  }
  sketch.camera("room", {3.4, 1.75, -2.3}, {-2.0, 1.0, 0.6}, 1.05);
  return sketch.finish();
}

}  // namespace

Scene make_cottage(std::uint64_t triangles, std::uint64_t seed) {
  return make("cottage", triangles, seed, false);
}
Scene make_cottage_walls(std::uint64_t triangles, std::uint64_t seed) {
  return make("cottage-walls", triangles, seed, true);
}

}  // namespace gnomon
