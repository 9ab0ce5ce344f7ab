// A capability no query tells: how many turns a device lets loops make. Feeds context.cpp alone.
#pragma once

#include <cstdint>

#include "gnomon/cl/context.h"

namespace gnomon::cl {

// DeviceInfo::loop_limit, by running a long loop. Throws Error{kDevice}.
[[nodiscard]] std::uint32_t measure_loop_limit(const Context& context);

}  // namespace gnomon::cl
