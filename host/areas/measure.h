// An influence area's rays as the builders' float code reads them. Not for exact measures (projection). Feeds
// BuildOptions::measure.
#pragma once

#include "gnomon/areas/influence_area.h"
#include "gnomon/areas/ray_measure.h"
#include "gnomon/shared/build_layout.h"

namespace gnomon {

// The measure of boxes for rays of this area, distributed as `measure` says and starting in its window; culled: only rays
// through the window count. Parallel rays that are not culled are a linear measure. Yaw and pitch are always culled.
// Unit: that of projection.h (areas, steradians, radians squared), but near-plane areas are taken at distance 1.
// Throws Error{kInvalidArgument} when the area has no such rays.
[[nodiscard]] GnMeasure measure_of(const InfluenceArea& area, RayMeasure measure, bool culled);

// The mean over a cone of directions (a sun's disc, a lamp seen from afar): cone_weights as a linear measure.
[[nodiscard]] GnMeasure cone_measure(const Vec3d& direction, double half_angle);

}  // namespace gnomon
