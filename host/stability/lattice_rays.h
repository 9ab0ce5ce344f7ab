// Rays at a hill's corners, edges and faces, all on its lattice, so that they are aimed exactly. Feeds the
// cases of rays.
#pragma once

#include "gnomon/stability/aim.h"

namespace gnomon::stability {

inline constexpr std::uint32_t kCells = 12;  // of a hill's side: 288 triangles

inline float lattice(SteadyRandom& random, std::uint32_t below) {
  return static_cast<float>(random.below(below));
}

// Above a hill over [0, 2 kCells]^2, on the lattice, outside its surface.
inline Point above(SteadyRandom& random) {
  const float x = lattice(random, 2 * kCells + 8) - 4.0F;
  const float z = lattice(random, 2 * kCells + 8) - 4.0F;
  return {x, 40.0F + lattice(random, 30), z};
}

inline Point inner_lattice_point(SteadyRandom& random) {
  const float x = 2.0F + 2.0F * lattice(random, kCells - 1);
  return {x, 0.0F, 2.0F + 2.0F * lattice(random, kCells - 1)};
}

// Steep rays from above at places of kind 0, 1 or 2 of place_on, all inside the border.
inline std::vector<Ray> rays_at(const Triangles& mesh, std::uint32_t kind, std::uint32_t count,
                                std::uint64_t seed) {
  SteadyRandom random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Point target = place_on(mesh[random.below(static_cast<unsigned>(mesh.size()))], kind, random);
    Ray ray = towards(above(random), target);
    const float stretch = 1.0F + lattice(random, 3);  // t = 1, 1/2 or 1/3
    for (float& d : ray.direction) d *= stretch;
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace gnomon::stability
