// Whether boxes along the rays (gnomon/tree/box_frame.h) could be met less often than the world's. What rays
// of unit direction d see of a box is E|d_k| times its faces, so of a cube the sum of E|d_k|: 1 where all run
// along an axis, 1.73 where all are oblique to the three. That is how much boxes in a frame can gain, and all
// that world-axis trees for those rays can gain by (host/notes/light-space.md). Not for making trees. Feeds
// plan_pool.h.
#pragma once

#include <array>
#include <span>

#include "gnomon/plan/ray_sample.h"

namespace gnomon {

struct LightSpace {
  std::array<double, 3> direction{0.0, 0.0, 1.0};  // the mean of the rays', turned to one side
  double obliquity = 1.0;  // what rays see of a cube over what they see of one that stands along them
};

// Of rays in all directions, and of none, obliquity is about 1.
[[nodiscard]] LightSpace light_space_of(std::span<const Ray> rays);

// What a ray that meets everything costs in the tree, times what it sees of the scene: E|d_k| as weights.
[[nodiscard]] double seen_total(const Bvh& bvh, const std::array<double, 3>& mean);

}  // namespace gnomon
