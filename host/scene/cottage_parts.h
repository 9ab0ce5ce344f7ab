// The cottage and what stands in and around it. Feeds generate_cottage.cpp only.
#pragma once

#include <array>
#include <cstdint>

#include "gnomon/scene/plants.h"

namespace gnomon {

struct CottageMaterials {
  MaterialId plaster, roof, timber, oak, floor, lawn, path, brick, paint, cloth, pottery, stone, grass, shade;
  std::array<MaterialId, 4> books;
  std::array<FlowerKind, 4> flowers;
  TreeKind apple, birch;
};

// The house stands on the origin, its door in the long wall towards +z. Metres.
struct Cottage {
  MeshSketch sketch;
  SteadyRandom random;
  CottageMaterials material{};
  double half_x = 4.4;
  double half_z = 3.2;
  double eaves = 2.7;
  double ridge = 5.1;
  double thick = 0.3;
};

// A few large triangles each.
void draw_house(Cottage& cottage);
void draw_ground(Cottage& cottage);
void draw_yard_walls(Cottage& cottage);

// Many small ones, up to the goal.
void draw_furniture(Cottage& cottage, std::uint64_t goal);
void draw_fence(Cottage& cottage, std::uint64_t goal);

}  // namespace gnomon
