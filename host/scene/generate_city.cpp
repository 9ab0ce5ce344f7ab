// Towers with ledges and windows on rolling ground, and long thin cables slung between them: the boxes of
// slanted cables are mostly empty, which is what hurts a hierarchy.
#include <algorithm>
#include <array>
#include <cmath>

#include "gnomon/scene/generator_list.h"
#include "gnomon/scene/mesh_sketch.h"
#include "gnomon/scene/value_noise.h"

namespace gnomon {
namespace {

constexpr double kBlock = 46.0;   // a block with its street
constexpr double kStreet = 16.0;  // the street's part of it

struct Tower {
  Point foot;  // centre, on the ground
  double half_x, half_z, height;
  double turn;
};

struct City {
  MeshSketch sketch;
  ValueNoise noise;
  SteadyRandom random;
  unsigned blocks;  // along one side
  std::vector<Tower> towers{};
  MaterialId grass{}, road{}, glass{}, steel{}, lamp{};
  std::array<MaterialId, 4> walls{};
  [[nodiscard]] double half() const { return 0.5 * kBlock * blocks; }
};

void add_materials(City& city) {
  MeshSketch& sketch = city.sketch;
  city.grass = sketch.material("grass", {0.22F, 0.32F, 0.14F});
  city.road = sketch.material("road", {0.16F, 0.16F, 0.17F});
  city.glass = sketch.material("glass", {0.16F, 0.24F, 0.31F}, 0.15F);
  city.steel = sketch.material("steel", {0.30F, 0.30F, 0.32F}, 0.4F);
  city.walls = {sketch.material("limestone", {0.72F, 0.67F, 0.57F}),
                sketch.material("brick", {0.47F, 0.24F, 0.18F}),
                sketch.material("concrete", {0.52F, 0.52F, 0.51F}),
                sketch.material("sandstone", {0.70F, 0.53F, 0.38F})};
  city.lamp = sketch.material("billboard", {0.1F, 0.1F, 0.1F}, 1.0F, {14.0F, 9.0F, 5.0F});
}

// Gentle: towers stand on it, so it may not drop by more than their plinths reach down.
double ground_at(const City& city, double x, double z) {
  return 9.0 * city.noise.octaves(x / 260.0, z / 260.0, 3);
}

void draw_ground(City& city, std::uint64_t goal) {
  const double margin = 1.35 * city.half();
  const unsigned cells = at_least(6, std::sqrt(share_of(city.sketch, goal, 2)));
  const auto along = [&](unsigned i) { return margin * (2.0 * i / cells - 1.0); };
  const auto point = [&](unsigned i, unsigned j) {
    return Point{along(i), ground_at(city, along(i), along(j)), along(j)};
  };
  for (unsigned j = 0; j < cells; ++j) {
    for (unsigned i = 0; i < cells; ++i) {
      const double x = std::abs(along(i) + along(i + 1)) / 2.0;
      const double z = std::abs(along(j) + along(j + 1)) / 2.0;
      city.sketch.use(std::max(x, z) < city.half() ? city.road : city.grass);
      city.sketch.quad(point(i, j + 1), point(i + 1, j + 1), point(i + 1, j), point(i, j));
    }
  }
}

void place_towers(City& city) {
  for (unsigned row = 0; row < city.blocks; ++row) {
    for (unsigned column = 0; column < city.blocks; ++column) {
      const double x = kBlock * (column + 0.5) - city.half();
      const double z = kBlock * (row + 0.5) - city.half();
      const double room = 0.5 * (kBlock - kStreet);
      const double centre =
          1.0 - std::sqrt(x * x + z * z) / (1.5 * city.half());  // taller towards the middle
      const double half_x = room * city.random.between(0.55, 0.95);
      const double half_z = room * city.random.between(0.55, 0.95);
      const double luck = city.random.unit();  // squared: many low roofs, few that stand out
      const double height = 14.0 + 18.0 * city.random.unit() + 135.0 * centre * (0.06 + 0.94 * luck * luck);
      const double turn = city.random.chance(0.2) ? city.random.between(-0.03, 0.03) : 0.0;
      city.towers.push_back({{x, ground_at(city, x, z), z}, half_x, half_z, height, turn});
    }
  }
}

// One facade: a grid of windows, each a pane set before the wall over a sill. The frame's x runs along the
// facade, y up, z outwards.
void draw_facade(City& city, const Frame& frame, double width, double height, double windows,
                 MaterialId wall) {
  const unsigned storeys = at_least(1, std::sqrt(windows * height / (1.2 * width)));
  const unsigned bays = at_least(1, windows / storeys);
  const double dx = width / bays;
  const double dy = height / storeys;
  for (unsigned j = 0; j < storeys; ++j) {
    for (unsigned i = 0; i < bays; ++i) {
      const Frame cell = frame.moved(-0.5 * width + dx * i, dy * j, 0.0);
      city.sketch.use(city.glass);
      city.sketch.quad(cell.at(0.18 * dx, 0.24 * dy, 0.05), cell.at(0.82 * dx, 0.24 * dy, 0.05),
                       cell.at(0.82 * dx, 0.86 * dy, 0.05), cell.at(0.18 * dx, 0.86 * dy, 0.05));
      city.sketch.use(wall);
      city.sketch.box(cell, {0.12 * dx, 0.16 * dy, -0.02}, {0.88 * dx, 0.23 * dy, 0.06 + 0.05 * dy});
    }
  }
}

void draw_tier(City& city, const Frame& base, double half_x, double half_z, double height, double windows,
               MaterialId wall) {
  city.sketch.use(wall);
  city.sketch.box(base, {-half_x, 0.0, -half_z}, {half_x, height, half_z});
  city.sketch.box(base, {-half_x - 0.5, height - 0.9, -half_z - 0.5},
                  {half_x + 0.5, height + 0.4, half_z + 0.5});
  if (windows < 4.0) return;
  const double around = 4.0 * (half_x + half_z);
  for (unsigned side = 0; side < 4; ++side) {
    const bool along_x = side % 2 == 0;
    const double width = 2.0 * (along_x ? half_x : half_z);
    const double depth = along_x ? half_z : half_x;
    const Frame turned = upright({0.0, 0.0, 0.0}, 0.25 * side);
    const Frame facade{base.origin, turned.x.x * base.x + turned.x.z * base.z, base.y,
                       turned.z.x * base.x + turned.z.z * base.z};
    draw_facade(city, facade.moved(0.0, 0.5, depth), width, height - 1.6, windows * width / around, wall);
  }
}

// Up to three tiers, each set back; a mast on the tallest.
void draw_tower(City& city, const Tower& tower, double triangles) {
  const MaterialId wall = city.walls[city.random.below(4)];
  const unsigned tiers = tower.height > 70.0 ? 3 : (tower.height > 42.0 ? 2 : 1);
  constexpr std::array<std::array<double, 3>, 3> kShare{
      {{1.0, 0.0, 0.0}, {0.65, 0.35, 0.0}, {0.5, 0.3, 0.2}}};
  const Frame ground = upright(tower.foot, tower.turn);
  city.sketch.use(wall);
  city.sketch.box(ground, {-tower.half_x - 1.0, -6.0, -tower.half_z - 1.0},
                  {tower.half_x + 1.0, 0.6, tower.half_z + 1.0});
  const double windows = (triangles - 12.0 - 24.0 * tiers - (tiers == 3 ? 8.0 : 0.0)) / 14.0;
  double y = 0.6;
  for (unsigned tier = 0; tier < tiers; ++tier) {
    const double inset = 1.0 - 0.22 * tier;
    const double part = kShare[tiers - 1][tier];
    draw_tier(city, ground.moved(0.0, y, 0.0), inset * tower.half_x, inset * tower.half_z,
              part * tower.height, part * windows, wall);
    y += part * tower.height;
  }
  if (tiers < 3) return;
  city.sketch.use(city.steel);
  const Point top = ground.at(0.0, y, 0.0);
  city.sketch.bar(top, top + Point{0.0, 14.0, 0.0}, 0.2, 4);
}

// A cable hangs a little: `pieces` straight bars along a parabola.
void draw_cable(City& city, const Point& from, const Point& to, double sag, unsigned pieces, double radius) {
  std::vector<Point> path;
  for (unsigned i = 0; i <= pieces; ++i) {
    const double t = static_cast<double>(i) / pieces;
    path.push_back(from + t * (to - from) - Point{0.0, 4.0 * sag * t * (1.0 - t), 0.0});
  }
  const std::vector<double> radii(path.size(), radius);
  city.sketch.use(city.steel);
  city.sketch.tube(path, radii, 3);
}

Point anchor_on(City& city, const Tower& tower) {
  const double x = city.random.between(-0.5, 0.5) * tower.half_x;
  const double z = city.random.between(-0.5, 0.5) * tower.half_z;
  return upright(tower.foot, tower.turn).at(x, tower.height + 0.7, z);
}

// Every sixth cable crosses the whole city from corner to corner; the others join near or far towers.
void draw_cables(City& city, std::uint64_t goal) {
  const auto towers = static_cast<unsigned>(city.towers.size());
  for (unsigned i = 0; city.sketch.count() + 6 <= goal; ++i) {
    const double left = share_of(city.sketch, goal, 1) / 6.0;
    const unsigned pieces = std::min(at_least(1, left - 0.5), i % 3 == 0 ? 1U : 2U + i % 5U);
    const Tower& first = city.towers[city.random.below(towers)];
    const Tower& second = city.towers[city.random.below(towers)];
    const Point from = anchor_on(city, first);
    Point to = anchor_on(city, second);
    if (i % 6 == 0 || glm::length(to - from) < 30.0) {
      to = {from.x > 0.0 ? -1.3 * city.half() : 1.3 * city.half(), 0.0,
            from.z > 0.0 ? -1.3 * city.half() : 1.3 * city.half()};
      to.y = ground_at(city, to.x, to.z);
    }
    draw_cable(city, from, to, 0.03 * glm::length(to - from), pieces, city.random.between(0.04, 0.12));
  }
}

// Lamps over the crossings of the middle avenue and a glowing board on its own legs at the avenue's end.
void add_lights(City& city) {
  city.sketch.sun({-0.42, -0.6, -0.62}, {4.0F, 3.7F, 3.2F});
  const double avenue = city.blocks % 2 == 0 ? 0.0 : 0.5 * kBlock;
  for (int i = -1; i <= 1; ++i) {
    const double z = avenue + i * kBlock;
    city.sketch.point_light("crossing", {avenue, ground_at(city, avenue, z) + 9.0, z},
                            {420.0F, 330.0F, 220.0F});
  }
  const double far = -1.05 * city.half();
  const Point foot{avenue, ground_at(city, avenue, far) + 14.0, far};
  city.sketch.use(city.lamp);
  city.sketch.quad(foot + Point{-7.0, 0.0, 0.0}, foot + Point{7.0, 0.0, 0.0}, foot + Point{7.0, 8.0, 0.0},
                   foot + Point{-7.0, 8.0, 0.0});
  city.sketch.spot_light("searchlight", foot + Point{0.0, 12.0, 3.0}, {avenue, 5.0, 0.0},
                         {9000.0F, 9000.0F, 9500.0F}, 0.35);
}

void add_cameras(City& city) {
  const double half = city.half();
  city.sketch.camera("overlook", {0.95 * half, 0.42 * half + 40.0, 1.25 * half},
                     {-0.05 * half, 18.0, -0.05 * half}, 0.75);
  const double avenue = city.blocks % 2 == 0 ? 0.0 : 0.5 * kBlock;
  const Point eye{avenue, ground_at(city, avenue, 0.95 * half) + 6.0, 0.95 * half};
  city.sketch.camera("avenue", eye, {avenue, 26.0, -half}, 0.95);
}

}  // namespace

Scene make_city(std::uint64_t triangles, std::uint64_t seed) {
  const double n = static_cast<double>(triangles);
  City city{MeshSketch("city", triangles), ValueNoise(seed), SteadyRandom(seed),
            at_least(4, std::sqrt(std::sqrt(n)) / 2.2)};
  add_materials(city);
  place_towers(city);
  add_lights(city);
  draw_ground(city, city.sketch.count() + static_cast<std::uint64_t>(0.12 * n));
  const auto towers_goal = static_cast<std::uint64_t>(0.965 * n);
  std::uint64_t left = city.towers.size();
  for (const Tower& tower : city.towers) draw_tower(city, tower, share_of(city.sketch, towers_goal, left--));
  draw_cables(city, triangles);
  add_cameras(city);
  return city.sketch.finish();
}

}  // namespace gnomon
