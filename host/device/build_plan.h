// How a build is cut into work for one device: flavour, sizes, buffers. Changes speed, never the tree.
// Feeds build_device.cpp alone.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/device/build_device.h"

namespace gnomon {

struct BuildPlan {
  std::uint32_t count = 0;  // triangles
  std::uint32_t bins = 0;
  bool ordered_axes = false;    // by a policy; no other way than all three is compiled in otherwise
  bool published_bins = false;  // the published builder's keys and planes
  std::uint32_t kind = GN_MEASURE_LINEAR;  // of measure; no other but linear ones is compiled in
  std::uint32_t work_group_size = 0;       // 1: serial flavour
  std::uint32_t item_group_size = 0;       // of kernels with one work-item per element
  std::uint32_t subtree_size = 0;          // nodes up to this many triangles go to one work-group
  std::uint32_t chunk_size = 0;
  std::uint32_t compact_chunk = 0;  // leaf positions one work-item ranks
  std::uint32_t max_tasks = 0;      // large nodes in one level
  std::uint32_t max_chunks = 0;     // chunks in one level
  [[nodiscard]] std::string program_options() const;
  // Scratch first, then what stays.
  [[nodiscard]] std::vector<BufferNeed> buffers() const;
  [[nodiscard]] std::uint64_t bytes_of(const std::string& name) const;
};

// Fills in what the options leave to the device. Throws as options.check().
[[nodiscard]] BuildPlan plan_build(const cl::DeviceInfo& device, std::uint64_t count,
                                   const BuildOptions& options);

}  // namespace gnomon
