// People before a stage in a walled hall: many detailed objects of like size, lit from above and from the
// stage.
#include <algorithm>
#include <array>
#include <cmath>

#include "gnomon/scene/crowd_figure.h"
#include "gnomon/scene/generator_list.h"

namespace gnomon {
namespace {

struct Crowd {
  MeshSketch sketch;
  SteadyRandom random;
  unsigned columns;  // of people, side by side
  unsigned rows;     // of people, one behind the other
  std::array<MaterialId, 5> skin{}, hair{};
  std::array<MaterialId, 8> cloth{};
  MaterialId wall{}, floor{}, stage{}, shoe{}, pillar{}, curtain{};
  [[nodiscard]] double half_x() const { return 0.55 * columns + 2.6; }
  [[nodiscard]] double back() const { return 1.15 * rows + 2.5; }  // the stage's edge is at z = 0
};

constexpr double kHallHeight = 7.5;
constexpr double kStageHeight = 1.1;
constexpr double kStageDepth = 6.0;

void add_materials(Crowd& crowd) {
  MeshSketch& s = crowd.sketch;
  crowd.skin = {
      s.material("skin 1", {0.80F, 0.58F, 0.46F}, 0.6F), s.material("skin 2", {0.62F, 0.41F, 0.29F}, 0.6F),
      s.material("skin 3", {0.40F, 0.25F, 0.17F}, 0.6F), s.material("skin 4", {0.86F, 0.67F, 0.56F}, 0.6F),
      s.material("skin 5", {0.26F, 0.16F, 0.11F}, 0.6F)};
  crowd.hair = {s.material("hair black", {0.03F, 0.03F, 0.03F}, 0.5F),
                s.material("hair brown", {0.16F, 0.09F, 0.05F}, 0.5F),
                s.material("hair fair", {0.58F, 0.43F, 0.22F}, 0.5F),
                s.material("hair red", {0.42F, 0.16F, 0.06F}, 0.5F),
                s.material("hair grey", {0.52F, 0.52F, 0.52F}, 0.5F)};
  crowd.cloth = {s.material("red", {0.62F, 0.10F, 0.10F}),   s.material("navy", {0.08F, 0.12F, 0.30F}),
                 s.material("olive", {0.30F, 0.33F, 0.14F}), s.material("cream", {0.82F, 0.78F, 0.68F}),
                 s.material("teal", {0.08F, 0.40F, 0.42F}),  s.material("mustard", {0.78F, 0.53F, 0.12F}),
                 s.material("plum", {0.36F, 0.12F, 0.30F}),  s.material("grey", {0.33F, 0.34F, 0.36F})};
  crowd.wall = s.material("wall", {0.66F, 0.60F, 0.53F});
  crowd.floor = s.material("floor", {0.40F, 0.26F, 0.15F}, 0.4F);
  crowd.stage = s.material("stage", {0.28F, 0.18F, 0.11F}, 0.5F);
  crowd.shoe = s.material("shoe", {0.07F, 0.06F, 0.06F}, 0.4F);
  crowd.pillar = s.material("pillar", {0.78F, 0.75F, 0.70F});
  crowd.curtain = s.material("stage curtain", {0.45F, 0.05F, 0.07F});
}

// Floor, four walls and ceiling as boxes, pilasters along the sides, a stage before a wavy curtain.
void draw_hall(Crowd& crowd, std::uint64_t goal) {
  MeshSketch& s = crowd.sketch;
  const double x = crowd.half_x();
  const double back = crowd.back();
  const Frame frame;
  const double front = -kStageDepth;
  s.use(crowd.floor);
  s.box(frame, {-x, -0.3, front}, {x, 0.0, back});
  s.use(crowd.wall);
  s.box(frame, {-x - 0.4, -0.3, front - 0.4}, {-x, kHallHeight, back + 0.4});
  s.box(frame, {x, -0.3, front - 0.4}, {x + 0.4, kHallHeight, back + 0.4});
  s.box(frame, {-x, -0.3, front - 0.4}, {x, kHallHeight, front});
  s.box(frame, {-x, -0.3, back}, {x, kHallHeight, back + 0.4});
  s.box(frame, {-x - 0.4, kHallHeight, front - 0.4}, {x + 0.4, kHallHeight + 0.3, back + 0.4});
  s.use(crowd.stage);
  s.box(frame, {-x, 0.0, front}, {x, kStageHeight, 0.0});
  const unsigned pillars = at_least(3, (back - front) / 5.0);
  s.use(crowd.pillar);
  for (unsigned i = 0; i < pillars; ++i) {
    const double z = front + (back - front) * (i + 0.5) / pillars;
    s.box(frame, {-x, 0.0, z - 0.3}, {-x + 0.25, kHallHeight, z + 0.3});
    s.box(frame, {x - 0.25, 0.0, z - 0.3}, {x, kHallHeight, z + 0.3});
  }
  s.use(crowd.curtain);
  const unsigned across = at_least(24, std::sqrt(share_of(s, goal, 1) * 1.5));
  const unsigned down = at_least(2, share_of(s, goal, 1) / (2.0 * across));
  s.sheet(across, down, [&](unsigned i, unsigned j) {
    const double u = 2.0 * i / across - 1.0;
    const double v = static_cast<double>(j) / down;
    const double fold = 0.14 * (1.2 - 0.4 * v) * sin_turns(2.2 * x * u + 0.1 * sin_turns(v));
    return Point{x * u, kStageHeight + v * (kHallHeight - kStageHeight), front + 0.4 + fold};
  });
}

Outfit dress(Crowd& crowd) {
  Outfit outfit{};
  outfit.skin = crowd.skin[crowd.random.below(5)];
  outfit.hair = crowd.hair[crowd.random.below(5)];
  outfit.top = crowd.cloth[crowd.random.below(8)];
  outfit.legs = crowd.cloth[crowd.random.below(8)];
  outfit.shoes = crowd.shoe;
  outfit.skirt = crowd.random.chance(0.35);
  return outfit;
}

void draw_person(Crowd& crowd, const Point& place, double turns, std::uint64_t left, std::uint64_t goal) {
  const double height = crowd.random.between(1.55, 1.95);
  const auto pose = static_cast<Pose>(crowd.random.below(static_cast<unsigned>(Pose::kCount)));
  const Outfit outfit = dress(crowd);
  draw_figure(crowd.sketch, crowd.random, upright(place, turns), height, pose, outfit,
              share_of(crowd.sketch, goal, left));
}

// Three performers on the stage, the others below, most of them looking up to it.
void draw_people(Crowd& crowd, std::uint64_t goal) {
  constexpr unsigned kPerformers = 3;
  std::uint64_t left = static_cast<std::uint64_t>(crowd.columns) * crowd.rows + kPerformers;
  for (unsigned i = 0; i < kPerformers; ++i) {
    const double x = 2.2 * (static_cast<double>(i) - 1.0);
    const double z = -1.6 - 0.7 * (i % 2);
    draw_person(crowd, {x, kStageHeight, z}, crowd.random.between(-0.08, 0.08), left--, goal);
  }
  for (unsigned j = 0; j < crowd.rows; ++j) {
    for (unsigned i = 0; i < crowd.columns; ++i) {
      const double shift = j % 2 == 0 ? 0.25 : -0.25;
      const double x = 1.1 * (i + 0.5 - 0.5 * crowd.columns) + shift + crowd.random.between(-0.16, 0.16);
      const double z = 1.6 + 1.15 * j + crowd.random.between(-0.2, 0.2);
      const double towards = crowd.random.chance(0.15) ? 0.0 : 0.5;  // some turn round to those behind
      draw_person(crowd, {x, 0.0, z}, towards + crowd.random.between(-0.09, 0.09), left--, goal);
    }
  }
}

// Panels in the ceiling, spots from the back onto the stage and from the stage's edge into the hall.
void add_lights(Crowd& crowd) {
  MeshSketch& s = crowd.sketch;
  const double x = crowd.half_x();
  const double back = crowd.back();
  const double y = kHallHeight - 0.02;
  const auto panel = [&](const char* name, double middle, const Vec3& emission) {
    s.use(s.material(name, {0.2F, 0.2F, 0.2F}, 1.0F, emission));
    s.quad({-0.5 * x, y, middle - 0.5}, {0.5 * x, y, middle - 0.5}, {0.5 * x, y, middle + 0.5},
           {-0.5 * x, y, middle + 0.5});
  };
  panel("front panel", 0.25 * back, {9.0F, 7.6F, 5.8F});
  panel("back panel", 0.75 * back, {7.0F, 6.6F, 6.2F});
  s.spot_light("stage spot left", {-0.7 * x, kHallHeight - 0.8, 0.55 * back}, {-1.5, 2.0, -1.8},
               {650.0F, 560.0F, 420.0F}, 0.3);
  s.spot_light("stage spot right", {0.7 * x, kHallHeight - 0.8, 0.55 * back}, {1.5, 2.0, -1.8},
               {420.0F, 500.0F, 680.0F}, 0.3);
  s.spot_light("house spot", {0.0, kHallHeight - 0.6, -3.0}, {0.0, 0.5, 0.5 * back}, {420.0F, 330.0F, 260.0F},
               0.6);
  s.point_light("footlight", {0.0, kStageHeight + 0.35, -0.5}, {9.0F, 6.5F, 4.0F});
}

void add_cameras(Crowd& crowd) {
  const double x = crowd.half_x();
  const double back = crowd.back();
  crowd.sketch.camera("balcony", {-0.8 * x, 4.6, back - 0.7}, {0.25 * x, 1.0, 0.1 * back}, 0.95);
  crowd.sketch.camera("stage", {1.1, 3.3, -3.2}, {-0.1 * x, 0.9, 0.45 * back}, 0.95);
}

}  // namespace

Scene make_crowd(std::uint64_t triangles, std::uint64_t seed) {
  const double n = static_cast<double>(triangles);
  const double people = std::max(7.0, std::min(std::sqrt(n) / 6.0, (0.85 * n) / kMinFigureTriangles - 3.0));
  const unsigned columns = at_least(3, std::sqrt(people * 1.3));
  Crowd crowd{MeshSketch("crowd", triangles), SteadyRandom(seed), columns, at_least(2, people / columns)};
  add_materials(crowd);
  add_lights(crowd);
  draw_hall(crowd, crowd.sketch.count() + static_cast<std::uint64_t>(0.06 * n));
  draw_people(crowd, triangles);
  add_cameras(crowd);
  return crowd.sketch.finish();
}

}  // namespace gnomon
