// The OpenCL device tests run on: GNOMON_DEVICE or the default choice. Having none is a failure, never a
// skip.
#pragma once

#include <cstdlib>

#include "gnomon/cl/context.h"

namespace gnomon::test {

inline cl::DeviceInfo chosen_device() {
  const char* choice = std::getenv("GNOMON_DEVICE");
  return cl::choose_device(cl::list_devices(), choice == nullptr ? "" : choice);
}

// One context for the whole program: kernels compile once.
inline const cl::Context& context() {
  static const cl::Context shared(chosen_device());
  return shared;
}

}  // namespace gnomon::test
