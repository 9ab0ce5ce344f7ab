// What a plan's rays run through together, as optimisation by areas asks for it: bundles and pencils found in
// a sample (gnomon/areas/detect.h), each with a depth map of what its rays meet first. Not public. Feeds
// plan_pool.cpp.
#pragma once

#include <span>
#include <vector>

#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/depth_map.h"

namespace gnomon {

struct SeenAreas {
  std::vector<AreaCost> areas;  // those that have most of the rays; none where rays do not run together
  double coverage = 0.0;        // share of the rays that are in them
  double traced = 0.0;          // what tracing the maps cost, as ray_costs reckons
};

// Surface area is taken to stand for all other rays, and for a twentieth of these. Rays must be traceable;
// the tree holds all triangles.
[[nodiscard]] SeenAreas seen_areas(const Bvh& tree, std::span<const Triangle> triangles,
                                   std::span<const Ray> rays);

}  // namespace gnomon
