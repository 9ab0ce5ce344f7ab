// Trees whose boxes stand in a frame, and rays that such boxes lose first when they are too small: through
// corners and along edges, where leaves' boxes end. Feeds the tests of framed trees.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "gnomon/tree/box_frame.h"
#include "gnomon/tree/build_reference.h"
#include "support/wide_shapes.h"

namespace gnomon::test {

using Direction = std::array<double, 3>;

inline const std::vector<Direction>& frame_directions() {
  static const std::vector<Direction> all{
      {1, 1, 1}, {0.3, -0.9, 0.2}, {-0.7, 0.1, 0.8}, {0, -1, 0}, {1e-20, 1, 1e-7}};
  return all;
}

inline Bvh framed_tree(const std::vector<GnTriangle>& triangles, const Direction& direction,
                       const BuildOptions& options = leaves_of(1)) {
  const BoxFrame frame = frame_along(direction, triangles);
  Bvh bvh = build_reference(turned(triangles, frame), options);
  bvh.frame = frame;
  return bvh;
}

// From up to `far` of the scene's size away, or from the corner itself, to corners and edges of triangles:
// any way, along the frame's axes, the world's, or nearly so; some backwards, some with long or short
// directions.
inline std::vector<GnRay> rays_at_corners(const std::vector<GnTriangle>& triangles, const BoxFrame& frame,
                                          std::uint32_t count, std::uint32_t seed, float far) {
  Random random(seed);
  std::vector<GnRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const GnTriangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float* corners[3] = {t.v0, t.v1, t.v2};
    const float* a = corners[random.below(3)];
    const float* b = corners[random.below(3)];
    const double share = random.below(3) == 0 ? random.between(0.0F, 1.0F) : 0.0;
    double way[3];
    const std::uint32_t kind = random.below(4);
    const std::uint32_t axis = random.below(3);
    for (std::size_t k = 0; k < 3; ++k) {
      way[k] = random.between(-1.0F, 1.0F);
      if (kind == 1) way[k] = frame.rows[3 * axis + k];
      if (kind == 2) way[k] = frame.rows[3 * axis + k] + 1e-7 * way[k];
      if (kind == 3) way[k] = k == axis ? 1.0 : 0.0;
    }
    const double distance = random.below(8) == 0 ? 0.0 : double{frame.size} * random.between(0.0F, far);
    const double stretch =
        std::ldexp(1.0, static_cast<int>(random.below(4) == 0 ? random.below(180) : 90) - 90);
    GnRay ray{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double target = double{a[k]} + share * (double{b[k]} - double{a[k]});
      ray.origin[k] = static_cast<float>(target - distance * way[k]);
      // Of whole numbers of the frame's axes the direction stays what it is; others aim again.
      const double aimed = kind == 0 && distance > 0.0 ? (target - double{ray.origin[k]}) / distance : way[k];
      ray.direction[k] = static_cast<float>(stretch * aimed);
    }
    ray.tmax = INFINITY;
    if (random.below(4) == 0) {
      for (float& d : ray.direction) d = -d;
      ray.tmin = -INFINITY;
    }
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace gnomon::test
