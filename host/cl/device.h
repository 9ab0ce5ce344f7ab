// Finding OpenCL devices, choosing one, and what each is able to do. Not for contexts or queues (context.h).
// Feeds the command line, context.h and every choice of kernel flavour.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gnomon/cl/opencl.h"

namespace gnomon::cl {

// One device and its probed capabilities. Sizes in bytes.
struct DeviceInfo {
  cl_platform_id platform = nullptr;
  cl_device_id device = nullptr;
  std::uint32_t index = 0;           // in the flat list
  std::uint32_t platform_index = 0;  // among platforms, as `clinfo -l` counts them
  std::uint32_t device_index = 0;    // within its platform
  std::string name;
  std::string vendor;
  std::string platform_name;
  std::string version;  // of OpenCL, as the device states it
  std::string driver;
  bool is_cpu = false;
  bool is_gpu = false;
  bool available = false;  // it and its compiler
  std::uint32_t compute_units = 0;
  std::uint64_t global_memory = 0;
  std::uint64_t max_allocation = 0;
  std::uint64_t local_memory = 0;
  std::uint64_t max_work_group = 0;
  bool unified_memory = false;  // shares memory with the host: mapping is free
  bool fp64 = false;            // double precision: hit decisions are exact
  bool int64_atomics = false;
  bool little_endian = true;
  // The driver keeps on disk what it compiles, kernel by kernel as they are launched (PoCL).
  bool keeps_programs = false;
  // Turns all loops of one work-item may make together before the device ends them without a word (65535 on
  // Mesa's llvmpipe); 0: as many as they like. Measured when a Context is made, 0 before.
  std::uint32_t loop_limit = 0;
};

// Every device of every platform, in platform order. Platforms without devices are left out. Empty when there
// is none.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

// Probes a device we were given. Throws Error{kDevice}.
[[nodiscard]] DeviceInfo describe_device(cl_device_id device);

// The list as text, one line a device: "[0] 0:0 cpu NAME (PLATFORM)".
[[nodiscard]] std::string format_devices(const std::vector<DeviceInfo>& devices);

// Picks from the list. choice: "" (first GPU, else first CPU, else the first), an index "1",
// "platform:device" as in "0:0", "cpu", "gpu", or a part of the name or platform's name, case ignored;
// several matches: the first. Throws Error{kNoDevice} with the list in its message.
[[nodiscard]] const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices,
                                              std::string_view choice);

}  // namespace gnomon::cl
