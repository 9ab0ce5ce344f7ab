// Life in somebody else's OpenCL program: their context, queue and buffers; and two devices at once.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <thread>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "support/device.h"
#include "support/shapes.h"

namespace cl = gnomon::cl;

namespace {

// An OpenCL program as a user would have it, with no help from gnomon.
struct Foreign {
  cl::DeviceInfo device = gnomon::test::chosen_device();
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  Foreign() {
    cl_int status = CL_SUCCESS;
    context = clCreateContext(nullptr, 1, &device.device, nullptr, nullptr, &status);
    REQUIRE(status == CL_SUCCESS);
    queue = clCreateCommandQueue(context, device.device, 0, &status);
    REQUIRE(status == CL_SUCCESS);
  }
  ~Foreign() {
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
  }
  [[nodiscard]] cl_uint context_references() const {
    cl_uint count = 0;
    clGetContextInfo(context, CL_CONTEXT_REFERENCE_COUNT, sizeof count, &count, nullptr);
    return count;
  }
  [[nodiscard]] cl_uint queue_references() const {
    cl_uint count = 0;
    clGetCommandQueueInfo(queue, CL_QUEUE_REFERENCE_COUNT, sizeof count, &count, nullptr);
    return count;
  }
  [[nodiscard]] cl_mem buffer(std::size_t bytes, const void* data) const {
    cl_int status = CL_SUCCESS;
    const cl_mem_flags copy = data != nullptr ? CL_MEM_COPY_HOST_PTR : 0;
    cl_mem mem = clCreateBuffer(context, CL_MEM_READ_WRITE | copy, bytes, const_cast<void*>(data), &status);
    REQUIRE(status == CL_SUCCESS);
    return mem;
  }
};

}  // namespace

TEST_CASE("builds and traces on the caller's context, queue and buffers, and leaves them as they were",
          "[serial][portable]") {
  const Foreign foreign;
  const cl_uint contexts = foreign.context_references();
  const cl_uint queues = foreign.queue_references();
  const auto triangles = gnomon::test::soup(700, 81);
  const auto rays = gnomon::test::random_rays(256, 82);
  cl_mem triangle_buffer = foreign.buffer(triangles.size() * sizeof(GnTriangle), triangles.data());
  cl_mem ray_buffer = foreign.buffer(rays.size() * sizeof(GnRay), rays.data());
  cl_mem hit_buffer = foreign.buffer(rays.size() * sizeof(GnHit), nullptr);
  {
    const cl::Context context(foreign.context, foreign.device.device, foreign.queue);
    const auto tree =
        gnomon::build_device(context, triangle_buffer, static_cast<std::uint32_t>(triangles.size()));
    REQUIRE(gnomon::tree_hash(gnomon::download_bvh(context, tree)) ==
            gnomon::tree_hash(gnomon::build_reference(triangles)));
    const gnomon::Tracer tracer(context, tree);
    const auto expected = tracer.closest(rays).hits;
    const auto event =
        tracer.enqueue_closest(ray_buffer, hit_buffer, static_cast<std::uint32_t>(rays.size()));
    cl::wait(event);
    std::vector<GnHit> hits(rays.size());
    REQUIRE(clEnqueueReadBuffer(foreign.queue, hit_buffer, CL_TRUE, 0, hits.size() * sizeof(GnHit),
                                hits.data(), 0, nullptr, nullptr) == CL_SUCCESS);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      CAPTURE(i);
      REQUIRE(hits[i].primitive == expected[i].primitive);
      REQUIRE(hits[i].t == expected[i].t);
    }
    gnomon::TraceOptions in_passes;
    in_passes.step_limit = 20;
    const gnomon::Tracer stepper(context, tree, in_passes);
    cl::wait(stepper.enqueue_closest(ray_buffer, hit_buffer, static_cast<std::uint32_t>(rays.size())));
    std::vector<GnHit> same(rays.size());
    REQUIRE(clEnqueueReadBuffer(foreign.queue, hit_buffer, CL_TRUE, 0, same.size() * sizeof(GnHit),
                                same.data(), 0, nullptr, nullptr) == CL_SUCCESS);
    REQUIRE(std::memcmp(same.data(), hits.data(), hits.size() * sizeof(GnHit)) == 0);
  }
  for (cl_mem mem : {triangle_buffer, ray_buffer, hit_buffer}) REQUIRE(clReleaseMemObject(mem) == CL_SUCCESS);
  // Drivers let go of finished commands in threads of their own: what we hold is known once they have.
  const auto held = [&] {
    return foreign.context_references() != contexts || foreign.queue_references() != queues;
  };
  for (int i = 0; i < 200 && held(); ++i) {
    clFinish(foreign.queue);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  REQUIRE(foreign.context_references() == contexts);
  REQUIRE(foreign.queue_references() == queues);
}

