// The fast builder in plain C++, one thread, the same decisions as the device's bit for bit: what that is
// tested against. Called by build_reference for Builder::kFast. Feeds tests and tools through it.
#pragma once

#include <span>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// Triangles in Morton order, merged bottom up within segments of GN_SEGMENT, and a tree by cost over the
// clusters that remain (host/notes/fast-builder.md). At most 64 + ceil(log2 n) deep. Throws Error:
// kInvalidArgument (options), kBadScene (as build_reference).
[[nodiscard]] Bvh build_fast_reference(std::span<const GnTriangle> triangles, const BuildOptions& options);

// The options of the tree over the clusters, one cluster a leaf.
[[nodiscard]] BuildOptions options_over_clusters(const BuildOptions& options);

// Numbers of triangles in the order of the fast builder's curve. Equal codes stay in the order of numbers.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const GnTriangle> triangles);

}  // namespace gnomon
