#include "device_choice.h"

namespace gnomon::app {

cl::Context open_device(const DeviceOptions& options) {
  const auto devices = cl::list_devices();
  cl::ContextOptions context;
  context.use_cache = !options.no_cache;
  return cl::Context(cl::choose_device(devices, options.choice), context);
}

const char* kind_of(const cl::DeviceInfo& device) {
  return device.is_gpu ? "gpu" : device.is_cpu ? "cpu" : "other";
}

}  // namespace gnomon::app
