#include "gnomon/device/trace_device.h"

#include <algorithm>
#include <bit>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"

namespace gnomon {

namespace {

// Rays per launch: large enough to fill any device, small enough for its buffers and for prompt cancelling.
constexpr std::size_t kBatch = 1U << 20U;
// The same where every ray keeps a stack in memory.
constexpr std::size_t kBatchInPasses = 1U << 15U;
// Turns of loops that one step may cost the up to 16 rays a device's vector unit traces side by side.
constexpr std::uint32_t kTurnsPerStep = 64;

// The stack a traversal needs: every level leaves at most one node waiting. A few sizes only, so that trees
// share compiled programs.
std::uint32_t stack_size_for(std::uint32_t max_depth) {
  return (max_depth + 1 + 31) / 32 * 32;
}

std::uint32_t step_limit_for(const cl::DeviceInfo& device, std::uint32_t wanted) {
  if (device.loop_limit == 0) return wanted;
  const std::uint32_t most = std::max(1U, device.loop_limit / kTurnsPerStep);
  return wanted == 0 ? most : std::min(wanted, most);
}

double event_ms(const cl::Handle<cl_event>& event) {
  cl_ulong start = 0;
  cl_ulong end = 0;
  if (clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr) !=
          CL_SUCCESS ||
      clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr) !=
          CL_SUCCESS) {
    return 0.0;
  }
  return static_cast<double>(end - start) * 1e-6;
}

}  // namespace

Tracer::Tracer(const cl::Context& context, const DeviceBvh& tree, const TraceOptions& options)
    : context_(context), tree_(tree), options_(options) {
  if (!std::has_single_bit(options.work_group_size)) {
    throw Error(ErrorCode::kInvalidArgument, "trace work_group_size must be a power of two");
  }
  const auto widest = std::bit_floor(context.device().max_work_group);
  options_.work_group_size =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(options.work_group_size, widest));
  stack_size_ = stack_size_for(tree.max_depth);
  step_limit_ = step_limit_for(context.device(), options.step_limit);
  const std::string program = "-DGN_STACK_SIZE=" + std::to_string(stack_size_) +
                              " -DGN_COUNTERS=" + (options.counters ? "1" : "0") +
                              " -DGN_STEP_LIMIT=" + std::to_string(step_limit_);
  closest_ = context.programs().kernel({"trace.cl"}, program, "trace_closest");
  any_ = context.programs().kernel({"trace.cl"}, program, "trace_any");
  invalid_ = context.create_buffer("invalid_rays", sizeof(std::uint32_t));
  no_counters_ = context.create_buffer("no_counters", sizeof(GnRayCounters));
  context.fill(invalid_, 0);
}

// One batch: what to run over which buffers.
struct Tracer::Launch {
  const cl::Handle<cl_kernel>& kernel;
  cl_mem rays;
  cl_mem out;
  cl_mem counters;
  std::uint32_t count;
};

// Where a batch traced in passes keeps its rays' state.
struct Tracer::Passes {
  cl::Buffer walks;
  cl::Buffer waiting;
  cl::Buffer entries;
  cl::Buffer paused;
};

Tracer::Passes Tracer::make_passes(std::size_t rays) const {
  if (step_limit_ == 0) return {};
  return {context_.create_buffer("walks", rays * sizeof(GnWalk)),
          context_.create_buffer("waiting_nodes", rays * stack_size_ * sizeof(std::uint32_t)),
          context_.create_buffer("waiting_entries", rays * stack_size_ * sizeof(float)),
          context_.create_buffer("paused_rays", sizeof(std::uint32_t))};
}

// A ray visits every node and every triangle once at worst, and a pass ends within one leaf of its limit.
std::uint32_t Tracer::most_passes() const {
  return (tree_.node_count + tree_.triangle_count) / step_limit_ + 1;
}

cl::Handle<cl_event> Tracer::enqueue(const Launch& launch, std::span<const cl_event> wait_for) const {
  cl::set_arguments(launch.kernel.get(), tree_.nodes, tree_.leaf_triangles, launch.rays, launch.out, invalid_,
                    launch.counters, launch.count);
  const std::size_t local = options_.work_group_size;
  const std::size_t global = (std::max(launch.count, 1U) + local - 1) / local * local;
  return cl::enqueue(context_.queue(), launch.kernel.get(), global, local, wait_for);
}

