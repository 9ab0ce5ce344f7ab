// What carries the atrium: columns, arches, walls, roof.
#include <algorithm>
#include <cmath>
#include <vector>

#include "gnomon/scene/atrium_parts.h"

namespace gnomon {
namespace {

using Profile = std::vector<glm::dvec2>;

// A classical column of unit radius: moulded base, shaft that narrows with a slight belly, moulded capital.
// `steps` rings on the shaft; below three rings only the outline is kept.
Profile column_profile(double height, double radius, unsigned steps) {
  Profile profile;
  const auto ring = [&](double r, double y) { profile.push_back({r * radius, y}); };
  const bool fine = steps >= 3;
  const double foot = 0.9 * radius;
  const double head = height - 1.3 * radius;
  ring(1.32, 0.0);
  if (fine) ring(1.38, 0.12 * foot);
  ring(1.36, 0.3 * foot);
  if (fine) ring(1.18, 0.42 * foot);
  if (fine) ring(1.16, 0.6 * foot);
  ring(1.22, 0.75 * foot);
  for (unsigned i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    ring(1.0 - 0.16 * t * t + 0.03 * t * (1.0 - t), foot + t * (head - foot));
  }
  if (fine) ring(0.94, head + 0.05 * radius);
  ring(0.94, head + 0.16 * radius);
  if (fine) ring(0.86, head + 0.22 * radius);
  if (fine) ring(0.9, head + 0.6 * radius);
  ring(1.12, head + 0.95 * radius);
  ring(1.3, height);
  return profile;
}

// Turns the profile; with sides to spare the shaft gets flutes.
void turn_column(MeshSketch& sketch, const Frame& frame, const Profile& profile, double radius,
                 unsigned sides) {
  constexpr unsigned kFlutes = 18;
  if (sides < 4 * kFlutes) return sketch.lathe(frame, profile, sides);
  sides -= sides % kFlutes;
  sketch.sheet(
      sides, static_cast<unsigned>(profile.size() - 1),
      [&](unsigned i, unsigned j) {
        const double turns = static_cast<double>(i) / sides;
        const double groove = sin_turns(0.5 * kFlutes * turns);  // its square dips kFlutes times around
        const bool shaft = profile[j].x < 1.05 * radius && profile[j].y > radius;
        const double r = profile[j].x * (shaft ? 1.0 - 0.07 * groove * groove : 1.0);
        return frame.at(r * cos_turns(turns), profile[j].y, -r * sin_turns(turns));
      },
      Rim::kClosed);
}

struct ColumnRow {
  double y, height, radius, z, spacing;
  unsigned count;
};

void draw_column_row(Atrium& hall, const ColumnRow& row, double triangles) {
  MeshSketch& sketch = hall.sketch;
  const double each = triangles / row.count - 24.0;
  const unsigned steps = each < 600.0 ? 1 : std::min(at_least(3, std::sqrt(each) / 6.0 - 6.0), 60U);
  const double first = -0.5 * row.spacing * (row.count - 1);
  const double plinth = 0.35 * row.radius;
  const Profile profile = column_profile(row.height - 2.0 * plinth, row.radius, steps);
  const unsigned sides = at_least(6, each / (2.0 * static_cast<double>(profile.size() - 1)));
  const double wide = 1.42 * row.radius;
  for (unsigned i = 0; i < row.count; ++i) {
    const Frame foot = upright({first + row.spacing * i, row.y, row.z});
    sketch.use(hall.material.trim);
    sketch.box(foot, {-wide, 0.0, -wide}, {wide, plinth, wide});
    sketch.box(foot, {-wide, row.height - plinth, -wide}, {wide, row.height, wide});
    sketch.use(hall.material.stone);
    turn_column(sketch, foot.moved(0.0, plinth, 0.0), profile, row.radius, sides);
  }
}

struct Arch {
  double x, z;          // middle of the opening, axis of the wall
  double radius, half;  // of the opening; of the wall piece that holds it
  double spring, top;   // where the arch begins and the wall piece ends
};

// The wall piece over an opening: both faces from the arch up, the soffit under it, and a moulding on each
// face.
void draw_arch(Atrium& hall, const Arch& arch, unsigned steps) {
  MeshSketch& sketch = hall.sketch;
  const double deep = 0.5 * hall.plan.thickness;
  const auto inner = [&](unsigned i, double z) {
    const double turns = 0.5 * i / steps;
    return Point{arch.x - arch.radius * cos_turns(turns), arch.spring + arch.radius * sin_turns(turns),
                 arch.z + z};
  };
  const auto outer = [&](unsigned i, double z) {
    return Point{arch.x - arch.half * cos_turns(0.5 * i / steps), arch.top, arch.z + z};
  };
  sketch.use(hall.material.stone);
  sketch.sheet(steps, 1, [&](unsigned i, unsigned j) { return j == 0 ? inner(i, deep) : outer(i, deep); });
  sketch.sheet(steps, 1, [&](unsigned i, unsigned j) { return j == 0 ? outer(i, -deep) : inner(i, -deep); });
  sketch.sheet(steps, 2,
               [&](unsigned i, unsigned j) { return inner(i, deep * (static_cast<double>(j) - 1.0)); });
  for (const double side : {-1.0, 1.0}) {
    const Point low{arch.x + side * arch.half, arch.spring, arch.z};
    const Point near = inner(side < 0.0 ? 0 : steps, 0.0);
    const Point high{low.x, arch.top, arch.z};
    for (const double face : {-deep, deep}) {
      const Point shift{0.0, 0.0, face};
      const bool forward = side * face < 0.0;
      sketch.triangle(shift + (forward ? low : near), shift + (forward ? near : low), shift + high);
    }
  }
}

void draw_archivolt(Atrium& hall, const Arch& arch, unsigned steps, unsigned sides) {
  for (const double side : {-1.0, 1.0}) {
    std::vector<Point> path;
    for (unsigned i = 0; i <= steps; ++i) {
      const double turns = 0.5 * i / steps;
      const double r = arch.radius + 0.16;
      path.push_back({arch.x - r * cos_turns(turns), arch.spring + r * sin_turns(turns),
                      arch.z + side * 0.5 * hall.plan.thickness});
    }
    const std::vector<double> radii(path.size(), 0.08);
    hall.sketch.use(hall.material.trim);
    hall.sketch.tube(path, radii, sides);
  }
}

void draw_arch_row(Atrium& hall, Arch arch, unsigned count, double triangles) {
  const double each = triangles / count;
  const unsigned sides = std::clamp(at_least(4, std::sqrt(each) / 6.0), 4U, 24U);
  const unsigned steps = at_least(5, (each - 4.0) / (8.0 + 4.0 * sides));
  arch.x = -arch.half * (count - 1);
  for (unsigned i = 0; i < count; ++i, arch.x += 2.0 * arch.half) {
    draw_arch(hall, arch, steps);
    draw_archivolt(hall, arch, steps, sides);
  }
}

// Inside faces of the outer walls, with pilasters, a cornice and paintings along the aisles.
void draw_side_wall(Atrium& hall, double side) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const Frame frame = upright({0.0, 0.0, side * plan.wall}, side > 0.0 ? 0.5 : 0.0);  // z into the hall
  const double half = plan.half_length() + 1.0;
  sketch.use(hall.material.plaster);
  sketch.box(frame, {-half, -0.5, -0.5}, {half, plan.eaves, 0.0});
  for (unsigned i = 0; i <= plan.bays; ++i) {
    const double x = plan.bay * i - plan.half_length();
    sketch.use(hall.material.stone);
    sketch.box(frame, {x - 0.35, 0.0, -0.05}, {x + 0.35, plan.gallery - 0.45, 0.16});
    sketch.box(frame, {x - 0.3, plan.gallery, -0.05}, {x + 0.3, plan.eaves, 0.14});
    if (i == plan.bays) break;
    const double middle = x + 0.5 * plan.bay;
    sketch.use(hall.material.wood);
    sketch.box(frame, {middle - 0.95, 1.5, -0.05}, {middle + 0.95, 3.9, 0.06});
    sketch.use(hall.material.painting[(i + (side > 0.0 ? 1 : 0)) % 3]);
    sketch.box(frame, {middle - 0.82, 1.63, 0.0}, {middle + 0.82, 3.77, 0.075});
  }
  sketch.use(hall.material.trim);
  sketch.box(frame, {-half, 0.0, -0.05}, {half, 0.4, 0.1});
}

// The wall across an end, with a tall blind arch framed by a moulding.
void draw_end_wall(Atrium& hall, double side) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const double x = side * plan.half_length();
  const Frame frame = upright({x + side * 0.9, 0.0, 0.0}, side > 0.0 ? 0.75 : 0.25);  // z into the hall
  sketch.use(hall.material.plaster);
  sketch.box(frame, {-plan.wall - 0.5, -0.5, -0.5}, {plan.wall + 0.5, plan.eaves + 1.2, 0.0});
  sketch.use(hall.material.stone);
  for (const double edge : {-1.0, 1.0}) {
    sketch.box(frame.moved(edge * 3.3, 0.0, 0.0), {-1.1, 0.0, -0.05}, {1.1, plan.eaves, 0.55});
    sketch.box(frame.moved(edge * 7.2, 0.0, 0.0), {-2.2, plan.gallery - 0.5, -0.05},
               {2.2, plan.gallery, 0.4});
  }
  sketch.box(frame, {-2.3, plan.gallery + 1.6, -0.05}, {2.3, plan.eaves, 0.55});
  sketch.use(hall.material.trim);
  std::vector<Point> path;
  for (unsigned i = 0; i <= 24; ++i) {
    const double turns = 0.5 * i / 24.0;
    path.push_back(frame.at(2.2 * cos_turns(turns), plan.gallery - 0.7 + 2.2 * sin_turns(turns), 0.56));
  }
  const std::vector<double> radii(path.size(), 0.14);
  sketch.tube(path, radii, 6);
}

