// The thesis' cost of a ray: every node whose box the infinite ray pierces counts, in no order, and nothing
// is pruned. It is what the heuristics predict, not what tracing costs (trace_reference counts that). Feeds
// predictions' checks and the reproduction of the thesis.
#pragma once

#include <span>
#include <vector>

#include "gnomon/areas/ray_tests.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

// Of visiting a pierced inner node: two box tests of cost 1. Of testing one triangle of a pierced leaf.
// (Thesis program: NODE_COST 1.0, LEAF_COST 1.2.)
inline constexpr double kPiercedInnerCost = 2.0;
inline constexpr double kPiercedTriangleCost = 1.2;

// Of one ray, from its origin to infinity, by the slab test in double: 2.0 per pierced inner node, 1.2 per
// triangle of a pierced leaf; the root counts like any node. An empty tree costs nothing. The sum runs in the
// nodes' order.
[[nodiscard]] double all_pierced_cost(const Bvh& bvh, const Ray3d& ray);

// Of each ray; tmin and tmax are left out.
[[nodiscard]] std::vector<double> all_pierced_costs(const Bvh& bvh, std::span<const GnRay> rays);

// A mean over rays and how far off it may be: the standard deviation of one ray over the root of their
// number.
struct MeanCost {
  double mean = 0.0;
  double standard_error = 0.0;
};
// Zeros for no values, no error for one.
[[nodiscard]] MeanCost mean_of(std::span<const double> values);

}  // namespace gnomon
