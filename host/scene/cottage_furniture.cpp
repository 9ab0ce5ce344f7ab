// Turned, carved and stacked things of the cottage: what is small.
#include <algorithm>
#include <cmath>
#include <vector>

#include "gnomon/scene/cottage_parts.h"

namespace gnomon {
namespace {

using Profile = std::vector<glm::dvec2>;

// A turned leg or spindle: `sides` around, beads between its ends.
void draw_spindle(MeshSketch& sketch, const Frame& foot, double height, double radius, unsigned sides) {
  const unsigned rings = std::clamp(sides, 4U, 40U);
  Profile profile{{0.0, 0.0}};
  for (unsigned j = 0; j <= rings; ++j) {
    const double t = static_cast<double>(j) / rings;
    profile.push_back({radius * (0.75 + 0.25 * cos_turns(3.0 * t)), height * t});
  }
  profile.push_back({0.0, height});
  sketch.lathe(foot, profile, sides);
}

void draw_chair(Cottage& cottage, const Frame& foot, unsigned sides) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.oak);
  for (const double x : {-0.18, 0.18}) {
    for (const double z : {-0.18, 0.18}) draw_spindle(sketch, foot.moved(x, 0.0, z), 0.44, 0.03, sides);
    draw_spindle(sketch, foot.moved(x, 0.47, -0.18), 0.5, 0.025, sides);
  }
  sketch.box(foot, {-0.22, 0.44, -0.22}, {0.22, 0.475, 0.22});
  sketch.box(foot, {-0.21, 0.85, -0.2}, {0.21, 0.95, -0.16});
  sketch.box(foot, {-0.2, 0.62, -0.195}, {0.2, 0.68, -0.165});
}

void draw_table(Cottage& cottage, const Frame& foot, unsigned sides) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.oak);
  for (const double x : {-0.8, 0.8}) {
    for (const double z : {-0.4, 0.4}) draw_spindle(sketch, foot.moved(x, 0.0, z), 0.72, 0.055, sides);
  }
  sketch.box(foot, {-0.95, 0.72, -0.52}, {0.95, 0.77, 0.52});
  sketch.use(cottage.material.pottery);
  const Profile bowl{{0.0, 0.0},   {0.08, 0.0},  {0.17, 0.07}, {0.2, 0.13},
                     {0.18, 0.13}, {0.15, 0.08}, {0.0, 0.03}};
  sketch.lathe(foot.moved(0.0, 0.77, 0.0), bowl, 2 * sides);
  for (unsigned k = 0; k < 5; ++k) {
    sketch.use(cottage.material.flowers[k % 4].petal);
    const Point place{0.08 * cos_turns(0.2 * k), 0.88, 0.08 * sin_turns(0.2 * k)};
    sketch.ellipsoid(foot.moved(place.x, place.y, place.z), Point{0.05}, sides, std::max(3U, sides / 2));
  }
}

// Shelves against the back wall, filled with leaning books.
void draw_shelves(Cottage& cottage, const Frame& foot, unsigned books_per_board) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.oak);
  for (const double x : {-0.8, 0.77}) sketch.box(foot.moved(x, 0.0, 0.0), {0.0, 0.0, 0.0}, {0.03, 2.0, 0.3});
  for (unsigned board = 0; board < 5; ++board) {
    const double y = 0.08 + 0.45 * board;
    sketch.use(cottage.material.oak);
    sketch.box(foot, {-0.77, y, 0.0}, {0.77, y + 0.03, 0.3});
    const double width = 1.5 / books_per_board;
    for (unsigned k = 0; k < books_per_board && board < 4; ++k) {
      const double height = cottage.random.between(0.24, 0.37);
      const double depth = cottage.random.between(0.16, 0.25);
      sketch.use(cottage.material.books[cottage.random.below(4)]);
      sketch.box(foot.moved(-0.75 + width * k, y + 0.03, 0.02), {0.02 * width, 0.0, 0.0},
                 {0.92 * width, height, depth});
    }
  }
}

void draw_bed(Cottage& cottage, const Frame& foot, unsigned sides, double triangles) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.oak);
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-1.0, 1.0}) draw_spindle(sketch, foot.moved(x, 0.0, z), 0.8, 0.04, sides);
  }
  sketch.box(foot, {-0.5, 0.3, -1.0}, {0.5, 0.38, 1.0});
  sketch.use(cottage.material.cloth);
  const unsigned cells = at_least(6, std::sqrt(0.5 * triangles));
  sketch.sheet(cells, cells, [&](unsigned i, unsigned j) {
    const double u = 2.0 * i / cells - 1.0;
    const double v = 2.0 * j / cells - 1.0;
    const double side = std::max(0.0, std::abs(u) - 0.85);
    const double crease = 0.012 * sin_turns(2.3 * u + 1.1 * v) * cos_turns(1.7 * v);
    return foot.at(0.55 * u, 0.56 - 1.4 * side * (1.0 + crease) + crease, -0.95 * v);
  });
}