// Floors and edges that run the whole length on each side.
void draw_gallery(Atrium& hall, double side) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const Frame frame = upright({0.0, 0.0, 0.0}, side > 0.0 ? 0.5 : 0.0);  // nave towards +z of the frame
  const double half = plan.half_length() + 0.9;
  const double inner = -plan.arcade + 0.5 * plan.thickness;
  sketch.use(hall.material.plaster);
  sketch.box(frame, {-half, plan.gallery - 0.35, -plan.wall}, {half, plan.gallery, -plan.arcade});
  sketch.box(frame, {-half, plan.eaves, -plan.wall - 0.5}, {half, plan.eaves + 0.3, inner - 0.05});
  sketch.use(hall.material.trim);
  sketch.box(frame, {-half, plan.gallery - 0.3, -plan.arcade}, {half, plan.gallery - 0.12, inner + 0.12});
  sketch.box(frame, {-half, plan.gallery - 0.12, -plan.arcade}, {half, plan.gallery, inner + 0.24});
  sketch.box(frame, {-half, plan.eaves - 0.35, inner - 0.1}, {half, plan.eaves - 0.15, inner + 0.1});
  sketch.box(frame, {-half, plan.eaves - 0.15, inner - 0.1}, {half, plan.eaves + 0.05, inner + 0.22});
}

}  // namespace

