// Walls, roof, windows and yard of the cottage: what is large.
#include <algorithm>
#include <vector>

#include "gnomon/scene/cottage_parts.h"

namespace gnomon {
namespace {

struct Opening {
  double left, right, sill, head;
};

// A wall along the frame's x from 0, z outwards; openings from left to right.
void draw_wall(Cottage& cottage, const Frame& frame, double length, const std::vector<Opening>& openings) {
  MeshSketch& sketch = cottage.sketch;
  const double thick = cottage.thick;
  double from = 0.0;
  const auto piece = [&](double x0, double x1, double y0, double y1) {
    if (x1 > x0 && y1 > y0) sketch.box(frame, {x0, y0, -thick}, {x1, y1, 0.0});
  };
  sketch.use(cottage.material.plaster);
  for (const Opening& opening : openings) {
    piece(from, opening.left, 0.0, cottage.eaves);
    piece(opening.left, opening.right, 0.0, opening.sill);
    piece(opening.left, opening.right, opening.head, cottage.eaves);
    from = opening.right;
  }
  piece(from, length, 0.0, cottage.eaves);
}

// Frame, cross bars, sill and two shutters; no pane, so that light comes in.
void draw_window(Cottage& cottage, const Frame& frame, const Opening& o) {
  MeshSketch& sketch = cottage.sketch;
  const double middle = 0.5 * (o.left + o.right);
  const double half_height = 0.5 * (o.sill + o.head);
  sketch.use(cottage.material.timber);
  sketch.box(frame, {o.left - 0.06, o.sill - 0.1, -0.02}, {o.right + 0.06, o.sill - 0.02, 0.14});
  sketch.box(frame, {o.left, o.head - 0.06, -0.16}, {o.right, o.head, -0.1});
  sketch.box(frame, {o.left, o.sill, -0.16}, {o.right, o.sill + 0.06, -0.1});
  sketch.box(frame, {o.left, o.sill, -0.16}, {o.left + 0.06, o.head, -0.1});
  sketch.box(frame, {o.right - 0.06, o.sill, -0.16}, {o.right, o.head, -0.1});
  sketch.box(frame, {middle - 0.025, o.sill, -0.155}, {middle + 0.025, o.head, -0.105});
  sketch.box(frame, {o.left, half_height - 0.025, -0.15}, {o.right, half_height + 0.025, -0.11});
  sketch.use(cottage.material.paint);
  const double leaf = 0.5 * (o.right - o.left);
  sketch.box(frame, {o.left - 0.08 - leaf, o.sill, 0.0}, {o.left - 0.08, o.head, 0.05});
  sketch.box(frame, {o.right + 0.08, o.sill, 0.0}, {o.right + 0.08 + leaf, o.head, 0.05});
}

// Door leaf half open, step, and a small roof on two brackets with a glowing plate beneath.
void draw_door(Cottage& cottage, const Frame& frame, const Opening& o) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.paint);
  Frame leaf = upright(frame.at(o.left + 0.02, 0.0, -0.2), 0.19);
  sketch.box(leaf, {0.0, 0.06, -0.03}, {o.right - o.left - 0.04, o.head - 0.02, 0.03});
  sketch.use(cottage.material.stone);
  sketch.box(frame, {o.left - 0.3, -0.02, 0.0}, {o.right + 0.3, 0.05, 0.7});
  sketch.use(cottage.material.timber);
  sketch.box(frame, {o.left - 0.35, o.head + 0.25, -0.05}, {o.right + 0.35, o.head + 0.33, 0.9});
  sketch.bar(frame.at(o.left - 0.3, o.head - 0.4, 0.0), frame.at(o.left - 0.3, o.head + 0.26, 0.8), 0.035, 5);
  sketch.bar(frame.at(o.right + 0.3, o.head - 0.4, 0.0), frame.at(o.right + 0.3, o.head + 0.26, 0.8), 0.035,
             5);
  sketch.use(sketch.material("porch light", {0.2F, 0.2F, 0.2F}, 1.0F, {18.0F, 12.0F, 6.0F}));
  const double y = o.head + 0.24;
  sketch.quad(frame.at(o.left + 0.3, y, 0.3), frame.at(o.right - 0.3, y, 0.3),
              frame.at(o.right - 0.3, y, 0.55), frame.at(o.left + 0.3, y, 0.55));
}

