// Improving a tree on the device by moving subtrees to where they cost less: what optimise_reference does
// (gnomon/tree/optimise.h), the same bytes. Not for trees whose triangles moved (refit_device.h). Feeds the
// best builder.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/device/build_device.h"
#include "gnomon/tree/optimise.h"

namespace gnomon {

// A new tree; the one given, which is numbered as builders number, stays as it is. Its bytes depend on that
// tree and the options alone. Stages and times are added to `report`. Throws Error: kInvalidArgument
// (options; a tree deeper than 128; a device that ends the loops this takes), kOutOfMemory, kDevice.
[[nodiscard]] DeviceBvh optimise_device(const cl::Context& context, const DeviceBvh& tree,
                                        const OptimiseOptions& options = {}, BuildReport* report = nullptr);

// Buffers beside the tree it makes, for one of so many nodes. All are scratch.
[[nodiscard]] std::vector<BufferNeed> optimise_memory(std::uint64_t nodes);

// Throws Error{kInvalidArgument} where the device ends the loops that a tree of so many nodes takes.
void heed_optimise_limit(const cl::DeviceInfo& device, std::uint64_t nodes);

}  // namespace gnomon
