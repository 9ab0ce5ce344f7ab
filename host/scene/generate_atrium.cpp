// A columned hall in the spirit of the palaces renderers are tried on: see atrium_parts.h.
#include <cmath>

#include "gnomon/scene/atrium_parts.h"
#include "gnomon/scene/generator_list.h"

namespace gnomon {
namespace {

AtriumMaterials add_materials(MeshSketch& sketch) {
  AtriumMaterials m{};
  m.stone = sketch.material("stone", {0.61F, 0.52F, 0.40F}, 0.9F);
  m.trim = sketch.material("trim", {0.71F, 0.64F, 0.53F}, 0.8F);
  m.plaster = sketch.material("plaster", {0.66F, 0.54F, 0.40F});
  m.tile_light = sketch.material("marble", {0.66F, 0.59F, 0.50F}, 0.35F);
  m.tile_dark = sketch.material("terracotta", {0.42F, 0.22F, 0.15F}, 0.45F);
  m.grout = sketch.material("grout", {0.25F, 0.23F, 0.21F});
  m.wood = sketch.material("wood", {0.30F, 0.18F, 0.10F}, 0.8F);
  m.iron = sketch.material("iron", {0.12F, 0.12F, 0.13F}, 0.5F);
  m.bronze = sketch.material("bronze", {0.55F, 0.38F, 0.16F}, 0.3F);
  m.leaf = sketch.material("leaf", {0.13F, 0.34F, 0.10F}, 0.7F);
  m.clay = sketch.material("clay", {0.60F, 0.30F, 0.19F}, 0.9F);
  m.water = sketch.material("water", {0.20F, 0.38F, 0.42F}, 0.1F);
  m.panel = sketch.material("light panel", {0.2F, 0.2F, 0.2F}, 1.0F, {16.0F, 12.5F, 8.0F});
  m.cloth = {sketch.material("red cloth", {0.58F, 0.06F, 0.05F}),
             sketch.material("blue cloth", {0.08F, 0.16F, 0.42F}),
             sketch.material("green cloth", {0.10F, 0.32F, 0.14F}),
             sketch.material("gold cloth", {0.76F, 0.52F, 0.13F})};
  m.painting = {sketch.material("sea picture", {0.16F, 0.32F, 0.44F}, 0.5F),
                sketch.material("meadow picture", {0.36F, 0.42F, 0.17F}, 0.5F),
                sketch.material("dusk picture", {0.55F, 0.27F, 0.20F}, 0.5F)};
  return m;
}

// The sun comes in steeply over the right-hand eaves; lanterns, a spot on the far arch and a panel fill the
// shade.
void add_lights(Atrium& hall) {
  const AtriumPlan& plan = hall.plan;
  hall.sketch.sun({0.28, -1.0, -0.42}, {26.0F, 23.5F, 19.0F});
  for (int i = -1; i <= 1; ++i) {
    const double x = 0.55 * plan.half_length() * i + (i == 0 ? 0.0 : 0.4);
    hall.sketch.point_light("lantern", {x, 7.25, 0.0}, {45.0F, 32.0F, 17.0F});
  }
  for (const double side : {-1.0, 1.0}) {
    hall.sketch.point_light("aisle lamp", aisle_lamp_at(plan, side) - Point{0.0, 0.25, 0.0},
                            {16.0F, 11.0F, 6.0F});
  }
  hall.sketch.spot_light("spot", {plan.half_length() - 7.0, 9.8, 0.0}, {plan.half_length() + 0.9, 4.2, 0.0},
                         {130.0F, 108.0F, 76.0F}, 0.5);
  const double y = plan.gallery - 0.36;
  const double z = plan.arcade + 2.2;
  hall.sketch.use(hall.material.panel);
  hall.sketch.quad({-0.9, y, z - 0.4}, {0.9, y, z - 0.4}, {0.9, y, z + 0.4}, {-0.9, y, z + 0.4});
}

void add_cameras(Atrium& hall) {
  const double end = hall.plan.half_length();
  const Point eye{-end + 1.2, 2.6, -1.9};
  hall.sketch.camera("nave", eye, eye + Point{20.0, 2.0, 2.7}, 1.0);
  // Over the balustrade of the second bay, which has no curtain on this side.
  hall.sketch.camera("gallery", {-end + 1.75 * hall.plan.bay, 8.2, 5.75}, {0.05 * end, 3.6, -4.0}, 1.0);
  hall.sketch.camera("aisle", {-0.66 * end, 1.7, 7.5}, {0.6 * end, 2.2, 6.7}, 0.95);
}

}  // namespace

Scene make_atrium(std::uint64_t triangles, std::uint64_t seed) {
  const double n = static_cast<double>(triangles);
  const unsigned bays = n < 20'000.0 ? 5 : at_least(7, std::sqrt(std::sqrt(n / 60'000.0)) * 8.0);
  Atrium hall{MeshSketch("atrium", triangles), SteadyRandom(seed), AtriumPlan{bays}};
  hall.material = add_materials(hall.sketch);
  add_lights(hall);
  draw_shell(hall);
  const auto until = [&](double part) { return hall.sketch.count() + static_cast<std::uint64_t>(part * n); };
  draw_columns(hall, until(0.20));
  draw_arches(hall, until(0.15));
  draw_roof(hall, until(0.03));
  draw_tiles(hall, until(0.10));
  draw_fountain(hall, until(0.04));
  draw_lanterns(hall, until(0.03));
  draw_pots(hall, until(0.08));
  draw_balustrades(hall, until(0.12));
  draw_curtains(hall, triangles);
  add_cameras(hall);
  return hall.sketch.finish();
}

}  // namespace gnomon
