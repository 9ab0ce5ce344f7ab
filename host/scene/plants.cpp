#include "gnomon/scene/plants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gnomon {
namespace {

// One piece of wood before it gets a surface. Leaves sit on the bearing ones.
struct Branch {
  std::vector<Point> path;
  std::vector<double> radii;
  bool bearing;
};

struct Growth {
  SteadyRandom& random;
  unsigned levels;  // of branching after the trunk
  std::vector<Branch> branches{};
};

Point any_direction(SteadyRandom& random) {
  const double height = random.between(-1.0, 1.0);
  const double radius = std::sqrt(1.0 - height * height);
  const double turns = random.unit();
  return {radius * cos_turns(turns), height, radius * sin_turns(turns)};
}

// A path that wanders and bends by `lift` upwards (or droops) in every piece.
Branch wander(SteadyRandom& random, const Point& from, Point direction, double length, double radius,
              unsigned pieces, double lift) {
  Branch branch{{from}, {radius}, false};
  for (unsigned i = 1; i <= pieces; ++i) {
    direction = glm::normalize(direction + 0.18 * any_direction(random) + Point{0.0, lift, 0.0});
    branch.path.push_back(branch.path.back() + length / pieces * direction);
    branch.radii.push_back(radius * (1.0 - 0.75 * i / pieces));
  }
  return branch;
}

Point point_along(const Branch& branch, double t) {
  const double place = t * static_cast<double>(branch.path.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), branch.path.size() - 2);
  return branch.path[i] + (place - static_cast<double>(i)) * (branch.path[i + 1] - branch.path[i]);
}

// Side branches leave at about 50 degrees, each a good half as long as what bears it.
void grow_crown(Growth& growth, const Point& from, const Point& direction, double length, double radius,
                unsigned level) {
  const unsigned pieces = level == 0 ? 4 : 2;
  Branch branch = wander(growth.random, from, direction, length, radius, pieces, level == 0 ? 0.05 : 0.1);
  branch.bearing = level >= growth.levels;
  growth.branches.push_back(branch);
  if (level >= growth.levels) return;
  const unsigned children = level == 0 ? 6 : 4;
  for (unsigned k = 0; k < children; ++k) {
    const double t = (level == 0 ? 0.42 : 0.35) + 0.58 * (k + growth.random.unit() * 0.6) / children;
    const Point side = any_direction(growth.random);
    const Point away = glm::normalize(direction * 0.55 + Point{side.x, 0.6 * std::abs(side.y), side.z});
    grow_crown(growth, point_along(branch, std::min(t, 1.0)), away, length * growth.random.between(0.42, 0.6),
               radius * 0.42, level + 1);
  }
}

void grow_fir(Growth& growth, const Point& foot, double height, unsigned whorls) {
  growth.branches.push_back({{foot, foot + Point{0.0, 0.5 * height, 0.0}, foot + Point{0.0, height, 0.0}},
                             {0.022 * height, 0.013 * height, 0.003 * height},
                             false});
  for (unsigned i = 0; i < whorls; ++i) {
    const double t = (i + growth.random.unit()) / whorls;
    const double y = height * (0.24 + 0.74 * t);
    const double reach = height * (0.25 * (1.0 - t) + 0.03);
    const double turns = growth.random.unit();
    const Point out{cos_turns(turns), 0.1, sin_turns(turns)};
    growth.branches.push_back(
        wander(growth.random, foot + Point{0.0, y, 0.0}, out, reach, 0.0045 * height * (1.3 - t), 2, -0.16));
    growth.branches.back().bearing = true;
  }
}

// A card folded along its rib, turned at random but rather facing the sky.
void draw_leaf(MeshSketch& sketch, SteadyRandom& random, const Point& stalk, double size, bool hangs) {
  Point along = any_direction(random);
  if (hangs) along.y = -0.35 * std::abs(along.y);
  along = glm::normalize(along);
  const Point lean = any_direction(random) + Point{0.0, 1.2, 0.0};
  const Point across = glm::normalize(glm::cross(lean, along)) * (hangs ? 0.22 : 0.42) * size;
  const Point middle = stalk + 0.5 * size * along;
  const Point tip = stalk + size * along;
  sketch.triangle(stalk, middle + across, tip);
  sketch.triangle(stalk, tip, middle - across + Point{0.0, 0.08 * size, 0.0});
}

