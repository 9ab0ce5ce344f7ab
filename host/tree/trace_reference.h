// Traversal in plain C++ with the kernels' own arithmetic (kernels/shared/hit_math.h): what the device tracer
// is tested against, visit by visit. Not the judge of correctness (oracle.h is). Feeds tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/shared/layout.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

using Triangle = GnTriangle;
using Ray = GnRay;
using Hit = GnHit;

// Work of one ray, as GnRayCounters.
struct ReferenceTrace {
  std::vector<Hit> hits;
  std::vector<GnRayCounters> counters;
  std::uint64_t invalid_rays = 0;
};

// Closest hits; with any_hit, each ray stops at the first hit it finds (hits[i].primitive says whether there
// is one). The nearer child goes first; with any_hit and `ranks`, one a node (gnomon/plan/child_order.h),
// that of higher rank does, the left one of equals. Throws Error{kInvalidArgument} for another number of
// ranks than nodes.
[[nodiscard]] ReferenceTrace trace_reference(const Bvh& bvh, std::span<const Triangle> triangles,
                                             std::span<const Ray> rays, bool any_hit,
                                             std::span<const float> ranks = {});

}  // namespace gnomon
