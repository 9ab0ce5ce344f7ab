// The thesis' builders as build options, and the triangles that its program gave them. Not an endorsement:
// they are here to be measured. Feeds the reproduction of the thesis.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/tree/build_options.h"

namespace gnomon {

// The thesis' tests of one set-up, by the names in its results, and what it says it ran but did not.
enum class PublishedVariant {
  kFull,         // PAH and SPFH
  kFacing,       // SAH and SPFH
  kStandard,     // SAH and LSPH
  kLongest,      // plane: PAH and LSPH; point: what was run, SAH and SPFH with LSPH's threshold
  kTrueLongest,  // PAH and LSPH for points too; never published
};
[[nodiscard]] std::string_view to_string(PublishedVariant variant);
// "PAH+SPFH@0.4" ...: the heuristics that it really is, and the quality threshold of its axes.
[[nodiscard]] std::string_view heuristics_of(PublishedVariant variant, AreaKind kind);

// The program's constants: 40 bins, thresholds 0.4 (SPFH) and 0.99 (LSPH), ratios 1.3 and 0.9, leaves of one
// triangle, and its rules with their faults. PAH is culled and relative to the window; points measure areas
// on the near plane, whatever their rays. Throws Error{kInvalidArgument} for an omni area, which the thesis
// does not have.
[[nodiscard]] BuildOptions published_options(PublishedVariant variant, const InfluenceArea& area);

// Of its global tree: SAH and LSPH with threshold 0.4.
[[nodiscard]] BuildOptions published_global_options();

// The indices of the triangles in its local tree, ascending: those with a corner in a cell of its octree that
// meets the region. The octree halves the region's enclosing box five times, so these are a few more than the
// triangles with a corner inside (Membership::kVertices).
[[nodiscard]] std::vector<std::uint32_t> published_members(const InfluenceArea& area,
                                                           std::span<const GnTriangle> triangles);

}  // namespace gnomon
