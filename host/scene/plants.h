// Trees, flowers and grass for the outdoor scenes: many small triangles in no order. Feeds
// generate_cottage.cpp and generate_forest.cpp.
#pragma once

#include "gnomon/scene/mesh_sketch.h"

namespace gnomon {

struct TreeKind {
  bool fir;  // a straight trunk with whorls of drooping branches; otherwise a spreading crown
  MaterialId bark;
  MaterialId leaf;
};

// A tree of about `triangles` triangles (at least about 60): a third of them wood, the others leaf cards.
void draw_tree(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height,
               const TreeKind& kind, double triangles);

struct FlowerKind {
  MaterialId stem;
  MaterialId petal;
  MaterialId eye;
};

inline constexpr unsigned kFlowerTriangles = 30;
void draw_flower(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height,
                 const FlowerKind& kind);

// A bent blade of three triangles.
inline constexpr unsigned kBladeTriangles = 3;
void draw_grass_blade(MeshSketch& sketch, SteadyRandom& random, const Point& foot, double height);

}  // namespace gnomon