void draw_leaves(MeshSketch& sketch, Growth& growth, double height, bool fir, std::uint64_t goal) {
  std::vector<const Branch*> bearing;
  for (const Branch& branch : growth.branches) {
    if (branch.bearing) bearing.push_back(&branch);
  }
  const auto leaves = static_cast<unsigned>(share_of(sketch, goal, 2));
  if (leaves == 0) return;
  // The crown keeps its total leaf area, whatever the number of cards it is cut into.
  const double size =
      height * std::clamp((fir ? 1.7 : 2.2) / std::sqrt(static_cast<double>(leaves)), 0.006, 0.11);
  for (unsigned i = 0; i < leaves; ++i) {
    const Branch& branch = *bearing[i % bearing.size()];
    const double t = fir ? growth.random.between(0.08, 1.0) : growth.random.between(0.25, 1.0);
    const Point off = (fir ? 0.3 * size : 0.02 * height) * any_direction(growth.random);
    draw_leaf(sketch, growth.random, point_along(branch, t) + off, size * growth.random.between(0.7, 1.25),
              fir);
  }
}

}  // namespace

void draw_tree(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height,
               const TreeKind& kind, double triangles) {
  const std::uint64_t goal = sketch.count() + static_cast<std::uint64_t>(triangles);
  const double wood = 0.35 * triangles;
  Growth growth{random, 1};
  if (kind.fir) {
    grow_fir(growth, foot, height, std::clamp(at_least(6, wood / 30.0), 6U, 400U));
  } else {
    for (double size = 6.0 * 20.0 * 5.0; size < wood && growth.levels < 5; size *= 4.0) ++growth.levels;
    grow_crown(growth, foot, {0.0, 1.0, 0.0}, 0.62 * height, 0.027 * height, 0);
  }
  double pieces = 0.0;
  for (const Branch& branch : growth.branches) pieces += static_cast<double>(branch.path.size() - 1);
  const unsigned sides = std::clamp(at_least(3, wood / (2.0 * pieces) - 0.5), 3U, 32U);
  sketch.use(kind.bark);
  for (const Branch& branch : growth.branches) sketch.tube(branch.path, branch.radii, sides);
  sketch.use(kind.leaf);
  draw_leaves(sketch, growth, height, kind.fir, goal);
}

void draw_flower(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height,
                 const FlowerKind& kind) {
  const Point lean{random.between(-0.2, 0.2), 1.0, random.between(-0.2, 0.2)};
  const Frame head = aimed(foot + height * lean, foot + 1.1 * height * lean + Point{0.02, 0.0, 0.03});
  sketch.use(kind.stem);
  sketch.bar(foot, head.origin, 0.006, 3);
  sketch.use(kind.petal);
  const double size = 0.16 * height + 0.015;
  for (unsigned k = 0; k < 8; ++k) {
    const double turns = k / 8.0;
    const Point out = cos_turns(turns) * head.x + sin_turns(turns) * head.z;
    const Point across = 0.32 * size * (cos_turns(turns + 0.25) * head.x + sin_turns(turns + 0.25) * head.z);
    const Point middle = head.origin + 0.6 * size * out + 0.15 * size * head.y;
    const Point tip = head.origin + size * out;
    sketch.triangle(head.origin, middle + across, tip);
    sketch.triangle(head.origin, tip, middle - across);
  }
  sketch.use(kind.eye);
  sketch.ellipsoid(head, Point{0.2 * size}, 4, 2);
}

void draw_grass_blade(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height) {
  const double turns = random.unit();
  const Point out{cos_turns(turns), 0.0, sin_turns(turns)};
  const Point across = 0.035 * height * Point{-out.z, 0.0, out.x} + Point{0.0, 0.001, 0.0};
  const Point middle = foot + Point{0.0, 0.6 * height, 0.0} + 0.12 * height * out;
  const Point tip = foot + Point{0.0, height, 0.0} + random.between(0.25, 0.6) * height * out;
  sketch.quad(foot - across, foot + across, middle + 0.7 * across, middle - 0.7 * across);
  sketch.triangle(middle - 0.7 * across, middle + 0.7 * across, tip);
}

}  // namespace gnomon
