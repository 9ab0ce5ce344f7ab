// Projected areas of boxes averaged over a cone of directions: a sun's disc, a lamp seen from afar, a spread
// that blends into the surface area heuristic. Feeds projection and the heuristics' parameters.
#pragma once

#include "gnomon/areas/box.h"

namespace gnomon {

// c_i = E|d_i| for directions d uniform in solid angle within half_angle (radians, 0 to pi) of `direction`
// (any length). Half angle 0 gives |n_i|, the plane's closed form; pi gives 1/2 each, a quarter of the
// surface area. Closed form for every case, absolute error below 2^-36. Throws Error{kInvalidArgument} for an
// angle out of range or a direction that is zero or not finite.
[[nodiscard]] Vec3d cone_weights(const Vec3d& direction, double half_angle);

// c_x d_y d_z + c_y d_x d_z + c_z d_x d_y: the mean projected area of a box, and of an empty one 0.
[[nodiscard]] double weighted_measure(const Vec3d& weights, const Box3d& box);

}  // namespace gnomon
