// Linked into memcheck_test alone, in front of the OpenCL library: keeps from oclgrind 21.10 what it gets
// wrong, so that its log holds faults of ours and nothing else. Changes no result.
#include <cstring>
#include <vector>

#include "gnomon/cl/opencl.h"

extern "C" {

// The record of which words were written survives a buffer and serves the next one with its number, whatever
// its size: numbers are never given back.
cl_int clReleaseMemObject(cl_mem) {
  return CL_SUCCESS;
}

// Released after main, as the tests' one context is, they make it crash: its own tables are gone by then.
cl_int clReleaseCommandQueue(cl_command_queue) {
  return CL_SUCCESS;
}
cl_int clReleaseContext(cl_context) {
  return CL_SUCCESS;
}
cl_int clReleaseProgram(cl_program) {
  return CL_SUCCESS;
}

// Words that were filled count as never written: fills become writes.
cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_size,
                           size_t offset, size_t size, cl_uint wait_count, const cl_event* wait_for,
                           cl_event* event) {
  std::vector<unsigned char> bytes(size);
  for (size_t i = 0; i < size; i += pattern_size) std::memcpy(bytes.data() + i, pattern, pattern_size);
  return clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, size, bytes.data(), wait_count, wait_for,
                              event);
}

}  // extern "C"
