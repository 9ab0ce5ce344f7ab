#include "faults/fault_layer.h"

#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

namespace fault_layer {
namespace {

enum Kind { kContext, kQueue, kBuffer, kProgram, kKernel, kEvent };

std::atomic<std::uint64_t> made{0};
std::atomic<std::uint64_t> wanted{0};
std::atomic<const char*> victim{nullptr};
std::array<std::atomic<std::int64_t>, 6> alive{};

// Counts a call; true: it is the one to fail.
bool fails(const char* name) {
  if (++made != wanted) return false;
  victim = name;
  return true;
}

template <typename Function>
Function* next(const char* name) {
  // A program that has all of the loader's functions itself is linked without the loader.
  static void* const loader = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
  void* found = dlsym(RTLD_NEXT, name);
  if (found == nullptr && loader != nullptr) found = dlsym(loader, name);
  if (found == nullptr) {
    std::fprintf(stderr, "fault layer: no %s behind it\n", name);
    std::abort();
  }
  return reinterpret_cast<Function*>(found);
}

// What a preloaded layer is told by the environment, and tells.
struct Preloaded {
  Preloaded() {
    if (const char* at = std::getenv("GNOMON_FAULT_AT")) arm(std::strtoull(at, nullptr, 10));
  }
  ~Preloaded() {
    const char* const file = std::getenv("GNOMON_FAULT_REPORT");
    std::FILE* const out = file == nullptr ? nullptr : std::fopen(file, "w");
    if (out == nullptr) return;
    std::fprintf(out, "%s", victim.load() == nullptr ? "none" : victim.load());
    for (const auto& count : alive) std::fprintf(out, " %lld", static_cast<long long>(count.load()));
    std::fclose(out);
  }
} const preloaded;

}  // namespace

void arm(std::uint64_t nth) {
  made = 0;
  victim = nullptr;
  wanted = nth;
}

std::string failed() {
  const char* const name = victim;
  return name == nullptr ? "" : name;
}

std::uint64_t calls() {
  return made;
}

Live live() {
  Live now{};
  for (std::size_t i = 0; i < now.size(); ++i) now[i] = alive[i];
  return now;
}

}  // namespace fault_layer

using namespace fault_layer;

