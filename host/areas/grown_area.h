// A slightly larger area around an area: what rays that start exactly in its window or eye need, since float
// can tell that a point is inside only when it is so by a margin. Feeds forests.
#pragma once

#include "gnomon/areas/influence_area.h"

namespace gnomon {

// The area of the same kind, turned the same way, with every face moved outwards by at least `distance` >= 0:
// a box's by just that; a frustum's sides by moving its eye back by distance / sin of the narrower half
// angle, so its eye is no longer the rays'. Holds every point within `distance` of the region.
[[nodiscard]] InfluenceArea grown_by(const InfluenceArea& area, double distance);

}  // namespace gnomon
