// An influence area's rays as the builders' shared code measures them. Feeds the options of the reproduction.
#pragma once

#include "gnomon/areas/ray_measure.h"
#include "gnomon/tree/build_options.h"

namespace gnomon {

// The culled measure of a box relative to that of the whole window, so that it is the probability that one of
// the area's rays, which start in the window, meets it: kParallel is GN_MEASURE_WINDOW, the others their
// namesakes. Ties are settled by surface area. Throws Error{kInvalidArgument} when the area has no such rays.
[[nodiscard]] GnMeasure area_measure(const InfluenceArea& area, RayMeasure measure);

// Surface area, with the area's frame for policies that ask where rays come from.
[[nodiscard]] GnMeasure framed_surface_measure(const InfluenceArea& area);

}  // namespace gnomon
