// The atrium's plan and the parts it is drawn from: a nave between two arcades, aisles behind them, galleries
// over the aisles, and a roof of thin beams that the sun falls through. Feeds generate_atrium.cpp only.
#pragma once

#include <array>
#include <cstdint>

#include "gnomon/scene/mesh_sketch.h"

namespace gnomon {

// Lengths in metres. x runs along the nave, z across it.
struct AtriumPlan {
  unsigned bays;  // between columns, on each side
  double bay = 4.0;
  double arcade = 5.0;   // from the middle to the columns' axis
  double wall = 9.5;     // from the middle to the outer walls
  double spring = 4.1;   // where the lower arches begin
  double gallery = 6.4;  // the galleries' floor
  double upper_spring = 9.0;
  double eaves = 11.6;
  double thickness = 0.7;  // of the arcade walls
  [[nodiscard]] double half_length() const { return 0.5 * bay * bays; }
};

struct AtriumMaterials {
  MaterialId stone, trim, plaster, tile_light, tile_dark, grout, wood, iron, bronze, leaf, clay, water, panel;
  std::array<MaterialId, 4> cloth;
  std::array<MaterialId, 3> painting;
};

struct Atrium {
  MeshSketch sketch;
  SteadyRandom random;
  AtriumPlan plan;
  AtriumMaterials material{};
};

// Where the bowl of an aisle's lamp hangs; its point light is just below.
[[nodiscard]] inline Point aisle_lamp_at(const AtriumPlan& plan, double side) {
  return {side * 0.4 * plan.half_length(), plan.gallery - 1.5, side * 0.5 * (plan.arcade + plan.wall)};
}

// Each draws its part with about `goal - sketch.count()` triangles, or a fixed few where no goal is taken.
void draw_columns(Atrium& hall, std::uint64_t goal);
void draw_arches(Atrium& hall, std::uint64_t goal);
void draw_shell(Atrium& hall);
void draw_roof(Atrium& hall, std::uint64_t goal);
void draw_tiles(Atrium& hall, std::uint64_t goal);
void draw_balustrades(Atrium& hall, std::uint64_t goal);
void draw_fountain(Atrium& hall, std::uint64_t goal);
void draw_pots(Atrium& hall, std::uint64_t goal);
void draw_lanterns(Atrium& hall, std::uint64_t goal);
void draw_curtains(Atrium& hall, std::uint64_t goal);

}  // namespace gnomon