// A call that answers with a status; `effect` follows success.
#define STATUS_CALL(name, parameters, arguments, effect)       \
  extern "C" CL_API_ENTRY cl_int CL_API_CALL name parameters { \
    static const auto forward = next<decltype(name)>(#name);   \
    if (fails(#name)) return CL_OUT_OF_RESOURCES;              \
    const cl_int answer = forward arguments;                   \
    if (answer == CL_SUCCESS) effect;                          \
    return answer;                                             \
  }

// A call that answers with an object, and with a status through `status`.
#define CREATE_CALL(type, name, parameters, arguments, effect) \
  extern "C" CL_API_ENTRY type CL_API_CALL name parameters {   \
    static const auto forward = next<decltype(name)>(#name);   \
    if (fails(#name)) {                                        \
      if (status != nullptr) *status = CL_OUT_OF_RESOURCES;    \
      return nullptr;                                          \
    }                                                          \
    type answer = forward arguments;                           \
    if (answer != nullptr) effect;                             \
    return answer;                                             \
  }

#define COUNTED_OBJECT(type, kind, retain, release)                 \
  STATUS_CALL(retain, (type object), (object), ++alive[kind])       \
  extern "C" CL_API_ENTRY cl_int CL_API_CALL release(type object) { \
    static const auto forward = next<decltype(release)>(#release);  \
    const bool as_told = fails(#release);                           \
    const cl_int answer = forward(object);                          \
    if (answer == CL_SUCCESS) --alive[kind];                        \
    return as_told ? CL_OUT_OF_RESOURCES : answer;                  \
  }

#define COUNT_EVENT(event) alive[kEvent] += (event) != nullptr && *(event) != nullptr ? 1 : 0

COUNTED_OBJECT(cl_context, kContext, clRetainContext, clReleaseContext)
COUNTED_OBJECT(cl_command_queue, kQueue, clRetainCommandQueue, clReleaseCommandQueue)
COUNTED_OBJECT(cl_mem, kBuffer, clRetainMemObject, clReleaseMemObject)
COUNTED_OBJECT(cl_program, kProgram, clRetainProgram, clReleaseProgram)
COUNTED_OBJECT(cl_kernel, kKernel, clRetainKernel, clReleaseKernel)
COUNTED_OBJECT(cl_event, kEvent, clRetainEvent, clReleaseEvent)

CREATE_CALL(cl_context, clCreateContext,
            (const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
             void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*), void* data, cl_int* status),
            (properties, count, devices, notify, data, status), ++alive[kContext])
CREATE_CALL(cl_command_queue, clCreateCommandQueue,
            (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int* status),
            (context, device, properties, status), ++alive[kQueue])
CREATE_CALL(cl_mem, clCreateBuffer,
            (cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status),
            (context, flags, size, host, status), ++alive[kBuffer])
CREATE_CALL(cl_program, clCreateProgramWithSource,
            (cl_context context, cl_uint count, const char** strings, const size_t* lengths, cl_int* status),
            (context, count, strings, lengths, status), ++alive[kProgram])
CREATE_CALL(cl_program, clCreateProgramWithBinary,
            (cl_context context, cl_uint count, const cl_device_id* devices, const size_t* lengths,
             const unsigned char** binaries, cl_int* each, cl_int* status),
            (context, count, devices, lengths, binaries, each, status), ++alive[kProgram])
CREATE_CALL(cl_kernel, clCreateKernel, (cl_program program, const char* name, cl_int* status),
            (program, name, status), ++alive[kKernel])
CREATE_CALL(void*, clEnqueueMapBuffer,
            (cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags, size_t offset,
             size_t size, cl_uint waits, const cl_event* wait_for, cl_event* event, cl_int* status),
            (queue, buffer, blocking, flags, offset, size, waits, wait_for, event, status),
            COUNT_EVENT(event))

STATUS_CALL(clEnqueueUnmapMemObject,
            (cl_command_queue queue, cl_mem buffer, void* pointer, cl_uint waits, const cl_event* wait_for,
             cl_event* event),
            (queue, buffer, pointer, waits, wait_for, event), COUNT_EVENT(event))
STATUS_CALL(clEnqueueFillBuffer,
            (cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_size, size_t offset,
             size_t size, cl_uint waits, const cl_event* wait_for, cl_event* event),
            (queue, buffer, pattern, pattern_size, offset, size, waits, wait_for, event), COUNT_EVENT(event))
STATUS_CALL(clEnqueueNDRangeKernel,
            (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
             const size_t* global, const size_t* local, cl_uint waits, const cl_event* wait_for,
             cl_event* event),
            (queue, kernel, dimensions, offset, global, local, waits, wait_for, event), COUNT_EVENT(event))
STATUS_CALL(clEnqueueMarkerWithWaitList,
            (cl_command_queue queue, cl_uint waits, const cl_event* wait_for, cl_event* event),
            (queue, waits, wait_for, event), COUNT_EVENT(event))
STATUS_CALL(clWaitForEvents, (cl_uint count, const cl_event* events), (count, events), {})
STATUS_CALL(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void* value),
            (kernel, index, size, value), {})
STATUS_CALL(clSetMemObjectDestructorCallback,
            (cl_mem buffer, void(CL_CALLBACK* notify)(cl_mem, void*), void* data), (buffer, notify, data), {})
STATUS_CALL(clBuildProgram,
            (cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
             void(CL_CALLBACK* notify)(cl_program, void*), void* data),
            (program, count, devices, options, notify, data), {})
STATUS_CALL(clGetPlatformIDs, (cl_uint count, cl_platform_id* platforms, cl_uint* found),
            (count, platforms, found), {})
STATUS_CALL(clGetDeviceIDs,
            (cl_platform_id platform, cl_device_type type, cl_uint count, cl_device_id* devices,
             cl_uint* found),
            (platform, type, count, devices, found), {})

// Calls that ask for facts all look alike.
#define INFO_CALL(name, type, what)                                                      \
  STATUS_CALL(name, (type object, what which, size_t size, void* value, size_t* needed), \
              (object, which, size, value, needed), {})
INFO_CALL(clGetPlatformInfo, cl_platform_id, cl_platform_info)
INFO_CALL(clGetDeviceInfo, cl_device_id, cl_device_info)
INFO_CALL(clGetCommandQueueInfo, cl_command_queue, cl_command_queue_info)
INFO_CALL(clGetMemObjectInfo, cl_mem, cl_mem_info)
INFO_CALL(clGetProgramInfo, cl_program, cl_program_info)
INFO_CALL(clGetEventProfilingInfo, cl_event, cl_profiling_info)
STATUS_CALL(clGetProgramBuildInfo,
            (cl_program program, cl_device_id device, cl_program_build_info which, size_t size, void* value,
             size_t* needed),
            (program, device, which, size, value, needed), {})
