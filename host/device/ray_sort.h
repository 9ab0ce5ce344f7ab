// Tracing a batch in an order that keeps caches warm (gnomon/shared/ray_key.h, light_key.h), with answers in
// the caller's order. Not for the tracing itself. Feeds trace_device.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "gnomon/device/radix_sort.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/shared/build_layout.h"

namespace gnomon {

struct Launch;  // ray_batches.h

class RaySort {
 public:
  // bounds: of the scene, whose cells order rays. lights: any-hit batches are ordered by these, if there are
  // any. Throws Error: kInvalidArgument for too many of them, kOutOfMemory, kDevice.
  RaySort(const cl::Context& context, const GnBounds& bounds, std::span<const RayLight> lights = {});

  // Both enqueue only, on the context's in-order queue: begin returns what is to be traced; end, once that is
  // enqueued, brings its answers to where `launch` wants them, and returns the event of the last of them.
  // answer_bytes: of a ray, 16, or 4 of any hit. Throws Error: kOutOfMemory, kDevice; kInvalidArgument for a
  // device that ends the loops so many rays take.
  [[nodiscard]] Launch begin(const Launch& launch, std::size_t answer_bytes, bool counters,
                             std::span<const cl_event> wait_for, cl::StageTimes& times);
  [[nodiscard]] cl::Handle<cl_event> end(const Launch& launch, std::size_t answer_bytes, bool counters,
                                         cl::StageTimes& times);

  // Sorts, traces, brings back; blocks. Device milliseconds of it all, `trace` returning its own.
  [[nodiscard]] double run(const Launch& launch, std::size_t answer_bytes, bool counters,
                           const std::function<double(const Launch&)>& trace);

 private:
  struct Kernel {
    const char* name;
    const char* options = "";
    std::uint32_t rays_per_item = 1;
  };
  template <typename... Arguments>
  cl::Handle<cl_event> launch_items(const Kernel& which, std::uint32_t count,
                                    std::span<const cl_event> wait_for, const Arguments&... arguments) const;
  [[nodiscard]] SortPlan plan_for(std::uint32_t count) const;
  [[nodiscard]] bool by_light(std::size_t answer_bytes) const;

  void find_keys(const SortPlan& plan, const Launch& launch, bool by_light,
                 std::span<const cl_event> wait_for, cl::StageTimes& times) const;
  void make_room(const SortPlan& plan, std::size_t answer_bytes, bool counters);

  const cl::Context& context_;
  GnBounds bounds_;
  std::uint32_t light_count_;
  cl::Buffer lights_;
  // Kept from batch to batch: new memory costs as much as the sort. Grows, never shrinks.
  cl::Buffer keys_, spare_keys_, digits_, rays_, answers_, counters_;
};

}  // namespace gnomon
