#include "device_builder.h"

#include <algorithm>

#include "gnomon/device/build_device.h"
#include "gnomon/device/optimise_device.h"

namespace gnomon::app {

PlanBuilder device_builder(const cl::Context& context) {
  PlanBuilder out;
  // Triangles go to the device again with each tree: plans make a handful.
  out.build = [&context](std::span<const Triangle> triangles, const BuildOptions& options) {
    return download_bvh(context, build_device(context, triangles, options));
  };
  out.optimise = [&context](const Bvh& bvh, const OptimiseOptions& options) {
    if (bvh.nodes.empty()) return bvh;
    // Reinsertion reads boxes and leaf order; corners it only carries along.
    std::size_t most = 0;
    for (const std::uint32_t primitive : bvh.primitives) most = std::max<std::size_t>(most, primitive + 1);
    const std::vector<Triangle> corners(most);
    return download_bvh(context, optimise_device(context, upload_bvh(context, bvh, corners), options));
  };
  return out;
}

}  // namespace gnomon::app