TEST_CASE("enqueueing a trace does not wait for what the caller has in the queue before it") {
  const Foreign foreign;
  const cl::Context context(foreign.context, foreign.device.device, foreign.queue);
  const auto triangles = gnomon::test::soup(100, 83);
  const auto rays = gnomon::test::random_rays(64, 84);
  const auto tree = gnomon::build_device(context, triangles);
  const gnomon::Tracer tracer(context, tree);
  cl_mem ray_buffer = foreign.buffer(rays.size() * sizeof(GnRay), rays.data());
  cl_mem out = foreign.buffer(rays.size() * sizeof(std::uint32_t), nullptr);
  // Nothing in the queue can run until the gate opens: a hidden clFinish would hang here for ever.
  cl_int status = CL_SUCCESS;
  cl_event gate = clCreateUserEvent(foreign.context, &status);
  REQUIRE(status == CL_SUCCESS);
  const auto event =
      tracer.enqueue_any(ray_buffer, out, static_cast<std::uint32_t>(rays.size()), std::span(&gate, 1));
  cl_int state = CL_COMPLETE;
  clGetEventInfo(event.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state, &state, nullptr);
  REQUIRE(state > CL_COMPLETE);
  REQUIRE(clSetUserEventStatus(gate, CL_COMPLETE) == CL_SUCCESS);
  cl::wait(event);
  clReleaseEvent(gate);
  for (cl_mem mem : {ray_buffer, out}) clReleaseMemObject(mem);
}

TEST_CASE("a triangle buffer that is too small and an out-of-order queue are refused") {
  const Foreign foreign;
  const cl::Context context(foreign.context, foreign.device.device, foreign.queue);
  cl_mem small = foreign.buffer(100, nullptr);
  REQUIRE_THROWS_WITH(gnomon::build_device(context, small, 3), Catch::Contains("36"));
  clReleaseMemObject(small);
  cl_int status = CL_SUCCESS;
  cl_command_queue unordered = clCreateCommandQueue(foreign.context, foreign.device.device,
                                                    CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, &status);
  if (status == CL_SUCCESS) {
    REQUIRE_THROWS_WITH(cl::Context(foreign.context, foreign.device.device, unordered),
                        Catch::Contains("in-order"));
    clReleaseCommandQueue(unordered);
  }
}

TEST_CASE("every device in the list builds the same tree") {
  const auto triangles = gnomon::test::soup(900, 85);
  const std::string expected = gnomon::tree_hash(gnomon::build_reference(triangles));
  const auto devices = cl::list_devices();
  REQUIRE_FALSE(devices.empty());
  for (const auto& device : devices) {
    if (!device.available) continue;
    CAPTURE(device.name, device.index);
    const cl::Context context(device);
    REQUIRE(gnomon::tree_hash(gnomon::download_bvh(context, gnomon::build_device(context, triangles))) ==
            expected);
  }
}

TEST_CASE("accesses past a buffer's end are refused") {
  const auto& context = gnomon::test::context();
  const cl::Buffer buffer = context.create_buffer("eight bytes", 8);
  std::vector<std::uint32_t> three(3);
  REQUIRE_THROWS_WITH(context.upload_values<std::uint32_t>(buffer, three), Catch::Contains("eight bytes"));
  REQUIRE_THROWS_WITH(context.download_values<std::uint32_t>(buffer, 1, 2), Catch::Contains("eight bytes"));
}
