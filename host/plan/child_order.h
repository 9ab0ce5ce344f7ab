// Which child an any-hit ray should look at first, learnt from sampled rays: the one with the most hits for
// its cost, by how often rays that meet its box are stopped below it. It costs traversal nothing and changes
// no answer. Not for closest hit, which goes by distance. Feeds plans, the collapse's slot order (wide.h),
// benches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

struct OrderOptions {
  // What stands for rays where few sampled ones came: w . (dy dz, dx dz, dx dy) of boxes and of the area
  // triangles show each axis. mixed_weights() makes them.
  std::array<float, 3> face_weights{1.0F, 1.0F, 1.0F};
  float prior_rays = 2.0F;     // so many sampled rays the areas' word is worth; > 0, finite
  float cost_inner = 2.0F;     // of visiting an inner node; (0, 1000]
  float cost_triangle = 1.2F;  // (0, 1000]

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// What a sample says about any-hit rays in a tree.
struct ChildOrder {
  // One a node: hits below it per cost of looking there. Siblings of higher rank go first, in trace_reference
  // and as slot keys of collapse_reference and collapse_device.
  std::vector<float> ranks;
  double sample_cost = 0.0;  // a ray of the sample in this order, the root's box not counted
  double work = 0.0;         // of learning, all rays together: every ray looks into all it meets
};

// Learns ranks from the rays (their ranges count; not traceable ones are left out), from the leaves up: what
// a subtree costs a ray follows from the orders below it. Where no ray came ranks are those of areas alone.
// Deterministic. Throws Error{kInvalidArgument} (options).
[[nodiscard]] ChildOrder learn_order(const Bvh& bvh, std::span<const Triangle> triangles,
                                     std::span<const Ray> rays, const OrderOptions& options = {});

}  // namespace gnomon
