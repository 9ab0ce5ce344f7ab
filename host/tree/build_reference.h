// The builder in plain C++, one thread, the same decisions as the device's bit for bit. Not fast and not
// meant to be: it is what the device builder is tested against, and what runs where no device is. Feeds tests
// and tools.
#pragma once

#include <span>

#include "gnomon/tree/bvh.h"

namespace gnomon {

using Triangle = GnTriangle;

// Top-down binned SAH over all three axes (Wald 2007) with the constants of `options`.
// Throws Error: kInvalidArgument (options), kBadScene (a coordinate that is not finite or beyond 2^48; names
// the triangle).
[[nodiscard]] Bvh build_reference(std::span<const Triangle> triangles, const BuildOptions& options = {});

// Dense tree from nodes placed by split position: the children of a split at leaf position m stand at 2m and
// 2m + 1 of `sparse`, inner nodes link to 2m. is_split[m] says which m are splits. The root is sparse[0].
[[nodiscard]] std::vector<Node> compact_nodes(const std::vector<Node>& sparse,
                                              const std::vector<bool>& is_split);

}  // namespace gnomon
