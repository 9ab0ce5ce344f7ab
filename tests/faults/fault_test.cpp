// Every OpenCL call that building, collapsing and tracing make, made to fail once: the caller gets an error,
// or the right answer where the call could be done without; nothing leaks, and the next run is as good as
// new.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "faults/fault_layer.h"
#include "gnomon/device/refit_device.h"
#include "gnomon/device/trace_areas.h"
#include "support/device.h"
#include "support/shapes.h"

using namespace gnomon;

namespace {

// Whatever a run gives, as bytes to compare.
using Answer = std::string;

template <typename T>
void add(Answer& answer, const std::vector<T>& values) {
  answer.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// What may fail without an error reaching the caller: times, what the kernels' cache can do without, another
// way to get memory, releases, and drivers and devices that do not answer while others do.
bool can_be_done_without(const std::string& call) {
  static const std::set<std::string> calls{
      "clGetEventProfilingInfo", "clGetProgramInfo", "clCreateProgramWithBinary",        "clBuildProgram",
      "clGetProgramBuildInfo",   "clCreateBuffer",   "clSetMemObjectDestructorCallback", "clGetPlatformIDs",
      "clGetDeviceIDs"};
  return calls.contains(call) || call.starts_with("clRelease");
}

// Calls by what came of failing them.
struct Outcomes {
  std::map<std::string, int> errors;
  std::map<std::string, int> unharmed;
};

// Runs with the first call failing, the second, and so on until a run makes no more calls. `least`: so many
// at least.
Outcomes fail_each(const std::function<Answer()>& run, std::uint64_t least) {
  const Answer expected = run();
  const fault_layer::Live before = fault_layer::live();
  Outcomes outcomes;
  for (std::uint64_t nth = 1;; ++nth) {
    std::string error;
    Answer answer;
    fault_layer::arm(nth);
    try {
      answer = run();
    } catch (const Error& caught) {
      error = caught.what();
      REQUIRE_FALSE(error.empty());
    }
    const std::string failed = fault_layer::failed();
    fault_layer::arm(0);
    CAPTURE(nth, failed, error);
    REQUIRE(fault_layer::live() == before);
    if (failed.empty()) {
      REQUIRE(error.empty());
      REQUIRE(answer == expected);
      REQUIRE(nth > least);
      break;
    }
    if (error.empty()) {
      REQUIRE(can_be_done_without(failed));
      REQUIRE(answer == expected);
    }
    (error.empty() ? outcomes.unharmed : outcomes.errors)[failed] += 1;
  }
  REQUIRE(run() == expected);
  REQUIRE(fault_layer::live() == before);
  return outcomes;
}

const cl::Context& shared() {
  return test::context();
}

// Small, but large enough for several levels of large nodes and for memory in large pages.
const std::vector<GnTriangle>& triangles() {
  static const std::vector<GnTriangle> made = test::soup(400, 201, 1.0F);
  return made;
}

BuildOptions in_levels() {
  BuildOptions options;
  options.subtree_size = 64;
  options.chunk_size = 64;
  return options;
}

Answer trace_all(const cl::Context& context, const Tracer& tracer) {
  static_cast<void>(context);
  const std::vector<GnRay> rays = test::random_rays(100, 202);
  Answer answer;
  add(answer, tracer.closest(rays).hits);
  add(answer, tracer.any(rays).occluded);
  return answer;
}

}  // namespace

TEST_CASE("the layer counts what is alive and fails the call it is told to") {
  static_cast<void>(shared());
  const fault_layer::Live before = fault_layer::live();
  {
    const cl::Buffer buffer = shared().create_buffer("test", 100);
    fault_layer::Live with = fault_layer::live();
    REQUIRE(with[2] == before[2] + 1);
    fault_layer::arm(2);
    static_cast<void>(shared().create_buffer("fine", 100));  // the release of this one fails
    REQUIRE(fault_layer::failed() == "clReleaseMemObject");
    fault_layer::arm(1);
    REQUIRE_THROWS_WITH(shared().create_buffer("broken", 100),
                        Catch::Contains("clCreateBuffer") && Catch::Contains("broken"));
    fault_layer::arm(0);
  }
  REQUIRE(fault_layer::live() == before);
}

TEST_CASE("devices, a context of one's own and its first kernel") {
  const Outcomes outcomes = fail_each(
      [] {
        const cl::Context context(test::chosen_device());
        return context.device().name + std::to_string(context.device().loop_limit);
      },
      30);
  for (const char* call :
       {"clGetDeviceInfo", "clCreateContext", "clCreateCommandQueue", "clCreateKernel",
        "clEnqueueNDRangeKernel", "clWaitForEvents", "clEnqueueMapBuffer", "clSetKernelArg"}) {
    CAPTURE(call);
    REQUIRE(outcomes.errors.contains(call));
  }
}

TEST_CASE("a program taken from a cache") {
  std::string folder = (std::filesystem::temp_directory_path() / "gnomon-test-XXXXXX").string();
  REQUIRE(mkdtemp(folder.data()) != nullptr);
  cl::ContextOptions options;
  options.cache_folder = folder;
  const Outcomes outcomes = fail_each(
      [&] {
        const cl::Context context(shared().context(), shared().device().device, shared().queue(), options);
        return context.device().name;
      },
      20);
  std::filesystem::remove_all(folder);
  // What cannot be loaded is compiled; what cannot be compiled is an error, cached or not.
  REQUIRE(outcomes.unharmed.contains("clCreateProgramWithBinary"));
  REQUIRE(outcomes.unharmed.contains("clBuildProgram"));
}

TEST_CASE("a context that is the caller's is given back as it was") {
  const cl::DeviceInfo device = test::chosen_device();
  const Outcomes outcomes = fail_each(
      [&] {
        const cl::Context adopted(shared().context(), device.device, shared().queue());
        return adopted.device().name;
      },
      20);
  REQUIRE(outcomes.errors.contains("clRetainContext"));
  REQUIRE(outcomes.errors.contains("clRetainCommandQueue"));
}

TEST_CASE("a program that is compiled, without a cache") {
  cl::ContextOptions options;
  options.use_cache = false;
  const Outcomes outcomes = fail_each(
      [&] {
        const cl::Context context(shared().context(), shared().device().device, shared().queue(), options);
        return context.device().name;
      },
      20);
  REQUIRE(outcomes.errors.contains("clBuildProgram"));
  REQUIRE(outcomes.errors.contains("clCreateProgramWithSource"));
}

TEST_CASE("a build in levels") {
  const Outcomes outcomes = fail_each(
      [] {
        BuildReport report;
        const DeviceBvh tree = build_device(shared(), triangles(), in_levels(), &report);
        return tree_hash(download_bvh(shared(), tree));
      },
      150);
  for (const char* call : {"clCreateBuffer", "clCreateKernel", "clSetKernelArg", "clEnqueueNDRangeKernel",
                           "clEnqueueMapBuffer", "clEnqueueUnmapMemObject", "clEnqueueFillBuffer"}) {
    CAPTURE(call);
    REQUIRE(outcomes.errors.contains(call));
  }
}

TEST_CASE("a fast build, and a best one with parts of triangles and subtrees that move") {
  std::vector<GnTriangle> some = test::soup(150, 205, 0.3F);
  const std::vector<GnTriangle> large = test::soup(20, 206, 5.0F);
  some.insert(some.end(), large.begin(), large.end());
  for (const Builder builder : {Builder::kFast, Builder::kBest}) {
    BuildOptions options;
    options.builder = builder;
    const Outcomes outcomes = fail_each(
        [&] { return tree_hash(download_bvh(shared(), build_device(shared(), some, options))); }, 60);
    CAPTURE(to_string(builder));
    for (const char* call : {"clCreateBuffer", "clCreateKernel", "clSetKernelArg", "clEnqueueNDRangeKernel",
                             "clEnqueueMapBuffer"}) {
      CAPTURE(call);
      REQUIRE(outcomes.errors.contains(call));
    }
  }
}

TEST_CASE("buffers in large pages") {
  const std::vector<std::uint32_t> words(1U << 20U, 7U);
  const Outcomes outcomes = fail_each(
      [&] {
        const cl::Buffer buffer = shared().create_buffer("large", words.size() * sizeof(std::uint32_t));
        shared().upload_values<std::uint32_t>(buffer, words);
        shared().fill(buffer, 9);
        Answer answer;
        add(answer, shared().download_values<std::uint32_t>(buffer, 100));
        return answer;
      },
      5);
  REQUIRE(outcomes.errors.contains("clEnqueueFillBuffer"));
}

TEST_CASE("tracing by the binary tree, in one go and in passes") {
  const DeviceBvh tree = build_device(shared(), triangles());
  for (const std::uint32_t step_limit : {0U, 50U}) {
    TraceOptions options;
    options.flavour = TraceFlavour::kThread;
    options.step_limit = step_limit;
    const Outcomes outcomes =
        fail_each([&] { return trace_all(shared(), Tracer(shared(), tree, options)); }, 30);
    REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
  }
}

TEST_CASE("packets, their rays sorted, through a tree that is refitted first") {
  if (shared().device().loop_limit != 0) return;  // such devices have none
  DeviceBvh tree = build_device(shared(), triangles());
  TraceOptions options;
  options.flavour = TraceFlavour::kPacket;
  options.sort_rays = true;
  const Outcomes outcomes = fail_each(
      [&] {
        refit_device(shared(), tree, triangles());
        return trace_all(shared(), Tracer(shared(), tree, options));
      },
      60);
  REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
  REQUIRE(outcomes.errors.contains("clCreateBuffer"));
}

TEST_CASE("making a tree compact and tracing it") {
  if (shared().device().loop_limit != 0) return;  // such devices have none
  const DeviceBvh tree = build_device(shared(), triangles());
  const Outcomes outcomes = fail_each(
      [&] {
        const DeviceWideBvh wide = collapse_device(shared(), tree);
        const DeviceCompactBvh compact = compact_device(shared(), wide);
        return trace_all(shared(), Tracer(shared(), compact));
      },
      60);
  REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
}

TEST_CASE("collapsing and tracing by the wide tree") {
  if (shared().device().loop_limit != 0) return;  // such devices have none
  const DeviceBvh tree = build_device(shared(), triangles());
  TraceOptions options;
  options.flavour = TraceFlavour::kWide;
  const Outcomes outcomes = fail_each(
      [&] {
        const DeviceWideBvh wide = collapse_device(shared(), tree);
        return tree_hash(download_wide(shared(), wide)) +
               trace_all(shared(), Tracer(shared(), tree, options));
      },
      80);
  REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
  REQUIRE(outcomes.errors.contains("clCreateBuffer"));
}

TEST_CASE("enqueueing on the caller's buffers") {
  const DeviceBvh tree = build_device(shared(), triangles());
  const Tracer tracer(shared(), tree);
  const std::vector<GnRay> rays = test::random_rays(64, 203);
  const Outcomes outcomes = fail_each(
      [&] {
        const cl::Buffer in = shared().create_buffer("in", rays.size() * sizeof(GnRay));
        const cl::Buffer out = shared().create_buffer("out", rays.size() * sizeof(GnHit));
        shared().upload_values<GnRay>(in, rays);
        const auto event = tracer.enqueue_closest(in.mem.get(), out.mem.get(), 64);
        Answer answer;
        add(answer, shared().download_values<GnHit>(out, rays.size()));
        return answer;
      },
      8);
  REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
}

TEST_CASE("a forest, its top level and its tracer") {
  const std::vector<LocalTree> trees{{InfluenceArea::omni({5, 5, 5}, 4.0)},
                                     {InfluenceArea::omni({90, 5, 5}, 1.0)}};
  const Outcomes outcomes = fail_each(
      [&] {
        const DeviceForest forest = build_forest(shared(), triangles(), trees);
        const DeviceTopLevel top =
            upload_top_level(shared(), build_top_level(forest.areas, AreaLookup::kBvh), forest.shared_areas);
        const ForestTracer tracer(shared(), forest, top);
        const std::vector<GnRay> rays = test::random_rays(100, 204);
        Answer answer;
        add(answer, tracer.closest(rays).hits);
        add(answer, tracer.any(rays).occluded);
        add(answer, AreaFinder(shared(), top).choose(rays).areas);
        return answer;
      },
      200);
  REQUIRE(outcomes.errors.contains("clEnqueueNDRangeKernel"));
}
