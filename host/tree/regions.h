// Trees for rays that are within a region whole, beside a tree of all triangles: which of them a ray is
// traced through, and how wide ones are joined to one. Not for finding regions (host/plan). Feeds plans, the
// wide tracer, its reference.
#pragma once

#include <span>
#include <vector>

#include "gnomon/shared/region.h"
#include "gnomon/tree/wide.h"

namespace gnomon {

using Region = GnRegion;

// A tree over the triangles that touch a region.
struct RegionTree {
  Region region{};             // its root is not read
  Bvh bvh{};                   // numbers of triangles are the scene's
  std::vector<float> ranks{};  // as OrderedTree's
  std::vector<float> weights{};
};

// The place of the first region that has the ray whole; GN_NONE where none has, or it is not traceable.
[[nodiscard]] std::uint32_t region_of(std::span<const Region> regions, GnRay ray);
[[nodiscard]] std::uint32_t region_of(std::span<const RegionTree> trees, const GnRay& ray);

// `all` with the other trees behind it, one a region; their roots are filled in. Throws
// Error{kInvalidArgument} for boxes in a frame, trees that are joined already, another number of regions than
// trees; kOutOfMemory for more triangles than links can name. Same bytes as the device's.
[[nodiscard]] WideBvh join_reference(const WideBvh& all, std::span<const WideBvh> local,
                                     std::span<const Region> regions);

// Throws Error{kInvalidArgument} where there are regions: `what` takes no such trees.
void refuse_regions(std::span<const Region> regions, const std::string& what);

// As join_reference; of trees with so many nodes and places.
struct TreeSize {
  std::uint64_t nodes = 0;
  std::uint64_t places = 0;
};
void check_join(std::span<const TreeSize> trees, std::size_t regions);

}  // namespace gnomon