// Two slabs that lean against each other and the gables under them.
void draw_roof(Cottage& cottage) {
  MeshSketch& sketch = cottage.sketch;
  const double rise = cottage.ridge - cottage.eaves;
  const double over = 0.6;  // past the gables
  for (const double side : {-1.0, 1.0}) {
    const Point slope = glm::normalize(Point{0.0, -rise, cottage.half_z});
    const Frame frame{{0.0, cottage.ridge, 0.0}, {1.0, 0.0, 0.0}, {0.0, -slope.y, 0.0}, slope};
    Frame slab{frame.origin, frame.x, glm::cross(slope, frame.x), slope};
    if (side < 0.0)
      slab = {slab.origin, -slab.x, {slab.y.x, slab.y.y, -slab.y.z}, {slope.x, slope.y, -slope.z}};
    const double length = glm::length(Point{0.0, rise, cottage.half_z}) + 0.7;
    sketch.use(cottage.material.roof);
    sketch.box(slab, {-cottage.half_x - over, 0.0, -0.02}, {cottage.half_x + over, 0.16, length});
    sketch.use(cottage.material.plaster);
    const double x = side * cottage.half_x;
    const double in = x - side * cottage.thick;
    const auto corner = [&](double at, int k) {
      return k == 0 ? Point{at, cottage.eaves, -cottage.half_z}
                    : (k == 1 ? Point{at, cottage.eaves, cottage.half_z} : Point{at, cottage.ridge, 0.0});
    };
    const int first = side > 0.0 ? 1 : 0;
    sketch.triangle(corner(x, first), corner(x, 1 - first), corner(x, 2));
    sketch.triangle(corner(in, 1 - first), corner(in, first), corner(in, 2));
  }
  sketch.use(cottage.material.brick);
  sketch.box(upright({2.2, 0.0, -1.1}), {-0.35, cottage.eaves, -0.35}, {0.35, cottage.ridge + 0.7, 0.35});
  sketch.box(upright({2.2, 0.0, -1.1}), {-0.42, cottage.ridge + 0.7, -0.42},
             {0.42, cottage.ridge + 0.85, 0.42});
}

}  // namespace

void draw_house(Cottage& cottage) {
  const double x = cottage.half_x;
  const double z = cottage.half_z;
  const Opening door{3.7, 4.8, 0.0, 2.1};
  const std::vector<Opening> front{{1.2, 2.5, 0.95, 2.05}, door, {6.2, 7.5, 0.95, 2.05}};
  const std::vector<Opening> back{{1.6, 2.9, 0.95, 2.05}, {5.6, 7.2, 0.95, 2.05}};
  const std::vector<Opening> gable{{2.2, 3.6, 0.95, 2.05}};
  const std::array<Frame, 4> frames{upright({-x, 0.0, z}), upright({x, 0.0, z - cottage.thick}, 0.25),
                                    upright({x, 0.0, -z}, 0.5), upright({-x, 0.0, -z + cottage.thick}, 0.75)};
  const std::array<double, 4> lengths{2.0 * x, 2.0 * (z - cottage.thick), 2.0 * x, 2.0 * (z - cottage.thick)};
  const std::array<std::vector<Opening>, 4> openings{front, gable, back, gable};
  for (unsigned side = 0; side < 4; ++side) {
    draw_wall(cottage, frames[side], lengths[side], openings[side]);
    for (const Opening& opening : openings[side]) {
      if (opening.sill > 0.0) draw_window(cottage, frames[side], opening);
    }
  }
  draw_door(cottage, frames[0], door);
  draw_roof(cottage);
  cottage.sketch.use(cottage.material.floor);
  cottage.sketch.box(upright({0.0, 0.0, 0.0}), {-x + 0.05, -0.2, -z + 0.05}, {x - 0.05, 0.04, z - 0.05});
  cottage.sketch.use(cottage.material.timber);
  for (int k = -1; k <= 1; ++k) {
    cottage.sketch.box(upright({2.9 * k, cottage.eaves, 0.0}), {-0.1, -0.22, -z + 0.1},
                       {0.1, -0.02, z - 0.1});
  }
}

void draw_ground(Cottage& cottage) {
  MeshSketch& sketch = cottage.sketch;
  sketch.use(cottage.material.lawn);
  sketch.box(upright({0.0, 0.0, 0.0}), {-40.0, -1.0, -40.0}, {40.0, 0.0, 40.0});
  sketch.use(cottage.material.path);
  for (unsigned i = 0; i < 9; ++i) {  // stepping stones from the door to the gate
    const double z = cottage.half_z + 1.2 + 0.85 * i;
    const double x = -0.15 + 0.12 * cottage.random.between(-1.0, 1.0);
    sketch.box(upright({x, 0.0, z}, cottage.random.between(-0.03, 0.03)), {-0.5, -0.1, -0.33},
               {0.5, 0.025, 0.33});
  }
}

// Four thick walls with coping stones; the gate is a gap towards +z.
void draw_yard_walls(Cottage& cottage) {
  MeshSketch& sketch = cottage.sketch;
  const double x = 10.5;
  const double z = 11.5;
  const auto wall = [&](double x0, double x1, double z0, double z1) {
    const Frame frame;
    sketch.use(cottage.material.brick);
    sketch.box(frame, {x0, -0.3, z0}, {x1, 2.3, z1});
    sketch.use(cottage.material.stone);
    sketch.box(frame, {x0 - 0.08, 2.3, z0 - 0.08}, {x1 + 0.08, 2.45, z1 + 0.08});
  };
  wall(-x, -x + 0.5, -z, z);
  wall(x - 0.5, x, -z, z);
  wall(-x + 0.5, x - 0.5, -z, -z + 0.5);
  wall(-x + 0.5, -1.4, z - 0.5, z);
  wall(1.1, x - 0.5, z - 0.5, z);
  for (const double side : {-1.75, 1.45}) {
    sketch.use(cottage.material.stone);
    sketch.box(upright({side, 0.0, z - 0.25}), {-0.36, -0.3, -0.36}, {0.36, 2.9, 0.36});
    sketch.ellipsoid(upright({side, 3.1, z - 0.25}), Point{0.28}, 10, 6);
  }
}

}  // namespace gnomon
