// An influence area as the kernels test it (kernels/shared/area_math.h). Not for anything that needs the
// region exactly. Feeds the top level.
#pragma once

#include "gnomon/areas/influence_area.h"
#include "gnomon/shared/area_layout.h"
#include "gnomon/shared/region.h"

namespace gnomon {

// Within `tolerance` of |cos| = 1 a ray is meant for the area, as InfluenceArea::is_affine; 1 and more: every
// direction is. The record's root is GN_NONE. Throws Error{kInvalidArgument} when the region's largest
// coordinate is beyond 2^48 or below 2^-40 (float would overflow or underflow), or the tolerance is not a
// number from 0 on.
[[nodiscard]] GnArea to_shared(const InfluenceArea& area, double tolerance = 0.01);

// The region of an area as traversal tests rays against it. scene: around all triangles. Its root is GN_NONE.
// Throws as to_shared, and Error{kInvalidArgument} for a ball, which has no planes.
[[nodiscard]] GnRegion to_region(const InfluenceArea& area, const Box3d& scene);

// The smallest float box around a box within float's range.
struct FloatBox {
  std::array<float, 3> lo;
  std::array<float, 3> hi;
};
[[nodiscard]] FloatBox float_box_around(const Box3d& box);

}  // namespace gnomon
