// Collapsing a tree on the device into its wide form (gnomon/shared/wide_layout.h). Not for tracing it. Feeds
// trace_device.h, benches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/device/build_device.h"
#include "gnomon/tree/wide.h"

namespace gnomon {

// A wide tree in device memory: GnWideNode and leaves (gnomon/shared/wide_layout.h). All that its traversal
// needs.
struct DeviceWideBvh {
  cl::Buffer nodes;
  cl::Buffer leaves;
  std::uint32_t triangle_count = 0;
  std::uint32_t node_count = 0;
  std::uint32_t place_count = 0;  // of leaves
  std::uint32_t depth = 0;
  std::optional<BoxFrame> frame{};  // Bvh's
  std::vector<GnRegion> regions{};  // WideBvh's
  [[nodiscard]] std::uint64_t bytes() const { return nodes.bytes + leaves.bytes; }
};

// The bytes depend on the tree, the options and the keys alone (wide.h says what keys are). Throws Error:
// kInvalidArgument (options; keys; a leaf of more than GN_MAX_WIDE_LEAF triangles; a device that ends the
// loops this takes), kOutOfMemory, kDevice.
[[nodiscard]] DeviceWideBvh collapse_device(const cl::Context& context, const DeviceBvh& tree,
                                            const CollapseOptions& options = {},
                                            BuildReport* report = nullptr,
                                            std::span<const float> slot_keys = {},
                                            std::span<const float> weights = {});

// For so many places, with the slack that vectors read into.
[[nodiscard]] cl::Buffer leaf_buffer(const cl::Context& context, std::uint32_t places);

// Copies a wide tree to the host.
[[nodiscard]] WideBvh download_wide(const cl::Context& context, const DeviceWideBvh& tree);

}  // namespace gnomon
