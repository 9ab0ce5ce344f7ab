// The all-pierced cost that a measure of boxes predicts for a tree, and how far off it was. Feeds the
// reproduction of the thesis and whoever must choose between trees before rays are traced.
#pragma once

#include "gnomon/areas/projection.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

// Sum over leaves p N 1.2 plus sum over inner nodes p 2.0, where p = culled_measure / window_measure is the
// share of the area's rays that meet the node's box: PAH in the thesis, exact here, and unbiased for rays
// drawn by `measure`. Throws Error{kInvalidArgument} when the area has no such rays.
[[nodiscard]] double predicted_cost(const Bvh& bvh, const InfluenceArea& area, RayMeasure measure,
                                    RayStart start = RayStart::kWindow);

// The same with p = min(1, surface area / the root's): SAH. A root without surface gives every box
// probability 1.
[[nodiscard]] double predicted_surface_cost(const Bvh& bvh);

// |real - predicted| / predicted; 0 where both are 0, infinite where only the prediction is.
[[nodiscard]] double prediction_error(double real, double predicted);

}  // namespace gnomon
