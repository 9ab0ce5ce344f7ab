// Opening the device a command line names. Feeds the subcommands that use one.
#pragma once

#include "gnomon/cl/context.h"
#include "options.h"

namespace gnomon::app {

// Throws Error{kNoDevice} with the list of devices, kDevice.
[[nodiscard]] cl::Context open_device(const DeviceOptions& options);

// "cpu", "gpu" or "other".
[[nodiscard]] const char* kind_of(const cl::DeviceInfo& device);

}  // namespace gnomon::app
