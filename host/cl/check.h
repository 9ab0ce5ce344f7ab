// OpenCL status codes as errors. Feeds all of host/cl and host/device.
#pragma once

#include <string>

#include "gnomon/base/error.h"
#include "gnomon/cl/opencl.h"

namespace gnomon::cl {

// "CL_OUT_OF_RESOURCES" for -5; "OpenCL error N" for codes we do not know.
[[nodiscard]] std::string status_name(cl_int status);

// Throws Error naming the call and the status unless it is CL_SUCCESS: kOutOfMemory for allocation failures,
// kDevice otherwise. `detail` is appended when not empty.
void check(cl_int status, const char* call, const std::string& detail = {});

}  // namespace gnomon::cl
