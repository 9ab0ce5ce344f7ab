// What a local tree costs and answers beside the global tree alone, on the host and in counts. Feeds the
// claims of the failure map.
#pragma once

#include "figures.h"

namespace gnomon::bench {

struct LocalFigures {
  double share = 0.0;       // of the scene's triangles that are in the local tree
  double hit_share = 0.0;   // of rays, by the global tree
  double left_share = 0.0;  // of rays that the exit rule leaves to the global tree, from somewhere on
  Work global;              // alone
  Work by_exit;             // local tree up to the region's end, the global one from there on
  Work published;           // local tree, on a miss the global one from the start
  std::uint64_t wrong = 0;  // hits of the published rule that are not the nearest
};

// Trees by surface area, members exact.
[[nodiscard]] LocalFigures local_figures(const CaseScene& scene, const InfluenceArea& area,
                                         std::span<const GnRay> rays);

// The same area, ending at such a share of its depth.
[[nodiscard]] InfluenceArea shortened(const InfluenceArea& area, double share);

}  // namespace gnomon::bench
