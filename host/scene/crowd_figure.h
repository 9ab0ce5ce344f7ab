// One person of the crowd: a body of rounded limbs in a given pose. Feeds generate_crowd.cpp only.
#pragma once

#include "gnomon/scene/mesh_sketch.h"

namespace gnomon {

struct Outfit {
  MaterialId skin, hair, top, legs, shoes;
  bool skirt;
};

enum class Pose { kStanding, kWalking, kCheering, kWaving, kClapping, kHandsOnHips, kCount };

// A figure on the frame's origin that looks along its z, `height` metres tall, of about `triangles`
// triangles.
void draw_figure(MeshSketch& sketch, SteadyRandom& random, const Frame& foot, double height, Pose pose,
                 const Outfit& outfit, double triangles);

// What the coarsest figure takes.
inline constexpr double kMinFigureTriangles = 340.0;

}  // namespace gnomon
