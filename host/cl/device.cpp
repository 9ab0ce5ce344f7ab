#include "gnomon/cl/device.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "gnomon/base/error.h"
#include "gnomon/cl/check.h"

namespace gnomon::cl {

namespace {

template <typename T>
T number(cl_device_id device, cl_device_info what) {
  T value{};
  check(clGetDeviceInfo(device, what, sizeof value, &value, nullptr), "clGetDeviceInfo");
  return value;
}

std::string trimmed(std::string text) {
  while (!text.empty() &&
         (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back())) != 0)) {
    text.pop_back();
  }
  const auto start =
      std::find_if(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c) == 0; });
  return {start, text.end()};
}

std::string text(cl_device_id device, cl_device_info what) {
  std::size_t size = 0;
  check(clGetDeviceInfo(device, what, 0, nullptr, &size), "clGetDeviceInfo");
  std::string value(size, '\0');
  check(clGetDeviceInfo(device, what, size, value.data(), nullptr), "clGetDeviceInfo");
  return trimmed(value);
}

std::string platform_text(cl_platform_id platform, cl_platform_info what) {
  std::size_t size = 0;
  check(clGetPlatformInfo(platform, what, 0, nullptr, &size), "clGetPlatformInfo");
  std::string value(size, '\0');
  check(clGetPlatformInfo(platform, what, size, value.data(), nullptr), "clGetPlatformInfo");
  return trimmed(value);
}

std::string lowered(std::string_view value) {
  std::string out(value);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::optional<std::uint32_t> as_number(std::string_view value) {
  std::uint32_t out = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), out);
  if (error != std::errc{} || end != value.data() + value.size()) return std::nullopt;
  return out;
}

std::vector<cl_platform_id> list_platforms() {
  cl_uint count = 0;
  // A loader without any driver answers with CL_PLATFORM_NOT_FOUND_KHR: no platforms, not a fault.
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
  std::vector<cl_platform_id> platforms(count);
  check(clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");
  return platforms;
}

using Devices = std::vector<DeviceInfo>;

Devices::const_iterator find_choice(const Devices& devices, std::string_view choice) {
  const auto find = [&](auto predicate) { return std::find_if(devices.begin(), devices.end(), predicate); };
  const std::string wanted = lowered(choice);
  const auto is_gpu = [](const DeviceInfo& d) { return d.is_gpu && d.available; };
  const auto is_cpu = [](const DeviceInfo& d) { return d.is_cpu && d.available; };
  if (wanted.empty()) {
    if (const auto gpu = find(is_gpu); gpu != devices.end()) return gpu;
    if (const auto cpu = find(is_cpu); cpu != devices.end()) return cpu;
    return devices.begin();
  }
  if (wanted == "gpu") return find(is_gpu);
  if (wanted == "cpu") return find(is_cpu);
  if (const auto index = as_number(wanted))
    return find([&](const DeviceInfo& d) { return d.index == *index; });
  if (const auto colon = wanted.find(':'); colon != std::string::npos) {
    const auto platform = as_number(std::string_view(wanted).substr(0, colon));
    const auto device = as_number(std::string_view(wanted).substr(colon + 1));
    if (platform && device) {
      return find(
          [&](const DeviceInfo& d) { return d.platform_index == *platform && d.device_index == *device; });
    }
  }
  return find([&](const DeviceInfo& d) {
    return lowered(d.name).find(wanted) != std::string::npos ||
           lowered(d.platform_name).find(wanted) != std::string::npos;
  });
}

}  // namespace

DeviceInfo describe_device(cl_device_id device) {
  DeviceInfo info;
  info.device = device;
  info.platform = number<cl_platform_id>(device, CL_DEVICE_PLATFORM);
  info.name = text(device, CL_DEVICE_NAME);
  info.vendor = text(device, CL_DEVICE_VENDOR);
  info.platform_name = platform_text(info.platform, CL_PLATFORM_NAME);
  info.keeps_programs = info.platform_name == "Portable Computing Language";
  info.version = text(device, CL_DEVICE_VERSION);
  info.driver = text(device, CL_DRIVER_VERSION);
  const auto type = number<cl_device_type>(device, CL_DEVICE_TYPE);
  info.is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
  info.is_gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
  info.available = number<cl_bool>(device, CL_DEVICE_AVAILABLE) == CL_TRUE &&
                   number<cl_bool>(device, CL_DEVICE_COMPILER_AVAILABLE) == CL_TRUE;
  info.compute_units = number<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS);
  info.global_memory = number<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_allocation = number<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  info.local_memory = number<cl_ulong>(device, CL_DEVICE_LOCAL_MEM_SIZE);
  info.max_work_group = number<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE);
  info.unified_memory = number<cl_bool>(device, CL_DEVICE_HOST_UNIFIED_MEMORY) == CL_TRUE;
  info.little_endian = number<cl_bool>(device, CL_DEVICE_ENDIAN_LITTLE) == CL_TRUE;
  const std::string extensions = text(device, CL_DEVICE_EXTENSIONS);
  info.fp64 = extensions.find("cl_khr_fp64") != std::string::npos;
  info.int64_atomics = extensions.find("cl_khr_int64_base_atomics") != std::string::npos;
  return info;
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> out;
  std::uint32_t platform_index = 0;
  for (cl_platform_id platform : list_platforms()) {
    cl_uint count = 0;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) == CL_SUCCESS && count > 0) {
      std::vector<cl_device_id> devices(count);
      check(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr), "clGetDeviceIDs");
      for (cl_uint i = 0; i < count; ++i) {
        DeviceInfo info = describe_device(devices[i]);
        info.index = static_cast<std::uint32_t>(out.size());
        info.platform_index = platform_index;
        info.device_index = i;
        out.push_back(std::move(info));
      }
    }
    ++platform_index;
  }
  return out;
}

std::string format_devices(const std::vector<DeviceInfo>& devices) {
  std::string out;
  for (const DeviceInfo& d : devices) {
    const char* kind = d.is_gpu ? "gpu" : d.is_cpu ? "cpu" : "other";
    out += "  [" + std::to_string(d.index) + "] " + std::to_string(d.platform_index) + ":" +
           std::to_string(d.device_index) + " " + kind + "  " + d.name + " (" + d.platform_name + ")" +
           (d.available ? "" : " - not available") + "\n";
  }
  return out;
}

const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, std::string_view choice) {
  if (devices.empty()) {
    throw Error(
        ErrorCode::kNoDevice,
        "no OpenCL device found. Install a driver (on Debian: apt install pocl-opencl-icd runs everything on "
        "the CPU) and check with: clinfo -l");
  }
  const auto found = find_choice(devices, choice);
  if (found == devices.end()) {
    throw Error(ErrorCode::kNoDevice,
                "no OpenCL device matches \"" + std::string(choice) +
                    "\". Choose an index, platform:device, cpu, gpu or a part of the name:\n" +
                    format_devices(devices));
  }
  return *found;
}

}  // namespace gnomon::cl
