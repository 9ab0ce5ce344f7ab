// What stands and hangs in the atrium: tiles, balusters, fountain, pots, lanterns, curtains.
#include <algorithm>
#include <cmath>
#include <vector>

#include "gnomon/scene/atrium_parts.h"

namespace gnomon {
namespace {

using Profile = std::vector<glm::dvec2>;

// A floor tile with worn edges, its middle a hair out of level.
void draw_tile(MeshSketch& sketch, const Point& middle, double half_x, double half_z, double height) {
  const auto at = [&](double x, double z, double inset, double y) {
    return middle + Point{x * (half_x - inset), y, z * (half_z - inset)};
  };
  constexpr std::array<std::array<double, 2>, 4> kCorners{
      {{-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}}};
  std::array<Point, 4> top;
  std::array<Point, 4> foot;
  for (unsigned i = 0; i < 4; ++i) {
    top[i] = at(kCorners[i][0], kCorners[i][1], 0.035 * std::min(half_x, half_z) + 0.006, height);
    foot[i] = at(kCorners[i][0], kCorners[i][1], 0.012 * std::min(half_x, half_z) + 0.002, 0.0);
  }
  sketch.quad(top[0], top[1], top[2], top[3]);
  for (unsigned i = 0; i < 4; ++i) sketch.quad(foot[i], foot[(i + 1) % 4], top[(i + 1) % 4], top[i]);
}

// A profile drawn through a few (radius, height) knots, `steps` rings between each pair, eased so that it
// swells.
Profile swelling(std::initializer_list<glm::dvec2> knots, unsigned steps) {
  Profile profile;
  const glm::dvec2* const knot = knots.begin();
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    for (unsigned i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double eased = t * t * (3.0 - 2.0 * t);
      profile.push_back(
          {knot[k].x + eased * (knot[k + 1].x - knot[k].x), knot[k].y + t * (knot[k + 1].y - knot[k].y)});
    }
  }
  profile.push_back(knot[knots.size() - 1]);
  return profile;
}

// Turns a profile of `knots - 1` spans with about `triangles` triangles.
void turn(MeshSketch& sketch, const Frame& frame, std::initializer_list<glm::dvec2> knots, double triangles) {
  const auto spans = static_cast<double>(knots.size() - 1);
  const unsigned steps = std::clamp(at_least(1, std::sqrt(triangles / (6.0 * spans * spans)) - 0.3), 1U, 40U);
  const unsigned sides = at_least(5, triangles / (2.0 * spans * steps));
  sketch.lathe(frame, swelling(knots, steps), sides);
}

// A long leaf that bends over under its weight: a strip of `pieces` quads from root to tip.
void draw_blade(MeshSketch& sketch, const Frame& root, double length, double width, unsigned pieces) {
  sketch.sheet(1, pieces, [&](unsigned i, unsigned j) {
    const double t = static_cast<double>(j) / pieces;
    const double wide = width * (0.25 + t) * (1.0 - t) * 1.6;
    return root.at(i == 0 ? -wide : wide, length * t * (1.0 - 0.45 * t), length * 0.75 * t * t);
  });
}

void draw_ring(MeshSketch& sketch, const Point& middle, double radius, double thick, unsigned around,
               unsigned sides) {
  sketch.sheet(
      sides, around,
      [&](unsigned i, unsigned j) {
        const double a = static_cast<double>(j % around) / around;
        const double b = static_cast<double>(i) / sides;
        const double r = radius + thick * cos_turns(b);
        return middle + Point{r * cos_turns(a), thick * sin_turns(b), r * sin_turns(a)};
      },
      Rim::kClosed);
}

struct Curtain {
  Point middle;  // of the rod
  double width, drop, depth;
  double waves, phase, gather;
};

// Cloth on a rod: folds that deepen downwards and, where it is gathered, a waist.
void draw_curtain(Atrium& hall, const Curtain& cloth, double triangles) {
  const unsigned across = at_least(12, std::sqrt(0.5 * triangles * 1.6 * cloth.width / cloth.drop * 2.0));
  const unsigned down = at_least(4, triangles / (2.0 * across));
  hall.sketch.sheet(across, down, [&](unsigned i, unsigned j) {
    const double u = static_cast<double>(i) / across - 0.5;
    const double v = 1.0 - static_cast<double>(j) / down;  // 0 at the rod
    const double waist = 1.0 - cloth.gather * sin_turns(0.5 * std::min(1.0, 1.35 * v));
    const double fold = sin_turns(cloth.waves * u + cloth.phase + 0.06 * sin_turns(1.3 * v));
    const double small = 0.3 * sin_turns(2.7 * cloth.waves * u + 0.4 * v + 2.0 * cloth.phase);
    const double hem = 0.03 * sin_turns(0.5 * cloth.waves * u) * v;
    return cloth.middle + Point{u * cloth.width * waist, hem - cloth.drop * v,
                                cloth.depth * (0.35 + 0.65 * v) * (fold + small)};
  });
}

}  // namespace

