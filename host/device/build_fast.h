// The fast builder on a device (host/notes/fast-builder.md): what build_device does for Builder::kFast. Feeds
// build_device.cpp alone.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/device/build_device.h"

namespace gnomon {

// As build_memory. The tree over the clusters is counted with as many clusters as there may be.
[[nodiscard]] std::vector<BufferNeed> fast_memory(const cl::DeviceInfo& device, std::uint64_t count,
                                                  const BuildOptions& options);

// As build_device, of one triangle or more. Stages and scratch bytes go to `out`.
[[nodiscard]] DeviceBvh build_fast(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                                   const BuildOptions& options, BuildReport* out, const Progress& progress);

}  // namespace gnomon
