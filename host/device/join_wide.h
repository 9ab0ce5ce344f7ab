// Local trees behind a tree of all triangles, in the same buffers, so that rays that are within a region
// whole are traced through its tree. Not for the thread flavour's forests (forest.h). Feeds trace_device.h.
#pragma once

#include <span>

#include "gnomon/device/collapse_device.h"
#include "gnomon/tree/regions.h"

namespace gnomon {

// `all` with trees over the triangles that touch regions, one a region; their roots are filled in. The same
// bytes as join_reference. Throws as that and kOutOfMemory, kDevice.
[[nodiscard]] DeviceWideBvh join_wide(const cl::Context& context, const DeviceWideBvh& all,
                                      std::span<const DeviceWideBvh> local, std::span<const Region> regions);

// The wide form of a tree with its local ones, as plans keep them; ranks and weights as collapse_device has
// them. Throws as that and join_wide.
[[nodiscard]] DeviceWideBvh collapse_with_regions(const cl::Context& context, const DeviceBvh& all,
                                                  std::span<const Triangle> triangles,
                                                  std::span<const RegionTree> local,
                                                  std::span<const float> slot_keys = {},
                                                  std::span<const float> weights = {});

}  // namespace gnomon
