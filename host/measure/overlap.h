// How much siblings hide behind each other as an area's rays see them (thesis 5.1, exported metric). Not a
// cost: it only explains one. Feeds the reproduction of the thesis.
#pragma once

#include <cstdint>
#include <limits>

#include "gnomon/areas/projection.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

inline constexpr std::uint32_t kAllLevels = std::numeric_limits<std::uint32_t>::max();

// Sum of V over sum of min(A1, A2) for the inner nodes of levels 1 (the root) to max_level: A1 and A2 are the
// areas of their two children's culled outlines, V that of what the outlines share. 0 is no overlap, 1 all
// that is possible; 0 where nothing is seen. kParallel and kNearPlane only, else it throws as culled_hull.
[[nodiscard]] double sibling_overlap(const Bvh& bvh, const InfluenceArea& area, RayMeasure measure,
                                     std::uint32_t max_level = kAllLevels);

}  // namespace gnomon
