#include "gnomon/tree/build_best_reference.h"

#include <algorithm>
#include <bit>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/parts.h"

namespace gnomon {

BuildOptions options_over_parts(const BuildOptions& options) {
  BuildOptions out = options;
  out.builder = Builder::kBalanced;
  return out;
}

std::uint32_t most_depth_of_best(const BuildOptions& options, std::uint64_t triangles) {
  // Parts are fewer than twice as many: one level more than a balanced tree of the triangles.
  return options.median_depth +
         static_cast<std::uint32_t>(std::bit_width(std::max<std::uint64_t>(1, triangles) - 1)) + 1;
}

OptimiseOptions optimise_options(const BuildOptions& options, std::uint64_t triangles, const float lo[3],
                                 const float hi[3]) {
  OptimiseOptions out;
  const GnHeuristic heuristic = heuristic_of(options, lo, hi);
  std::copy_n(heuristic.measure.weights, 3, out.face_weights.begin());
  out.max_depth = most_depth_of_best(options, triangles);
  return out;
}

Bvh build_best_reference(std::span<const GnTriangle> triangles, const BuildOptions& options) {
  options.check();
  if (triangles.empty()) return {};
  const BuildOptions over_parts = options_over_parts(options);
  const Bvh bvh = build_over_primitives(parts_of(triangles, kPartBudget), triangles, over_parts);
  return optimise_reference(bvh,
                            optimise_options(options, triangles.size(), bvh.nodes[0].lo, bvh.nodes[0].hi));
}

}  // namespace gnomon
