#include "gnomon/cl/large_pages.h"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gnomon::cl {
namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20U;

void CL_CALLBACK give_back(cl_mem /*buffer*/, void* memory) {
  std::free(memory);
}

}  // namespace

bool fills_large_pages(std::size_t bytes) {
  return bytes >= kLargePage;
}

Handle<cl_mem> create_in_large_pages(cl_context context, std::size_t bytes) {
  const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  void* memory = std::aligned_alloc(kLargePage, whole);
  if (memory == nullptr) return {};
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // Advice only: where the system has no large pages to give, small ones do.
  static_cast<void>(madvise(memory, whole, MADV_HUGEPAGE));
#endif
  cl_int status = CL_SUCCESS;
  Handle<cl_mem> buffer(
      clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory, &status));
  if (status != CL_SUCCESS) {
    std::free(memory);
    return {};
  }
  if (clSetMemObjectDestructorCallback(buffer.get(), give_back, memory) != CL_SUCCESS) {
    buffer = {};
    std::free(memory);
  }
  return buffer;
}

}  // namespace gnomon::cl
