// A few rays that stand for many: what trees are fitted to and judged by. Not for making rays
// (gnomon/scene/ray_set.h, gnomon/areas/area_rays.h). Feeds this room.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/shared/layout.h"
#include "gnomon/tree/bvh.h"
#include "gnomon/tree/regions.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon {

// What is asked of a ray.
enum class Query : std::uint32_t {
  kClosest,  // the nearest hit: boxes behind it are pruned
  kAny,      // whether there is one: shadow rays
  kEvery,    // every box within the range is looked at: rays that nothing stops
};
[[nodiscard]] const char* to_string(Query query);

// `count` of the rays, evenly spread over them in their order; all where there are no more.
[[nodiscard]] std::vector<Ray> thinned(std::span<const Ray> rays, std::uint64_t count);

// Each ray as far as its query looks: closest ones end at their hit in `bvh`, others keep their range.
// Rays that are not traceable are left out. cost: what tracing took is added, as ray_costs reckons.
[[nodiscard]] std::vector<Ray> segments_of(const Bvh& bvh, std::span<const Triangle> triangles,
                                           std::span<const Ray> rays, Query query, double* cost = nullptr);

inline constexpr double kBoxCost = 1.0;
inline constexpr double kTriangleCost = 1.2;
inline constexpr double kRegionCost = 2.0;  // of a region looked at: two points against six planes

// A tree, and what given rays make of its nodes.
struct OrderedTree {
  Bvh bvh;
  std::vector<float> ranks{};    // for any hit (child_order.h); none: the nearer child goes first
  std::vector<float> weights{};  // how likely rays meet them, in any unit; none: as their areas say
  // Trees over part of the triangles, for rays that are whole in the first of their regions that has them.
  std::vector<RegionTree> local{};
};

// The rays by the tree that each is traced through: 0 the tree of all, 1 + i local tree i. Places of rays,
// ascending.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> rays_by_tree(const OrderedTree& tree,
                                                                   std::span<const Ray> rays);

// As trace_reference, each ray through its tree.
[[nodiscard]] ReferenceTrace trace_ordered(const OrderedTree& tree, std::span<const Triangle> triangles,
                                           std::span<const Ray> rays, bool any_hit);

// What each ray costs in the tree: kBoxCost a box tested, the root's not counted, kTriangleCost a triangle,
// kRegionCost a region looked at for it.
// (Thesis program: NODE_COST, LEAF_COST.) kEvery tests no triangle for a hit, but counts it. Rays that are
// not traceable cost nothing.
[[nodiscard]] std::vector<double> ray_costs(const OrderedTree& tree, std::span<const Triangle> triangles,
                                            std::span<const Ray> rays, Query query);

// E|d_k| of the rays' unit directions; 0 where none is traceable.
[[nodiscard]] std::array<double, 3> mean_components(std::span<const Ray> rays);

// Face weights that measure boxes as these rays see them, mixed with surface area: share E|d_k| of unit
// directions, over that of a cube, and 1 - share of the same weight for all faces. No rays: surface area.
// share in [0, 1]; throws Error{kInvalidArgument} otherwise.
[[nodiscard]] std::array<float, 3> mixed_weights(std::span<const Ray> rays, float share);

}  // namespace gnomon
