#include "gnomon/device/ray_batches.h"

#include <bit>

#include "gnomon/cl/launch.h"

namespace gnomon {
namespace {

// Rays per launch: large enough to fill any device, small enough for its buffers and for prompt cancelling.
constexpr std::size_t kBatch = 1U << 20U;
// The same where every ray keeps a stack in memory.
constexpr std::size_t kBatchInPasses = 1U << 15U;
// Turns of loops that one step may cost the up to 16 rays a device's vector unit traces side by side.
constexpr std::uint32_t kTurnsPerStep = 64;

// Rays of a CPU's work-item that take steps by turns (wide_walk.h): fewer leave lists of which each round's
// end is guessed wrong more often, with more their walkers leave the first-level cache.
constexpr std::uint32_t kRaysAtOnce = 24;
// So many rays for each of a work-group's, that the last ones of an item, which fewer and fewer keep company,
// are few, and so is the packet that tells whether others pay.
constexpr std::uint32_t kRunsPerItem = 8;

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

}  // namespace

std::string TracePlan::program_options() const {
  if (compact) {
    return "-DGN_GROUP_STACK=" + std::to_string(stack_size) + " -DGN_COUNTERS=" + (counters ? "1" : "0");
  }
  if (wide) {
    return "-DGN_WIDE_STACK=" + std::to_string(stack_size) + " -DGN_COUNTERS=" + (counters ? "1" : "0") +
           " -DGN_RAYS_PER_ITEM=" + std::to_string(rays_per_item) +
           " -DGN_RAYS_AT_ONCE=" + std::to_string(rays_at_once) + " -DGN_PORTABLE=" + (portable ? "1" : "0") +
           (fast ? " -DGN_FAST=1" : "") + (framed ? " -DGN_FRAME=1" : "") +
           (regions != 0 ? " -DGN_REGIONS=1" : "") + (choose ? " -DGN_CHOOSE=1" : "");
  }
  return "-DGN_STACK_SIZE=" + std::to_string(stack_size) + " -DGN_COUNTERS=" + (counters ? "1" : "0") +
         " -DGN_STEP_LIMIT=" + std::to_string(step_limit);
}

std::size_t TracePlan::batch_of(std::size_t rays) const {
  return std::clamp<std::size_t>(rays, 1, step_limit == 0 ? kBatch : kBatchInPasses);
}

namespace {

TracePlan common_plan(const cl::DeviceInfo& device, const TraceOptions& options) {
  if (!std::has_single_bit(options.work_group_size)) {
    throw Error(ErrorCode::kInvalidArgument, "trace work_group_size must be a power of two");
  }
  TracePlan plan;
  plan.work_group_size = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(options.work_group_size, std::bit_floor(device.max_work_group)));
  plan.counters = options.counters;
  return plan;
}

void refuse_step_limit(const TraceOptions& options, const char* flavour) {
  if (options.step_limit == 0) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("the ") + flavour +
                  " flavour traces rays in one go: leave step_limit 0 or use the thread flavour");
}

}  // namespace

TracePlan plan_trace(const cl::DeviceInfo& device, const TraceOptions& options, std::uint32_t max_depth,
                     std::uint64_t steps, std::uint32_t state_bytes) {
  if (options.accuracy == Accuracy::kFast) {
    throw Error(ErrorCode::kInvalidArgument,
                "only the wide and packet flavours trace with fast accuracy; the thread flavour is always "
                "watertight");
  }
  TracePlan plan = common_plan(device, options);
  plan.stack_size = stack_size_for(max_depth);
  plan.step_limit = step_limit_for(device, options.step_limit);
  // A ray visits every node and every triangle once at worst, and a pass ends within one leaf of its limit.
  plan.most_passes = plan.step_limit == 0 ? 1 : static_cast<std::uint32_t>(steps / plan.step_limit + 1);
  plan.state_bytes = state_bytes;
  return plan;
}

TracePlan plan_wide_trace(const cl::DeviceInfo& device, const TraceOptions& options, std::uint32_t depth) {
  refuse_step_limit(options, "wide");
  TracePlan plan = common_plan(device, options);
  // A node leaves at most seven of its children waiting, below them lies what says that there is nothing
  // more, and the last vector written there is eight long.
  plan.stack_size = (7 * depth + 9 + 63) / 64 * 64;
  plan.most_passes = 1;
  plan.rays_per_item = kRunsPerItem * plan.work_group_size;
  if (device.is_cpu && device.loop_limit == 0) plan.rays_at_once = std::min(kRaysAtOnce, plan.rays_per_item);
  plan.work_group_size = 1;
  plan.wide = true;
  plan.portable = options.portable;
  plan.choose = options.flavour == TraceFlavour::kAuto;
  plan.fast = options.accuracy == Accuracy::kFast;
  return plan;
}

TracePlan plan_compact_trace(const cl::DeviceInfo& device, const TraceOptions& options,
                             const DeviceCompactBvh& tree) {
  refuse_step_limit(options, "compact");
  TracePlan plan = common_plan(device, options);
  plan.stack_size = (tree.depth + 15) / 16 * 16;
  plan.most_passes = 1;
  plan.compact = true;
  return plan;
}

Passes make_passes(const cl::Context& context, const TracePlan& plan, std::size_t rays) {
  if (plan.step_limit == 0) return {};
  return {context.create_buffer("ray_states", rays * plan.state_bytes),
          context.create_buffer("waiting_nodes", rays * plan.stack_size * sizeof(std::uint32_t)),
          context.create_buffer("waiting_entries", rays * plan.stack_size * sizeof(float)),
          context.create_buffer("paused_rays", sizeof(std::uint32_t))};
}

cl::Handle<cl_event> enqueue_passes(const cl::Context& context, const TracePlan& plan, const Launch& launch,
                                    std::span<const cl_event> wait_for, const EnqueuePass& enqueue) {
  if (plan.counters) throw Error(ErrorCode::kInvalidArgument, "a counting tracer cannot only enqueue");
  // The driver keeps the buffers alive until the commands that use them are done.
  const Passes passes = make_passes(context, plan, launch.count);
  auto event = enqueue(launch, passes, 0, wait_for);
  for (std::uint32_t pass = 1; pass < plan.most_passes; ++pass) event = enqueue(launch, passes, pass, {});
  return event;
}

double run_passes(const cl::Context& context, const TracePlan& plan, const Launch& launch,
                  const Passes& passes, const EnqueuePass& enqueue) {
  double ms = 0.0;
  for (std::uint32_t pass = 0; pass < plan.most_passes; ++pass) {
    if (plan.step_limit != 0) context.fill(passes.paused, 0);
    const auto event = enqueue(launch, passes, pass, {});
    cl::wait(event);
    ms += event_ms(event);
    if (plan.step_limit == 0) return ms;
    if (context.download_values<std::uint32_t>(passes.paused, 1).front() == 0) return ms;
  }
  throw Error(ErrorCode::kDevice,
              context.device().name + " ended the loops of a traversal by itself; use another device");
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

}  // namespace gnomon