// A shade of cloth over the table; the point light under it is the caller's.
void draw_lamp(Cottage& cottage, unsigned sides) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.timber);
  sketch.bar({-1.2, 2.05, 0.0}, {-1.2, cottage.ridge - 0.1, 0.0}, 0.01, 4);
  sketch.use(cottage.material.shade);
  const Profile shade{{0.3, 1.8}, {0.22, 1.95}, {0.05, 2.05}};
  sketch.lathe(upright({-1.2, 0.0, 0.0}), shade, 3 * sides);
}

void draw_picket(MeshSketch& sketch, const Frame& foot, double height) {
  sketch.box(foot, {-0.045, 0.05, -0.015}, {0.045, height, 0.015});
  const Point tip = foot.at(0.0, height + 0.08, 0.0);
  const std::array<Point, 4> rim{foot.at(-0.045, height, 0.015), foot.at(0.045, height, 0.015),
                                 foot.at(0.045, height, -0.015), foot.at(-0.045, height, -0.015)};
  for (unsigned k = 0; k < 4; ++k) sketch.triangle(rim[k], rim[(k + 1) % 4], tip);
}

}  // namespace

void draw_furniture(Cottage& cottage, std::uint64_t goal) {
  const double budget = share_of(cottage.sketch, goal, 1);
  // 36 spindles and as many rings as sides on each take about 72 sides^2 triangles; they get half of the
  // budget.
  const unsigned sides = at_least(4, std::sqrt(0.5 * budget / 72.0));
  const double inside = 0.04;
  draw_table(cottage, upright({-1.2, inside, 0.0}), sides);
  draw_chair(cottage, upright({-1.7, inside, 0.75}, 0.52), sides);
  draw_chair(cottage, upright({-0.6, inside, 0.8}, 0.47), sides);
  draw_chair(cottage, upright({-1.7, inside, -0.75}, 0.02), sides);
  draw_chair(cottage, upright({-0.6, inside, -0.72}, 0.98), sides);
  draw_lamp(cottage, sides);
  draw_bed(cottage, upright({3.3, inside, 1.5}), sides, 0.15 * budget);
  const auto left = static_cast<double>(goal > cottage.sketch.count() ? goal - cottage.sketch.count() : 0);
  draw_shelves(cottage, upright({0.0, inside, -cottage.half_z + cottage.thick + 0.02}),
               std::clamp(at_least(4, left / 48.0), 4U, 60U));
}

// Pickets on two rails around the garden; the gate is a gap towards +z.
void draw_fence(Cottage& cottage, std::uint64_t goal) {
  MeshSketch& sketch = cottage.sketch;
  const double x = 10.5;
  const double z = 11.5;
  const double pitch = std::clamp(16.0 * 88.0 / share_of(sketch, goal, 1), 0.14, 1.2);
  const std::array<std::array<Point, 2>, 5> runs{{{Point{-x, 0.0, z}, Point{-1.3, 0.0, z}},
                                                  {Point{1.0, 0.0, z}, Point{x, 0.0, z}},
                                                  {Point{x, 0.0, z}, Point{x, 0.0, -z}},
                                                  {Point{x, 0.0, -z}, Point{-x, 0.0, -z}},
                                                  {Point{-x, 0.0, -z}, Point{-x, 0.0, z}}}};
  sketch.use(cottage.material.paint);
  for (const auto& run : runs) {
    const Point along = glm::normalize(run[1] - run[0]);
    const double length = glm::length(run[1] - run[0]);
    const Frame frame{run[0], along, {0.0, 1.0, 0.0}, glm::cross(along, Point{0.0, 1.0, 0.0})};
    for (const double y : {0.35, 0.85}) sketch.box(frame, {0.0, y, -0.06}, {length, y + 0.07, -0.02});
    const unsigned pickets = at_least(2, length / pitch);
    for (unsigned i = 0; i < pickets; ++i) {
      draw_picket(sketch, frame.moved(length * (i + 0.5) / pickets, 0.0, 0.0),
                  cottage.random.between(0.98, 1.06));
    }
  }
}

}  // namespace gnomon
