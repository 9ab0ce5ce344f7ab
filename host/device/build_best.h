// The best builder on a device (host/notes/best-builder.md): what build_device does for Builder::kBest. Feeds
// build_device.cpp alone.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/device/build_device.h"

namespace gnomon {

// As build_memory, with as many parts as there may be.
[[nodiscard]] std::vector<BufferNeed> best_memory(const cl::DeviceInfo& device, std::uint64_t count,
                                                  const BuildOptions& options);

// As build_device, of one triangle or more. Stages and scratch bytes go to `out`.
[[nodiscard]] DeviceBvh build_best(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                                   const BuildOptions& options, BuildReport* out, const Progress& progress);

}  // namespace gnomon