cl::Handle<cl_event> Tracer::enqueue_pass(const Launch& launch, const Passes& passes, std::uint32_t pass,
                                          std::span<const cl_event> wait_for) const {
  cl::set_arguments_from(launch.kernel.get(), 7, passes.walks, passes.waiting, passes.entries, passes.paused,
                         pass);
  return enqueue(launch, wait_for);
}

// Blocks until the batch is traced; device milliseconds.
double Tracer::run(const Launch& launch, const Passes& passes) const {
  if (step_limit_ == 0) {
    const auto event = enqueue(launch, {});
    cl::wait(event);
    return event_ms(event);
  }
  double ms = 0.0;
  for (std::uint32_t pass = 0; pass < most_passes(); ++pass) {
    context_.fill(passes.paused, 0);
    const auto event = enqueue_pass(launch, passes, pass, {});
    cl::wait(event);
    ms += event_ms(event);
    if (context_.download_values<std::uint32_t>(passes.paused, 1).front() == 0) return ms;
  }
  throw Error(ErrorCode::kDevice,
              context_.device().name + " ended the loops of a traversal by itself; use another device");
}

cl::Handle<cl_event> Tracer::enqueue_only(const Launch& launch, std::span<const cl_event> wait_for) const {
  if (options_.counters) throw Error(ErrorCode::kInvalidArgument, "a counting tracer cannot only enqueue");
  if (step_limit_ == 0) return enqueue(launch, wait_for);
  // The driver keeps the buffers alive until the commands that use them are done.
  const Passes passes = make_passes(launch.count);
  auto event = enqueue_pass(launch, passes, 0, wait_for);
  for (std::uint32_t pass = 1; pass < most_passes(); ++pass) event = enqueue_pass(launch, passes, pass, {});
  return event;
}

cl::Handle<cl_event> Tracer::enqueue_closest(cl_mem rays, cl_mem hits, std::uint32_t count,
                                             std::span<const cl_event> wait_for) const {
  return enqueue_only({closest_, rays, hits, no_counters_.mem.get(), count}, wait_for);
}

cl::Handle<cl_event> Tracer::enqueue_any(cl_mem rays, cl_mem occluded, std::uint32_t count,
                                         std::span<const cl_event> wait_for) const {
  return enqueue_only({any_, rays, occluded, no_counters_.mem.get(), count}, wait_for);
}

template <typename Answer>
void Tracer::trace_all(const cl::Handle<cl_kernel>& kernel, std::span<const Ray> rays,
                       std::vector<Answer>& answers, TraceResult& result, const Progress& progress) const {
  answers.resize(rays.size());
  if (options_.counters) result.counters.resize(rays.size());
  const std::size_t batch =
      std::clamp<std::size_t>(rays.size(), 1, step_limit_ == 0 ? kBatch : kBatchInPasses);
  const cl::Buffer ray_buffer = context_.create_buffer("rays", batch * sizeof(Ray));
  const cl::Buffer answer_buffer = context_.create_buffer("answers", batch * sizeof(Answer));
  const cl::Buffer counter_buffer =
      context_.create_buffer("counters", options_.counters ? batch * sizeof(GnRayCounters) : 0);
  const Passes passes = make_passes(batch);
  const std::uint64_t invalid_before = invalid_rays();
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    report(progress, "trace", static_cast<double>(first) / static_cast<double>(rays.size()));
    const std::size_t count = std::min(batch, rays.size() - first);
    context_.upload_values<Ray>(ray_buffer, rays.subspan(first, count));
    result.kernel_ms += run({kernel, ray_buffer.mem.get(), answer_buffer.mem.get(), counter_buffer.mem.get(),
                             static_cast<std::uint32_t>(count)},
                            passes);
    context_.download(answer_buffer, std::as_writable_bytes(std::span(answers).subspan(first, count)));
    if (options_.counters) {
      context_.download(counter_buffer,
                        std::as_writable_bytes(std::span(result.counters).subspan(first, count)));
    }
  }
  result.invalid_rays = invalid_rays() - invalid_before;
}

TraceResult Tracer::closest(std::span<const Ray> rays, const Progress& progress) const {
  TraceResult result;
  trace_all(closest_, rays, result.hits, result, progress);
  return result;
}

TraceResult Tracer::any(std::span<const Ray> rays, const Progress& progress) const {
  TraceResult result;
  trace_all(any_, rays, result.occluded, result, progress);
  return result;
}

std::uint64_t Tracer::invalid_rays() const {
  return context_.download_values<std::uint32_t>(invalid_, 1).front();
}

}  // namespace gnomon
