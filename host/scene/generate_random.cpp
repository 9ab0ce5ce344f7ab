// Triangle clouds: a scalable one, and the two of the thesis bit for bit.
#include <array>
#include <random>

#include "gnomon/scene/generator_list.h"
#include "gnomon/scene/mesh_sketch.h"

namespace gnomon {
namespace {

// What libstdc++'s std::uniform_real_distribution<double>(lo, hi) gives on a 32-bit engine: two draws, low
// word first. Spelled out because the standard leaves the arithmetic open and the thesis' scenes depend on
// it.
double uniform_as_libstdcxx(std::mt19937& engine, double lo, double hi) {
  const auto low = static_cast<double>(engine());
  const double sum = low + static_cast<double>(engine()) * 0x1.0p32;
  double unit = sum * 0x1.0p-64;
  if (unit >= 1.0) unit = 0x1.fffffffffffffp-1;
  return unit * (hi - lo) + lo;
}

Vec3 offset_from(const Vec3& base, std::mt19937& engine, double lo, double hi) {
  Vec3 result{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    result[axis] = base[axis] + static_cast<float>(uniform_as_libstdcxx(engine, lo, hi));
  }
  return result;
}

constexpr std::array<Vec3, 6> kPalette{{{0.75F, 0.22F, 0.17F},
                                        {0.90F, 0.55F, 0.15F},
                                        {0.93F, 0.80F, 0.35F},
                                        {0.30F, 0.55F, 0.35F},
                                        {0.18F, 0.42F, 0.62F},
                                        {0.80F, 0.78F, 0.74F}}};

void add_palette(MeshSketch& sketch) {
  constexpr std::array<const char*, kPalette.size()> kNames{"red",   "orange", "yellow",
                                                            "green", "blue",   "chalk"};
  for (unsigned i = 0; i < kPalette.size(); ++i)
    static_cast<void>(sketch.material(kNames[i], kPalette[i], 0.7F));
}

// Both thesis scenes come from one engine: Random100 is drawn first, Random1000 right after it.
Scene make_thesis_scene(std::string_view name, unsigned skipped, unsigned count) {
  MeshSketch sketch(name, count);
  add_palette(sketch);
  std::mt19937 engine(1);
  for (unsigned i = 0; i < skipped + count; ++i) {
    const Vec3 v0 = offset_from({0.0F, 0.0F, 0.0F}, engine, 0.0, 10.0);
    const Vec3 v1 = offset_from(v0, engine, -1.0, 1.0);
    const Vec3 v2 = offset_from(v1, engine, -1.0, 1.0);
    if (i < skipped) continue;
    sketch.use(static_cast<MaterialId>(i % kPalette.size()));
    sketch.triangle(v0, v1, v2);
  }
  sketch.camera("front", {5.0, 6.0, 22.0}, {5.0, 5.0, 5.0}, 0.75, 1.0);
  sketch.sun({-0.4, -1.0, -0.6}, {3.0F, 2.9F, 2.7F});
  sketch.point_light("lamp", {14.0, 12.0, 16.0}, {160.0F, 160.0F, 170.0F});
  return sketch.finish();
}

// Cube root by Newton's iteration, so that no libm has a say in it.
double cube_root(double value) {
  double root = 1.0;
  while (root * root * root < value) root *= 2.0;
  for (int i = 0; i < 60; ++i) root -= (root * root * root - value) / (3.0 * root * root);
  return root;
}

}  // namespace

Scene make_random100(std::uint64_t, std::uint64_t) {
  return make_thesis_scene("random100", 0, 100);
}
Scene make_random1000(std::uint64_t, std::uint64_t) {
  return make_thesis_scene("random1000", 100, 1000);
}

// A cube of side 10; edges shrink with the cube root of the count, so that every count is about equally
// dense.
Scene make_random(std::uint64_t triangles, std::uint64_t seed) {
  MeshSketch sketch("random", triangles);
  add_palette(sketch);
  SteadyRandom random(seed);
  const double reach = 5.0 / cube_root(static_cast<double>(triangles));
  const auto near = [&](const Point& base, double by) {
    const double x = random.between(-by, by);
    const double y = random.between(-by, by);
    return base + Point{x, y, random.between(-by, by)};
  };
  while (sketch.count() < triangles) {  // a flat one is left out by the sketch and drawn again
    sketch.use(random.below(kPalette.size()));
    const Point v0 = near({5.0, 5.0, 5.0}, 5.0);
    const Point v1 = near(v0, reach);
    sketch.triangle(v0, v1, near(v1, reach));
  }
  sketch.camera("front", {5.0, 6.0, 22.0}, {5.0, 5.0, 5.0}, 0.75, 1.0);
  sketch.sun({-0.4, -1.0, -0.6}, {3.0F, 2.9F, 2.7F});
  sketch.point_light("lamp", {14.0, 12.0, 16.0}, {160.0F, 160.0F, 170.0F});
  return sketch.finish();
}

}  // namespace gnomon
