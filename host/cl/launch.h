// Typed kernel launches and stage times. Feeds host/device.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/cl/check.h"
#include "gnomon/cl/context.h"

namespace gnomon::cl {

// Collects the events of launches under a stage's name and adds up their device times.
class StageTimes {
 public:
  void add(const char* stage, Handle<cl_event> event) { events_.emplace_back(stage, std::move(event)); }
  // Milliseconds per stage, in order of first appearance. Waits for the events; stages of queues without
  // profiling are missing.
  [[nodiscard]] std::vector<std::pair<std::string, double>> milliseconds() const;

 private:
  std::vector<std::pair<const char*, Handle<cl_event>>> events_;
};

namespace detail {
inline void set_argument(cl_kernel kernel, cl_uint index, cl_mem value) {
  check(clSetKernelArg(kernel, index, sizeof value, static_cast<const void*>(&value)), "clSetKernelArg");
}
inline void set_argument(cl_kernel kernel, cl_uint index, const Buffer& value) {
  set_argument(kernel, index, value.mem.get());
}
inline void set_argument(cl_kernel kernel, cl_uint index, std::uint32_t value) {
  check(clSetKernelArg(kernel, index, sizeof value, &value), "clSetKernelArg");
}
inline void set_argument(cl_kernel kernel, cl_uint index, float value) {
  check(clSetKernelArg(kernel, index, sizeof value, &value), "clSetKernelArg");
}
}  // namespace detail

// Sets arguments from place `index` on, in order: buffers, cl_mem, 32-bit numbers.
template <typename... Arguments>
void set_arguments_from(cl_kernel kernel, cl_uint index, const Arguments&... arguments) {
  (detail::set_argument(kernel, index++, arguments), ...);
}

// Sets all arguments.
template <typename... Arguments>
void set_arguments(cl_kernel kernel, const Arguments&... arguments) {
  set_arguments_from(kernel, 0, arguments...);
}

// Enqueues a one-dimensional launch; local 0 lets the driver choose. Never blocks.
[[nodiscard]] Handle<cl_event> enqueue(cl_command_queue queue, cl_kernel kernel, std::size_t global,
                                       std::size_t local, std::span<const cl_event> wait_for = {});

// Blocks until an event is complete. Throws Error{kDevice} when the command failed.
void wait(const Handle<cl_event>& event);

}  // namespace gnomon::cl
