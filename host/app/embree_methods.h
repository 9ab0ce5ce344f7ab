// Embree as methods of a comparison, where it is installed. Feeds `compare`.
#pragma once

#include <string>
#include <vector>

#include "gnomon/compare/method.h"

namespace gnomon::app {

// Its default mode and ROBUST, on as many threads as the device has compute units; none for devices that are
// no CPU, and none in a program that was built without it. The scene must outlive them.
[[nodiscard]] std::vector<compare::Method> embree_methods(const cl::DeviceInfo& device, const Scene& scene);
// Why there are none; empty where there are.
[[nodiscard]] std::string why_no_embree();

}  // namespace gnomon::app
