#include "gnomon/cl/context.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gnomon/base/error.h"
#include "gnomon/cl/check.h"
#include "gnomon/cl/large_pages.h"
#include "gnomon/cl/loop_limit.h"
#include "gnomon/cl/program.h"

namespace gnomon::cl {

namespace {

constexpr std::uint64_t kDefaultSpareBytes = std::uint64_t{512} << 20U;

// A mapping of part of a buffer, undone when it goes.
class Mapping {
 public:
  Mapping(cl_command_queue queue, const Buffer& buffer, cl_map_flags flags, std::size_t offset,
          std::size_t bytes)
      : queue_(queue), buffer_(buffer) {
    cl_int status = CL_SUCCESS;
    pointer_ = clEnqueueMapBuffer(queue, buffer.mem.get(), CL_TRUE, flags, offset, bytes, 0, nullptr, nullptr,
                                  &status);
    check(status, "clEnqueueMapBuffer", buffer.name);
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() {
    if (pointer_ != nullptr) static_cast<void>(unmap());
  }
  // Undoes it now. Throws Error{kDevice} where that fails: what was written may never arrive.
  void undo() { check(unmap(), "clEnqueueUnmapMemObject", buffer_.name); }
  [[nodiscard]] void* pointer() const { return pointer_; }

 private:
  cl_int unmap() {
    void* const pointer = std::exchange(pointer_, nullptr);
    return clEnqueueUnmapMemObject(queue_, buffer_.mem.get(), pointer, 0, nullptr, nullptr);
  }

  cl_command_queue queue_;
  const Buffer& buffer_;
  void* pointer_ = nullptr;
};

void require_range(const Buffer& buffer, std::size_t offset, std::size_t bytes) {
  if (offset > buffer.bytes || bytes > buffer.bytes - offset) {
    throw Error(ErrorCode::kInvalidArgument, "access past the end of buffer " + buffer.name);
  }
}

}  // namespace

std::optional<std::string> why_not_fit(const DeviceInfo& device, const std::string& name,
                                       std::uint64_t bytes) {
  const std::uint64_t limit = std::min(device.max_allocation, device.global_memory);
  if (bytes <= limit) return std::nullopt;
  return "buffer " + name + " needs " + std::to_string(bytes) + " bytes, but " + device.name +
         " allows at most " + std::to_string(limit) + " in one buffer; use a smaller scene or another device";
}

Context::Context(const DeviceInfo& device, const ContextOptions& options) : device_(device) {
  cl_int status = CL_SUCCESS;
  const cl_context_properties properties[] = {CL_CONTEXT_PLATFORM,
                                              reinterpret_cast<cl_context_properties>(device.platform), 0};
  context_ = Handle(clCreateContext(properties, 1, &device_.device, nullptr, nullptr, &status));
  check(status, "clCreateContext", device.name);
  const cl_command_queue_properties queue_flags = options.profiling ? CL_QUEUE_PROFILING_ENABLE : 0;
  queue_ = Handle(clCreateCommandQueue(context_.get(), device_.device, queue_flags, &status));
  check(status, "clCreateCommandQueue", device.name);
  finish_setup(options);
}

Context::Context(cl_context context, cl_device_id device, cl_command_queue queue,
                 const ContextOptions& options)
    : device_(describe_device(device)),
      context_(Handle<cl_context>::share(context)),
      queue_(Handle<cl_command_queue>::share(queue)) {
  finish_setup(options);
}

Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

void Context::finish_setup(const ContextOptions& options) {
  cl_command_queue_properties flags = 0;
  check(clGetCommandQueueInfo(queue_.get(), CL_QUEUE_PROPERTIES, sizeof flags, &flags, nullptr),
        "clGetCommandQueueInfo");
  if ((flags & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0) {
    throw Error(ErrorCode::kInvalidArgument,
                "the command queue is out-of-order; gnomon needs an in-order queue");
  }
  if (!device_.little_endian) {
    throw Error(ErrorCode::kDevice, device_.name + " is big-endian, which gnomon does not support");
  }
  profiles_ = (flags & CL_QUEUE_PROFILING_ENABLE) != 0;
  const std::uint64_t default_spare = std::min(kDefaultSpareBytes, device_.global_memory / 8);
  large_pages_ = std::make_unique<LargePages>(options.spare_bytes.value_or(default_spare));
  programs_ = std::make_unique<ProgramStore>(context_.get(), device_, options);
  device_.loop_limit = measure_loop_limit(*this);
}

Buffer Context::create_buffer(const std::string& name, std::size_t bytes) const {
  const std::size_t size = std::max<std::size_t>(bytes, 1);
  if (const auto reason = why_not_fit(device_, name, size)) throw Error(ErrorCode::kOutOfMemory, *reason);
  if (device_.is_cpu && device_.unified_memory && fills_large_pages(size)) {
    Handle<cl_mem> memory = large_pages_->create(context_.get(), size);
    if (memory.get() != nullptr) return {std::move(memory), name, size};
  }
  cl_int status = CL_SUCCESS;
  // Host-visible where memory is shared anyway: mapping then costs nothing.
  const cl_mem_flags flags = CL_MEM_READ_WRITE | (device_.unified_memory ? CL_MEM_ALLOC_HOST_PTR : 0);
  Buffer buffer{Handle(clCreateBuffer(context_.get(), flags, size, nullptr, &status)), name, size};
  check(status, "clCreateBuffer", "buffer " + name + ", " + std::to_string(size) + " bytes");
  return buffer;
}

Buffer Context::share(const std::string& name, std::span<const std::byte> bytes) const {
  if (bytes.empty()) throw Error(ErrorCode::kInvalidArgument, "nothing to share as buffer " + name);
  if (!device_.is_cpu || !device_.unified_memory) {
    Buffer copy = create_buffer(name, bytes.size());
    upload(copy, bytes);
    return copy;
  }
  if (const auto reason = why_not_fit(device_, name, bytes.size()))
    throw Error(ErrorCode::kOutOfMemory, *reason);
  cl_int status = CL_SUCCESS;
  // Read-only for kernels, and mapped by nobody for writing.
  void* const memory = const_cast<std::byte*>(bytes.data());
  Buffer buffer{Handle(clCreateBuffer(context_.get(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes.size(),
                                      memory, &status)),
                name, bytes.size()};
  check(status, "clCreateBuffer", "buffer " + name + ", " + std::to_string(bytes.size()) + " bytes");
  return buffer;
}

void Context::wait_for_enqueued() const {
  cl_event marker = nullptr;
  check(clEnqueueMarkerWithWaitList(queue_.get(), 0, nullptr, &marker), "clEnqueueMarkerWithWaitList");
  const Handle<cl_event> reached(marker);
  check(clWaitForEvents(1, &marker), "clWaitForEvents");
}

void Context::upload(const Buffer& buffer, std::span<const std::byte> bytes, std::size_t offset) const {
  if (bytes.empty()) return;
  require_range(buffer, offset, bytes.size());
  Mapping mapping(queue_.get(), buffer, CL_MAP_WRITE_INVALIDATE_REGION, offset, bytes.size());
  std::memcpy(mapping.pointer(), bytes.data(), bytes.size());
  mapping.undo();
}

void Context::download(const Buffer& buffer, std::span<std::byte> bytes, std::size_t offset) const {
  if (bytes.empty()) return;
  require_range(buffer, offset, bytes.size());
  Mapping mapping(queue_.get(), buffer, CL_MAP_READ, offset, bytes.size());
  std::memcpy(bytes.data(), mapping.pointer(), bytes.size());
  mapping.undo();
}

void Context::fill(const Buffer& buffer, std::uint32_t word) const {
  const std::size_t bytes = buffer.bytes / sizeof word * sizeof word;
  if (bytes == 0) return;
  check(
      clEnqueueFillBuffer(queue_.get(), buffer.mem.get(), &word, sizeof word, 0, bytes, 0, nullptr, nullptr),
      "clEnqueueFillBuffer", buffer.name);
}

}  // namespace gnomon::cl
