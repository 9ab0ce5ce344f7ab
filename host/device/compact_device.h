// Making a tree compact on the device (gnomon/shared/compact_layout.h), from its wide form. Not for tracing
// it. Feeds trace_device.h, benches.
#pragma once

#include <cstdint>

#include "gnomon/device/collapse_device.h"
#include "gnomon/tree/compact.h"

namespace gnomon {

// A compact tree in device memory: GnCompactNode, and the words that leaves are packed in.
struct DeviceCompactBvh {
  cl::Buffer nodes;
  cl::Buffer leaves;
  std::uint32_t triangle_count = 0;
  std::uint32_t node_count = 0;
  std::uint32_t word_count = 0;  // of leaves, with the one behind
  std::uint32_t depth = 0;
  // Of all that traversal reads.
  [[nodiscard]] std::uint64_t bytes() const {
    return node_count * sizeof(CompactNode) + word_count * sizeof(std::uint32_t);
  }
};

// The bytes depend on the tree alone. The wide tree is only read, and may go. Throws Error: kInvalidArgument
// (a leaf of more than GN_MAX_COMPACT_LEAF triangles; a device that ends the loops this takes), kOutOfMemory,
// kDevice.
[[nodiscard]] DeviceCompactBvh compact_device(const cl::Context& context, const DeviceWideBvh& tree,
                                              BuildReport* report = nullptr);

// Copies a compact tree to the host.
[[nodiscard]] CompactBvh download_compact(const cl::Context& context, const DeviceCompactBvh& tree);

}  // namespace gnomon
