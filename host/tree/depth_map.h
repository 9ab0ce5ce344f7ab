// Depth maps of areas: what their rays meet first, as optimisation of trees asks for it
// (kernels/shared/depth_map.h). Made of rays that somebody traces: nothing here looks at triangles. Feeds
// OptimiseOptions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/shared/box_costs.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon {

// Without sums: nothing is hidden.
struct DepthMap {
  GnDepthMap shape{};
  std::vector<std::uint16_t> sums;  // GN_MAP_SUMS
};

// One ray through the middle of each cell, row by row from the lower left, for closest hits: their t is the
// depth along the measure's forward. Depths from near to far count; far may be infinite. The measure is of
// parallel rays in a window or of rays from a point through one. Throws Error{kInvalidArgument}: another
// measure, or depths that are not 0 <= near < far.
[[nodiscard]] std::vector<Ray> depth_rays(const GnMeasure& measure, float near_depth, float far_depth);

// The map of what those rays met. Throws the same, and for another number of hits.
[[nodiscard]] DepthMap depth_map_of(const GnMeasure& measure, float near_depth, float far_depth,
                                    std::span<const Hit> hits);

// Rays that go to or come from one place or one way, in what a tree's boxes are to cost.
struct AreaCost {
  GnMeasure measure{};
  DepthMap map;
  // What a box costs that all of these rays meet and see, as a multiple of what face weights give the root:
  // >= 0.
  float share = 1.0F;
};

// As the optimisers read them, for a tree with this root: scales are relative to it.
struct AreaCosts {
  std::vector<GnAreaCost> areas;
  std::vector<std::uint16_t> maps;
};
[[nodiscard]] AreaCosts area_costs(std::span<const AreaCost> areas, float root_faces, const float* root_lo,
                                   const float* root_hi);

}  // namespace gnomon