void draw_columns(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  const double budget = share_of(hall.sketch, goal, 2);
  for (const double side : {-1.0, 1.0}) {
    const double z = side * plan.arcade;
    draw_column_row(hall, {0.0, plan.spring, 0.42, z, plan.bay, plan.bays + 1}, 0.5 * budget);
    draw_column_row(
        hall, {plan.gallery, plan.upper_spring - plan.gallery, 0.2, z, 0.5 * plan.bay, 2 * plan.bays + 1},
        0.5 * budget);
  }
}

void draw_arches(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  const double budget = share_of(hall.sketch, goal, 4);
  for (const double side : {-1.0, 1.0}) {
    const double z = side * plan.arcade;
    draw_arch_row(hall, {0.0, z, 0.5 * plan.bay - 0.6, 0.5 * plan.bay, plan.spring, plan.gallery - 0.2},
                  plan.bays, budget);
    draw_arch_row(hall, {0.0, z, 0.25 * plan.bay - 0.28, 0.25 * plan.bay, plan.upper_spring, plan.eaves},
                  2 * plan.bays, budget);
  }
}

void draw_shell(Atrium& hall) {
  for (const double side : {-1.0, 1.0}) {
    draw_side_wall(hall, side);
    draw_end_wall(hall, side);
    draw_gallery(hall, side);
  }
}

// Beams across, purlins along, thin braces on the diagonal, and a skin of boards that leaves every other bay
// open.
void draw_roof(Atrium& hall, std::uint64_t goal) {
  const AtriumPlan& plan = hall.plan;
  MeshSketch& sketch = hall.sketch;
  const double half = plan.half_length() + 0.4;
  const double span = plan.arcade + 0.3;
  const double y = plan.eaves + 0.05;
  const Frame frame;
  sketch.use(hall.material.wood);
  for (int k = -2; k <= 2; ++k) {
    sketch.box(frame, {-half, y + 0.3, 1.9 * k - 0.07}, {half, y + 0.46, 1.9 * k + 0.07});
  }
  const unsigned boards = 2 * plan.bays;
  for (unsigned i = 0; i < boards; i += 2) {
    const double x = -half + half * i / (0.5 * boards) + (i % 4 == 0 ? 0.0 : 0.3);
    sketch.box(frame, {x, y + 0.46, -span}, {x + half / boards * 1.1, y + 0.52, span});
  }
  // More than six to a bay would shut the sun out.
  const unsigned beams = std::min(at_least(2 * plan.bays, share_of(sketch, goal, 1) / 36.0), 6 * plan.bays);
  const double step = 2.0 * half / beams;
  for (unsigned i = 0; i < beams; ++i) {
    const double x = -half + step * (i + 0.5);
    sketch.use(hall.material.wood);
    const double broad = std::min(0.1, 0.22 * step);
    sketch.box(frame, {x - broad, y, -span}, {x + broad, y + 0.3, span});
    sketch.use(hall.material.iron);
    const double low = i % 2 == 0 ? -span : span;
    sketch.bar({x, y + 0.15, low}, {x + step, y + 0.55, -low}, 0.018, 6);
    sketch.bar({x, y - 0.3, low}, {x, y + 0.1, 0.0}, 0.022, 6);
  }
}

}  // namespace gnomon
