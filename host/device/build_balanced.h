// The balanced builder on a device: top down, binned over three axes. Feeds build_device.cpp, and
// build_best.cpp with parts of triangles instead of these.
#pragma once

#include <cstdint>

#include "gnomon/device/build_device.h"

namespace gnomon {

// As build_device. parts: empty, or `count` GnPrimitives whose boxes are sorted and whose indices name
// triangles, which may repeat; it is used up. Stages go to `out`.
[[nodiscard]] DeviceBvh build_balanced(const cl::Context& context, cl_mem triangles, std::uint32_t count,
                                       cl::Buffer parts, const BuildOptions& options, BuildReport* out,
                                       const Progress& progress);

}  // namespace gnomon