void draw_tiles(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const double length = 2.0 * plan.half_length() + 1.8;
  const double width = 2.0 * plan.wall;
  sketch.use(hall.material.grout);
  sketch.box(upright({0.0, 0.0, 0.0}), {-0.5 * length - 0.5, -0.5, -0.5 * width - 0.5},
             {0.5 * length + 0.5, -0.012, 0.5 * width + 0.5});
  const double tiles = share_of(sketch, goal, 1) / 10.0;
  const unsigned rows = at_least(4, std::sqrt(tiles * width / length));
  const unsigned columns = at_least(4, tiles / rows);
  const double half_x = 0.5 * length / columns;
  const double half_z = 0.5 * width / rows;
  for (unsigned j = 0; j < rows; ++j) {
    for (unsigned i = 0; i < columns; ++i) {
      const Point middle{half_x * (2.0 * i + 1.0) - 0.5 * length, -0.014,
                         half_z * (2.0 * j + 1.0) - 0.5 * width};
      const bool path = std::abs(middle.z) < 1.0 || std::abs(std::abs(middle.z) - plan.arcade) < 0.7;
      sketch.use(path != ((i + j) % 2 == 0) ? hall.material.tile_light : hall.material.tile_dark);
      draw_tile(sketch, middle, half_x, half_z, 0.014 + 0.002 * hall.random.unit());
    }
  }
}

void draw_balustrades(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const double half = plan.half_length() - 0.15;
  const double rail = plan.gallery + 0.92;
  const double z = plan.arcade - 0.5 * plan.thickness - 0.08;
  const auto total =
      static_cast<unsigned>(std::clamp(share_of(sketch, goal, 2) / 90.0, 2.0 * plan.bays, 16.0 * plan.bays));
  for (const double side : {-1.0, 1.0}) {
    sketch.use(hall.material.trim);
    sketch.box(upright({0.0, rail, side * z}), {-half, 0.0, -0.1}, {half, 0.09, 0.1});
    sketch.box(upright({0.0, plan.gallery, side * z}), {-half, 0.0, -0.09}, {half, 0.06, 0.09});
    for (unsigned i = 0; i < total; ++i) {
      const double left = share_of(sketch, goal, side < 0.0 ? 2 * total - i : total - i);
      const Frame foot = upright({half * (2.0 * (i + 0.5) / total - 1.0), plan.gallery + 0.05, side * z});
      sketch.use(hall.material.stone);
      turn(sketch, foot,
           {{0.075, 0.0}, {0.05, 0.1}, {0.085, 0.32}, {0.035, 0.66}, {0.06, 0.76}, {0.06, 0.87}}, left);
    }
  }
}

void draw_fountain(Atrium& hall, std::uint64_t goal) {
  MeshSketch& sketch = hall.sketch;
  const double budget = share_of(sketch, goal, 1);
  const Frame foot = upright({0.0, 0.0, 0.0});
  sketch.use(hall.material.trim);
  turn(sketch, foot,
       {{1.75, 0.0},
        {1.75, 0.12},
        {1.55, 0.2},
        {1.6, 0.55},
        {1.7, 0.62},
        {1.45, 0.66},
        {1.4, 0.3},
        {0.0, 0.28}},
       0.35 * budget);
  turn(sketch, foot,
       {{0.42, 0.3},
        {0.3, 0.45},
        {0.2, 0.7},
        {0.28, 1.0},
        {0.16, 1.3},
        {0.9, 1.62},
        {0.95, 1.7},
        {0.8, 1.68},
        {0.12, 1.48}},
       0.35 * budget);
  turn(sketch, foot,
       {{0.1, 1.5}, {0.12, 1.9}, {0.4, 2.08}, {0.42, 2.13}, {0.1, 2.05}, {0.09, 2.25}, {0.0, 2.4}},
       0.2 * budget);
  sketch.use(hall.material.water);
  const unsigned rings = at_least(2, std::sqrt(0.012 * budget));
  Profile ripples;
  for (unsigned j = 0; j <= rings; ++j) {
    const double r = 1.42 * (1.0 - static_cast<double>(j) / rings);
    ripples.push_back({r, 0.52 + 0.01 * sin_turns(3.0 * r)});
  }
  sketch.lathe(foot, ripples, at_least(8, 0.1 * budget / (2.0 * rings)));
}

