// A global tree over all triangles and a local one for each influence area, on a device, over one shared
// triangle array. Not for tracing them (trace_areas.h) or finding a ray's area (top_level.h). Feeds the
// tracer of areas, the plan, benches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/areas/membership.h"
#include "gnomon/base/progress.h"
#include "gnomon/device/build_device.h"
#include "gnomon/shared/area_layout.h"

namespace gnomon {

// One local tree to build.
struct LocalTree {
  InfluenceArea area;
  BuildOptions options{};
  // Anything but kExact loses triangles and gives wrong answers under every rule: for experiments.
  Membership membership = Membership::kExact;
  double affinity_tolerance = 0.01;  // see InfluenceArea::is_affine; 1: rays of every direction
  // How far the region is grown on all sides before anything else, as a share of its largest coordinate. By
  // the default rays that start exactly in a window, in a face or in the eye of a view whose near_distance is
  // less still than that, are served; by 0 they go to the global tree, as rounding cannot tell their side.
  double growth = 0x1p-16;
};

// One tree of a forest: where it stands in the shared buffers.
struct ForestTree {
  std::uint32_t root = GN_NONE;  // GN_NONE: a local tree of no triangles
  std::uint32_t node_count = 0;
  std::uint32_t first_place = 0;  // in the order
  std::uint32_t triangle_count = 0;
  std::uint32_t max_depth = 0;
};

// All trees in device memory. Nodes' links are places in the shared buffers; the global tree comes first and
// its root is node 0 (one with an inverted box when there are no triangles).
struct DeviceForest {
  cl::Buffer triangles;  // GnTriangle, as the caller gave them
  cl::Buffer nodes;      // GnNode
  cl::Buffer order;      // uint32: the trees' leaf orders, as indices of triangles
  ForestTree global;
  std::vector<ForestTree> local;     // one per area
  std::vector<InfluenceArea> areas;  // in the caller's order, grown: what a top level is built over
  std::vector<GnArea> shared_areas;  // the same as kernels read them, with their trees' roots
  std::uint32_t triangle_count = 0;
  [[nodiscard]] std::uint32_t max_depth() const;
  // What of the buffers the local trees take: their nodes and orders. Triangles are not copied.
  [[nodiscard]] std::uint64_t local_bytes() const;
  [[nodiscard]] std::uint64_t bytes() const { return triangles.bytes + nodes.bytes + order.bytes; }
};

// Where the time of building a forest went; wall clock, milliseconds.
struct ForestReport {
  double total_ms = 0.0;
  double global_ms = 0.0;
  std::vector<double> members_ms;  // per area: collecting its triangles
  std::vector<double> local_ms;    // per area: building its tree
};

// Throws as build_device and to_shared; Error{kOutOfMemory} also where trees together have more than 2^32 - 2
// nodes or places.
[[nodiscard]] DeviceForest build_forest(const cl::Context& context, std::span<const Triangle> triangles,
                                        std::span<const LocalTree> local_trees,
                                        const BuildOptions& global_options = {},
                                        ForestReport* report = nullptr, const Progress& progress = {});

}  // namespace gnomon
