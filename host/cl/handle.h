// Owning OpenCL objects: one word, move-only, released exactly once. Not for creating them. Feeds all of
// host/cl and host/device.
#pragma once

#include <utility>

#include "gnomon/cl/check.h"
#include "gnomon/cl/opencl.h"

namespace gnomon::cl {

template <typename T>
struct HandleTraits;

template <>
struct HandleTraits<cl_context> {
  static cl_int retain(cl_context object) { return clRetainContext(object); }
  static cl_int release(cl_context object) { return clReleaseContext(object); }
};
template <>
struct HandleTraits<cl_command_queue> {
  static cl_int retain(cl_command_queue object) { return clRetainCommandQueue(object); }
  static cl_int release(cl_command_queue object) { return clReleaseCommandQueue(object); }
};
template <>
struct HandleTraits<cl_mem> {
  static cl_int retain(cl_mem object) { return clRetainMemObject(object); }
  static cl_int release(cl_mem object) { return clReleaseMemObject(object); }
};
template <>
struct HandleTraits<cl_program> {
  static cl_int retain(cl_program object) { return clRetainProgram(object); }
  static cl_int release(cl_program object) { return clReleaseProgram(object); }
};
template <>
struct HandleTraits<cl_kernel> {
  static cl_int retain(cl_kernel object) { return clRetainKernel(object); }
  static cl_int release(cl_kernel object) { return clReleaseKernel(object); }
};
template <>
struct HandleTraits<cl_event> {
  static cl_int retain(cl_event object) { return clRetainEvent(object); }
  static cl_int release(cl_event object) { return clReleaseEvent(object); }
};

// Owns one reference. A failed release cannot be acted on and is ignored: destructors never throw.
template <typename T>
class Handle {
 public:
  Handle() = default;
  // Takes over the reference the caller holds.
  explicit Handle(T object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (object_ != nullptr) HandleTraits<T>::release(object_);
  }

  // Shares an object somebody else owns: adds a reference of our own. Throws Error{kDevice} where that fails:
  // without it our release would take the owner's.
  [[nodiscard]] static Handle share(T object) {
    if (object != nullptr) check(HandleTraits<T>::retain(object), "clRetain");
    return Handle(object);
  }

  [[nodiscard]] T get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  T object_ = nullptr;
};

}  // namespace gnomon::cl