// One pot before every other column, each with a spray of long leaves.
void draw_pots(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const unsigned pots = 2 * (plan.bays / 2);
  for (unsigned i = 0; i < pots; ++i) {
    const double each = share_of(sketch, goal, pots - i);
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    const double x = plan.bay * (static_cast<double>(i / 2) * 2.0 + 1.0) - plan.half_length();
    const Frame foot = upright({x, 0.0, side * (plan.arcade - 1.05)});
    sketch.use(hall.material.clay);
    turn(sketch, foot,
         {{0.22, 0.0},
          {0.3, 0.2},
          {0.36, 0.45},
          {0.28, 0.6},
          {0.33, 0.68},
          {0.27, 0.68},
          {0.24, 0.58},
          {0.0, 0.56}},
         0.4 * each);
    const unsigned pieces = std::clamp(at_least(2, std::sqrt(each) / 16.0), 2U, 12U);
    const unsigned blades = at_least(5, 0.6 * each / (2.0 * pieces - 1.0));
    sketch.use(hall.material.leaf);
    for (unsigned k = 0; k < blades; ++k) {
      const double away = hall.random.between(0.0, 0.14);
      const Frame root = upright(foot.at(0.0, 0.56, 0.0), hall.random.unit()).moved(0.0, 0.0, away);
      const double length = hall.random.between(0.5, 1.15);
      draw_blade(sketch, root, length, hall.random.between(0.03, 0.075), pieces);
    }
  }
}

// Wheels of candles on long chains down the middle and a bowl in each aisle; their point lights are the
// caller's.
void draw_lanterns(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  constexpr unsigned kLanterns = 3;
  for (const double side : {-1.0, 1.0}) {
    const Point bowl = aisle_lamp_at(plan, side);
    sketch.use(hall.material.bronze);
    turn(sketch, upright(bowl), {{0.0, 0.0}, {0.2, 0.06}, {0.3, 0.2}, {0.28, 0.22}, {0.0, 0.04}},
         0.08 * share_of(sketch, goal, 1));
    sketch.use(hall.material.iron);
    sketch.bar(bowl + Point{0.0, 0.03, 0.0}, {bowl.x, plan.gallery - 0.34, bowl.z}, 0.012, 4);
  }
  for (unsigned i = 0; i < kLanterns; ++i) {
    const double each = share_of(sketch, goal, kLanterns - i);
    const Point hub{0.55 * plan.half_length() * (static_cast<double>(i) - 1.0) + (i == 1 ? 0.0 : 0.4), 7.6,
                    0.0};
    const unsigned sides = std::clamp(at_least(4, std::sqrt(each) / 12.0), 4U, 24U);
    const unsigned around = at_least(10, 0.45 * each / (2.0 * sides));
    sketch.use(hall.material.iron);
    draw_ring(sketch, hub, 0.8, 0.04, around, sides);
    sketch.bar(hub + Point{0.0, 1.6, 0.0}, {hub.x, plan.eaves + 0.1, hub.z}, 0.02, 5);
    constexpr unsigned kCandles = 8;
    for (unsigned k = 0; k < kCandles; ++k) {
      const Point rim = hub + Point{0.8 * cos_turns(k / 8.0), 0.0, 0.8 * sin_turns(k / 8.0)};
      sketch.use(hall.material.iron);
      if (k % 2 == 0) sketch.bar(rim, hub + Point{0.0, 1.62, 0.0}, 0.012, 4);
      sketch.use(hall.material.bronze);
      turn(sketch, upright(rim), {{0.0, -0.08}, {0.07, 0.02}, {0.03, 0.04}, {0.03, 0.2}, {0.0, 0.24}},
           0.06 * each);
    }
  }
}

// Long ones between the upper columns, gathered ones in every second lower arch.
void draw_curtains(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  const unsigned total = 2 * plan.bays;
  for (unsigned i = 0; i < total; ++i) {
    const double each = share_of(hall.sketch, goal, total - i);
    const double side = i % 2 == 0 ? -1.0 : 1.0;
    const unsigned bay = i / 2;
    const double x = plan.bay * (bay + 0.5) - plan.half_length();
    const bool low = (bay + i % 2) % 2 == 0;
    const double z = side * (low ? plan.arcade : plan.arcade + 0.62);
    const double rod = low ? plan.spring - 0.05 : plan.upper_spring + 0.6;
    hall.sketch.use(hall.material.iron);
    hall.sketch.bar({x - (low ? 1.7 : 1.95), rod, z}, {x + (low ? 1.7 : 1.95), rod, z}, 0.03, 6);
    hall.sketch.use(hall.material.cloth[(bay + 2 * (i % 2)) % 4]);
    Curtain cloth{{x, rod, z}, low ? 2.7 : 3.5,    low ? 3.9 : 2.9, low ? 0.11 : 0.16,
                  7.0,         hall.random.unit(), low ? 0.35 : 0.0};
    draw_curtain(hall, cloth, each - 12.0);
  }
}

}  // namespace gnomon
