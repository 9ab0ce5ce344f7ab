// What tracers share: how a batch of rays is cut into launches and passes for one device. Not for what a
// launch does. Feeds trace_device.cpp and trace_areas.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gnomon/device/ray_sort.h"

namespace gnomon {

struct TracePlan {
  std::uint32_t work_group_size = 0;
  std::uint32_t rays_per_item = 1;
  std::uint32_t rays_at_once = 1;  // of an item's, taking steps by turns
  std::uint32_t stack_size = 0;    // nodes waiting, per ray
  std::uint32_t step_limit = 0;    // TraceOptions::step_limit, with the device's say; 0: one launch
  std::uint32_t most_passes = 0;
  std::uint32_t state_bytes = 0;  // of a ray between passes
  bool counters = false;
  bool wide = false;
  bool compact = false;
  bool portable = false;
  bool fast = false;          // Accuracy::kFast
  bool choose = false;        // packets where they pay, not wherever there are any
  bool framed = false;        // of a wide tree whose boxes stand in a frame
  std::uint32_t regions = 0;  // of a wide tree, with trees of their own
  [[nodiscard]] std::string program_options() const;
  [[nodiscard]] std::size_t batch_of(std::size_t rays) const;  // rays per launch
};

// `max_depth` of the deepest tree; `steps`: nodes and triangles a ray visits at worst.
// Throws Error{kInvalidArgument} for a work_group_size that is no power of two.
[[nodiscard]] TracePlan plan_trace(const cl::DeviceInfo& device, const TraceOptions& options,
                                   std::uint32_t max_depth, std::uint64_t steps, std::uint32_t state_bytes);

// The same for a wide tree of this depth, traced in one go. Throws also for a step limit.
[[nodiscard]] TracePlan plan_wide_trace(const cl::DeviceInfo& device, const TraceOptions& options,
                                        std::uint32_t depth);

// The same for a compact tree, one ray per work-item.
[[nodiscard]] TracePlan plan_compact_trace(const cl::DeviceInfo& device, const TraceOptions& options,
                                           const DeviceCompactBvh& tree);

// Where a batch traced in passes keeps its rays' state. Empty handles for one launch.
struct Passes {
  cl::Buffer states;
  cl::Buffer waiting;
  cl::Buffer entries;
  cl::Buffer paused;
};
[[nodiscard]] Passes make_passes(const cl::Context& context, const TracePlan& plan, std::size_t rays);

// One batch's buffers.
struct Launch {
  cl_mem rays;
  cl_mem answers;
  cl_mem counters;
  std::uint32_t count;
};

// Enqueues all passes a launch could need and returns the last one's event. Throws Error{kInvalidArgument}
// for a plan with counters: nobody would fetch them.
[[nodiscard]] cl::Handle<cl_event> enqueue_passes(const cl::Context& context, const TracePlan& plan,
                                                  const Launch& launch, std::span<const cl_event> wait_for,
                                                  const EnqueuePass& enqueue);

// Blocks until a launch's rays are traced; device milliseconds. Throws Error{kDevice} when the passes end
// before the rays do.
[[nodiscard]] double run_passes(const cl::Context& context, const TracePlan& plan, const Launch& launch,
                                const Passes& passes, const EnqueuePass& enqueue);

// Device milliseconds between an event's start and end; 0 without profiling.
[[nodiscard]] double event_ms(const cl::Handle<cl_event>& event);

// Traces rays from host memory in batches; device milliseconds. Fills `answers`, and `counters` when the plan
// says so. sort: each batch is traced in its order.
template <typename Answer, typename Counters>
double trace_in_batches(const cl::Context& context, const TracePlan& plan, std::span<const Ray> rays,
                        std::vector<Answer>& answers, std::vector<Counters>& counters,
                        const EnqueuePass& enqueue, const Progress& progress, RaySort* sort = nullptr) {
  answers.resize(rays.size());
  if (plan.counters) counters.resize(rays.size());
  const std::size_t batch = plan.batch_of(rays.size());
  const cl::Buffer ray_buffer = context.create_buffer("rays", batch * sizeof(Ray));
  const cl::Buffer answer_buffer = context.create_buffer("answers", batch * sizeof(Answer));
  const cl::Buffer counter_buffer =
      context.create_buffer("counters", plan.counters ? batch * sizeof(Counters) : 0);
  const Passes passes = make_passes(context, plan, batch);
  double ms = 0.0;
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    report(progress, "trace", static_cast<double>(first) / static_cast<double>(rays.size()));
    const std::size_t count = std::min(batch, rays.size() - first);
    context.upload_values<Ray>(ray_buffer, rays.subspan(first, count));
    const Launch launch{ray_buffer.mem.get(), answer_buffer.mem.get(), counter_buffer.mem.get(),
                        static_cast<std::uint32_t>(count)};
    const auto trace = [&](const Launch& l) { return run_passes(context, plan, l, passes, enqueue); };
    ms += sort != nullptr ? sort->run(launch, sizeof(Answer), plan.counters, trace) : trace(launch);
    context.download(answer_buffer, std::as_writable_bytes(std::span(answers).subspan(first, count)));
    if (plan.counters)
      context.download(counter_buffer, std::as_writable_bytes(std::span(counters).subspan(first, count)));
  }
  return ms;
}

}  // namespace gnomon
