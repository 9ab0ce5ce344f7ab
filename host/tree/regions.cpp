#include "gnomon/tree/regions.h"

#include <algorithm>

#include "gnomon/base/error.h"
#include "gnomon/tree/box_frame.h"

namespace gnomon {

namespace {

// Calls visit with each region's place until it says that the ray is whole in one.
template <typename RegionAt>
std::uint32_t first_with(std::size_t count, GnRay ray, const RegionAt& region_at) {
  if (gn_ray_is_valid(&ray) == 0) return GN_NONE;
  ray.tmin = gn_finite_tmin(ray.tmin);
  ray.tmax = gn_finite_tmax(ray.tmax);
  const GnRayFrame frame = gn_ray_frame(&ray);
  for (std::size_t i = 0; i < count; ++i) {
    if (gn_region_of(&ray, frame.inverse, &region_at(i), 1) == 0) return static_cast<std::uint32_t>(i);
  }
  return GN_NONE;
}

}  // namespace

std::uint32_t region_of(std::span<const Region> regions, GnRay ray) {
  return first_with(regions.size(), ray, [&](std::size_t i) -> const Region& { return regions[i]; });
}

std::uint32_t region_of(std::span<const RegionTree> trees, const GnRay& ray) {
  return first_with(trees.size(), ray, [&](std::size_t i) -> const Region& { return trees[i].region; });
}

void refuse_regions(std::span<const Region> regions, const std::string& what) {
  if (regions.empty()) return;
  throw Error(ErrorCode::kInvalidArgument,
              what + " takes no trees with local ones for regions beside them (a plan's local trees)");
}

void check_join(std::span<const TreeSize> trees, std::size_t regions) {
  if (trees.size() != regions + 1) {
    throw Error(ErrorCode::kInvalidArgument, std::to_string(trees.size() - 1) + " local trees for " +
                                                 std::to_string(regions) + " regions; there is one for each");
  }
  TreeSize sum;
  for (const TreeSize& tree : trees) {
    sum.nodes += tree.nodes;
    sum.places += tree.places;
  }
  if (sum.places > GN_MAX_PLACES || sum.nodes >= GN_LEAF_LINK) {
    throw Error(ErrorCode::kOutOfMemory, "a wide tree and its local trees have together " +
                                             std::to_string(sum.places) +
                                             " places of triangles, more than links can name");
  }
}

WideBvh join_reference(const WideBvh& all, std::span<const WideBvh> local, std::span<const Region> regions) {
  std::vector<TreeSize> sizes{{all.nodes.size(), all.places()}};
  refuse_frame(all.frame, "joining local trees to a tree");
  refuse_regions(all.regions, "joining local trees to a tree");
  for (const WideBvh& tree : local) {
    refuse_frame(tree.frame, "joining local trees to a tree");
    refuse_regions(tree.regions, "joining local trees to a tree");
    sizes.push_back({tree.nodes.size(), tree.places()});
  }
  check_join(sizes, regions.size());
  WideBvh out = all;
  for (std::size_t i = 0; i < local.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(out.nodes.size());
    const auto places = static_cast<std::uint32_t>(out.places());
    out.regions.push_back(regions[i]);
    out.regions.back().root = first;
    for (WideNode node : local[i].nodes) {
      for (std::uint32_t& link : node.links) link = gn_moved_link(link, first, places);
      out.nodes.push_back(node);
    }
    out.leaves.insert(out.leaves.end(), local[i].leaves.begin(), local[i].leaves.end());
    out.depth = std::max(out.depth, local[i].depth);
  }
  return out;
}

}  // namespace gnomon
