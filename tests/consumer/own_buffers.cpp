// Gnomon inside an OpenCL program: its context, its queue, its buffers. Everything but the build only
// enqueues.
#include <gnomon/gnomon.h>

#include <cstdio>

int main() {
  const auto devices = gnomon::cl::list_devices();
  if (devices.empty()) return 1;
  cl_device_id device = devices.front().device;  // any cl_device_id
  cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
  cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);
  GnTriangle triangles[] = {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}, {{0, 0, 2}, {4, 0, 2}, {0, 4, 2}}};
  GnRay rays[] = {{{1, 1, 0}, 0, {0, 0, 1}, 100}, {{1, 1, 3}, 0, {0, 0, -1}, 100}};
  GnHit hits[2] = {};
  const auto buffer = [&](cl_mem_flags flags, std::size_t bytes, void* host) {
    return clCreateBuffer(context, flags, bytes, host, nullptr);
  };
  cl_mem triangle_buffer = buffer(CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof triangles, triangles);
  cl_mem ray_buffer = buffer(CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof rays, rays);
  cl_mem hit_buffer = buffer(CL_MEM_WRITE_ONLY, sizeof hits, nullptr);
  try {
    const gnomon::cl::Context ours(context, device, queue);  // retained, never destroyed, never finished
    const gnomon::DeviceBvh tree = gnomon::build_device(ours, triangle_buffer, 2);
    const gnomon::Tracer tracer(ours, tree);
    const auto traced = tracer.enqueue_closest(ray_buffer, hit_buffer, 2);
    const cl_event event = traced.get();
    clEnqueueReadBuffer(queue, hit_buffer, CL_TRUE, 0, sizeof hits, hits, 1, &event, nullptr);
  } catch (const gnomon::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  for (cl_mem mem : {triangle_buffer, ray_buffer, hit_buffer}) clReleaseMemObject(mem);
  clReleaseCommandQueue(queue);
  clReleaseContext(context);
  std::printf("hit triangles %u and %u at %g\n", hits[0].primitive, hits[1].primitive, hits[1].t);
  return hits[0].primitive == 0 && hits[1].primitive == 1 && hits[0].t == 1 ? 0 : 1;
}
