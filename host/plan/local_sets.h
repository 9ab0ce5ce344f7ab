// Regions that rays run through and the triangles that touch them: what local trees are made of. Looks at
// areas that callers know, lights' say, and at the one pencil or bundle that all rays are, where they are
// one; rays in several unknown ones are detect's (gnomon/areas/detect.h), which takes longer than building a
// tree. Not public. Feeds plan_pool.h.
#pragma once

#include <span>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/regions.h"

namespace gnomon {

struct LocalSet {
  InfluenceArea area;                  // grown so that rays which begin in its window or eye are in it
  Region region;                       // the same as rays are tested
  std::vector<std::uint32_t> members;  // triangles that touch it, ascending
  double share = 0.0;                  // of the rays, that are within it whole and in no set before it
};

struct LocalLimits {
  std::size_t most_sets = 4;
  double least_share = 0.1;   // of the rays
  double most_members = 0.5;  // of the triangles
};

struct LocalSets {
  std::vector<LocalSet> sets;
  // Of regions that enough rays are in: how many there were, and the least share of triangles in one; 1
  // where counting ended at most_members.
  std::size_t looked_at = 0;
  double least_members = 1.0;
  double work = 0.0;  // in units of PlanPrices
};

// `tree` is over all triangles. Rays must be traceable.
[[nodiscard]] LocalSets local_sets(const Bvh& tree, std::span<const Triangle> triangles,
                                   std::span<const Ray> rays, std::span<const InfluenceArea> known,
                                   const LocalLimits& limits = {});

}  // namespace gnomon
