#include "gnomon/cl/launch.h"

#include <algorithm>

namespace gnomon::cl {

std::vector<std::pair<std::string, double>> StageTimes::milliseconds() const {
  std::vector<std::pair<std::string, double>> out;
  for (const auto& [stage, event] : events_) {
    wait(event);
    cl_ulong start = 0;
    cl_ulong end = 0;
    if (clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) !=
            CL_SUCCESS ||
        clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr) !=
            CL_SUCCESS) {
      continue;
    }
    const std::string name = stage;
    auto place = std::find_if(out.begin(), out.end(), [&](const auto& entry) { return entry.first == name; });
    if (place == out.end()) place = out.insert(out.end(), {name, 0.0});
    place->second += static_cast<double>(end - start) * 1e-6;
  }
  return out;
}

Handle<cl_event> enqueue(cl_command_queue queue, cl_kernel kernel, std::size_t global, std::size_t local,
                         std::span<const cl_event> wait_for) {
  cl_event event = nullptr;
  check(clEnqueueNDRangeKernel(queue, kernel, 1, nullptr, &global, local == 0 ? nullptr : &local,
                               static_cast<cl_uint>(wait_for.size()),
                               wait_for.empty() ? nullptr : wait_for.data(), &event),
        "clEnqueueNDRangeKernel");
  return Handle<cl_event>(event);
}

void wait(const Handle<cl_event>& event) {
  const cl_event raw = event.get();
  check(clWaitForEvents(1, &raw), "clWaitForEvents");
}

}  // namespace gnomon::cl
