// Tracing batches of rays through a forest: each ray asks the local tree of an area it starts in, and the
// global tree for what that cannot answer. Not for one tree (trace_device.h). Feeds the plan, benches and
// tests.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gnomon/device/find_areas.h"
#include "gnomon/device/forest.h"
#include "gnomon/device/trace_device.h"

namespace gnomon {

// What a local tree's answer is worth.
enum class FallbackRule : std::uint32_t {
  // A hit up to where the ray leaves the region is final, and so is a miss of a ray that ends before; else
  // the global tree is asked from there on. The same answers as the global tree alone.
  kExit = 0,
  // The thesis' rule: any hit of a local tree is final; after misses in all affine areas' trees the global
  // tree is asked from the start. Wrong where a triangle that sticks out of the region hides another.
  kPublished = 1,
};

struct ForestTraceOptions {
  TraceOptions trace{};
  FallbackRule rule = FallbackRule::kExit;
};

// Answers of a batch. One of hits and occluded is filled, by the call made.
struct ForestTraceResult {
  std::vector<Hit> hits;                 // closest(): one per ray
  std::vector<std::uint32_t> occluded;   // any(): 1 or 0 per ray
  std::vector<GnAreaCounters> counters;  // when asked for
  std::uint64_t invalid_rays = 0;        // as TraceResult: they miss
  double kernel_ms = 0.0;                // device time; 0 without profiling
};

// Holds the kernels for one forest and one top level over its areas, which must outlive it, as the context.
class ForestTracer {
 public:
  // Throws Error: kDevice, kInvalidArgument (the top level is of another number of areas).
  ForestTracer(const cl::Context& context, const DeviceForest& forest, const DeviceTopLevel& top_level,
               const ForestTraceOptions& options = {});
  ForestTracer(ForestTracer&&) noexcept;
  ~ForestTracer();

  // Blocking. Throws Error: kOutOfMemory, kDevice, kCancelled.
  [[nodiscard]] ForestTraceResult closest(std::span<const Ray> rays, const Progress& progress = {}) const;
  [[nodiscard]] ForestTraceResult any(std::span<const Ray> rays, const Progress& progress = {}) const;

  // Enqueue on the context's queue and return, as Tracer's calls of these names do: rays holds `count` GnRay;
  // hits receives `count` GnHit, occluded `count` uint32. Throws Error: kInvalidArgument for a counting
  // tracer.
  [[nodiscard]] cl::Handle<cl_event> enqueue_closest(cl_mem rays, cl_mem hits, std::uint32_t count,
                                                     std::span<const cl_event> wait_for = {}) const;
  [[nodiscard]] cl::Handle<cl_event> enqueue_any(cl_mem rays, cl_mem occluded, std::uint32_t count,
                                                 std::span<const cl_event> wait_for = {}) const;
  // Rays so far that were not traceable, over all calls. Blocks until earlier launches are done.
  [[nodiscard]] std::uint64_t invalid_rays() const;

 private:
  [[nodiscard]] cl::Handle<cl_event> enqueue(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                             const Passes& passes, std::uint32_t pass,
                                             std::span<const cl_event> wait_for) const;
  [[nodiscard]] EnqueuePass enqueuer(const cl::Handle<cl_kernel>& kernel) const;
  template <typename Answer>
  [[nodiscard]] ForestTraceResult trace_all(const cl::Handle<cl_kernel>& kernel, std::span<const Ray> rays,
                                            std::vector<Answer> ForestTraceResult::*answers,
                                            const Progress& progress) const;

  const cl::Context& context_;
  const DeviceForest& forest_;
  const DeviceTopLevel& top_level_;
  std::unique_ptr<TracePlan> plan_;
  cl::Handle<cl_kernel> closest_;
  cl::Handle<cl_kernel> any_;
  cl::Buffer invalid_;
  cl::Buffer no_counters_;
};

}  // namespace gnomon
