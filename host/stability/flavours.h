// Every way to build and to trace that a device has: what stability runs go through. A new builder or flavour
// is added here, and nowhere else in this room. Feeds the catalogue and the soak.
#pragma once

#include <vector>

#include "gnomon/stability/cases.h"

namespace gnomon::stability {

[[nodiscard]] std::vector<Builder> builders();
[[nodiscard]] std::vector<Flavour> flavours_of(const cl::DeviceInfo& device);

}  // namespace gnomon::stability
