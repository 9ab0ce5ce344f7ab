// Making a tree compact on the device (gnomon/shared/compact_layout.h), from its wide form. Not for tracing
// it. Feeds trace_device.h, benches.
#pragma once

#include <cstdint>

#include "gnomon/device/collapse_device.h"
#include "gnomon/tree/compact.h"

namespace gnomon {

// How the device works, never what it makes.
struct CompactOptions {
  std::uint32_t key_bits =
      32;  // of the keys that corners are sorted by to find equal ones; 1..32, fewer collide
  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// A compact tree in device memory: GnCompactNode, then GnIndexedTriangle and GnVertex, or GnPlainTriangle
// alone.
struct DeviceCompactBvh {
  cl::Buffer nodes;
  cl::Buffer triangles;
  cl::Buffer vertices;
  std::uint32_t triangle_count = 0;
  std::uint32_t node_count = 0;
  std::uint32_t vertex_count = 0;  // 0 where corners are not shared
  std::uint32_t depth = 0;
  bool shares_corners = true;
  // Of all that traversal reads.
  [[nodiscard]] std::uint64_t bytes() const;
};

// The bytes depend on the tree alone. The wide tree is only read, and may go. Throws Error: kInvalidArgument
// (options; a leaf of more than GN_MAX_COMPACT_LEAF triangles; a device that ends the loops this takes),
// kOutOfMemory, kDevice.
[[nodiscard]] DeviceCompactBvh compact_device(const cl::Context& context, const DeviceWideBvh& tree,
                                              const CompactOptions& options = {},
                                              BuildReport* report = nullptr);

// Copies a compact tree to the host.
[[nodiscard]] CompactBvh download_compact(const cl::Context& context, const DeviceCompactBvh& tree);

}  // namespace gnomon
