#include "gnomon/device/trace_areas.h"

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/ray_batches.h"

namespace gnomon {
namespace {

constexpr cl_uint kPassArguments = 13;  // place of the first, in trace_areas.cl's kernels

std::uint64_t steps_of(const ForestTree& tree) {
  return std::uint64_t{tree.node_count} + tree.triangle_count;
}

// What a ray may visit: by our rule one local tree and the global one, by the published rule all of them. A
// lookup's steps are at most two boxes or nine cells and six planes an area.
std::uint64_t most_steps(const DeviceForest& forest, FallbackRule rule) {
  const std::uint64_t lookup = (2 + GN_AREA_PLANES) * forest.local.size() + 9;
  std::uint64_t all = lookup;
  std::uint64_t most = 0;
  for (const ForestTree& tree : forest.local) {
    all += lookup + steps_of(tree);
    most = std::max(most, lookup + steps_of(tree));
  }
  return steps_of(forest.global) + (rule == FallbackRule::kPublished ? all : lookup + most);
}

}  // namespace

ForestTracer::ForestTracer(const cl::Context& context, const DeviceForest& forest,
                           const DeviceTopLevel& top_level, const ForestTraceOptions& options)
    : context_(context), forest_(forest), top_level_(top_level) {
  if (top_level.area_count != forest.areas.size()) {
    throw Error(ErrorCode::kInvalidArgument, "a top level of " + std::to_string(top_level.area_count) +
                                                 " areas does not fit a forest of " +
                                                 std::to_string(forest.areas.size()));
  }
  plan_ = std::make_unique<TracePlan>(plan_trace(context.device(), options.trace, forest.max_depth(),
                                                 most_steps(forest, options.rule), sizeof(GnAreaWalk)));
  const std::string program =
      plan_->program_options() + " " + top_level.program_options() +
      " -DGN_PUBLISHED_RULE=" + (options.rule == FallbackRule::kPublished ? "1" : "0");
  closest_ = context.programs().kernel({"trace_areas.cl"}, program, "trace_areas_closest");
  any_ = context.programs().kernel({"trace_areas.cl"}, program, "trace_areas_any");
  invalid_ = context.create_buffer("invalid_rays", sizeof(std::uint32_t));
  no_counters_ = context.create_buffer("no_counters", sizeof(GnAreaCounters));
  context.fill(invalid_, 0);
}

ForestTracer::ForestTracer(ForestTracer&&) noexcept = default;
ForestTracer::~ForestTracer() = default;

EnqueuePass ForestTracer::enqueuer(const cl::Handle<cl_kernel>& kernel) const {
  return [this, &kernel](const Launch& launch, const Passes& passes, std::uint32_t pass,
                         std::span<const cl_event> wait_for) {
    return enqueue(kernel, launch, passes, pass, wait_for);
  };
}

cl::Handle<cl_event> ForestTracer::enqueue(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                           const Passes& passes, std::uint32_t pass,
                                           std::span<const cl_event> wait_for) const {
  cl::set_arguments(kernel.get(), forest_.nodes, forest_.triangles, forest_.order, top_level_.areas,
                    top_level_.boxes, top_level_.cells, top_level_.cell_areas, top_level_.box_count,
                    launch.rays, launch.answers, invalid_, launch.counters, launch.count);
  if (plan_->step_limit != 0) {
    cl::set_arguments_from(kernel.get(), kPassArguments, passes.states, passes.waiting, passes.entries,
                           passes.paused, pass);
  }
  const std::size_t local = plan_->work_group_size;
  const std::size_t global = (std::max(launch.count, 1U) + local - 1) / local * local;
  return cl::enqueue(context_.queue(), kernel.get(), global, local, wait_for);
}

cl::Handle<cl_event> ForestTracer::enqueue_closest(cl_mem rays, cl_mem hits, std::uint32_t count,
                                                   std::span<const cl_event> wait_for) const {
  return enqueue_passes(context_, *plan_, {rays, hits, no_counters_.mem.get(), count}, wait_for,
                        enqueuer(closest_));
}

cl::Handle<cl_event> ForestTracer::enqueue_any(cl_mem rays, cl_mem occluded, std::uint32_t count,
                                               std::span<const cl_event> wait_for) const {
  return enqueue_passes(context_, *plan_, {rays, occluded, no_counters_.mem.get(), count}, wait_for,
                        enqueuer(any_));
}

template <typename Answer>
ForestTraceResult ForestTracer::trace_all(const cl::Handle<cl_kernel>& kernel, std::span<const Ray> rays,
                                          std::vector<Answer> ForestTraceResult::*answers,
                                          const Progress& progress) const {
  ForestTraceResult result;
  const std::uint64_t invalid_before = invalid_rays();
  result.kernel_ms =
      trace_in_batches(context_, *plan_, rays, result.*answers, result.counters, enqueuer(kernel), progress);
  result.invalid_rays = invalid_rays() - invalid_before;
  return result;
}

ForestTraceResult ForestTracer::closest(std::span<const Ray> rays, const Progress& progress) const {
  return trace_all(closest_, rays, &ForestTraceResult::hits, progress);
}

ForestTraceResult ForestTracer::any(std::span<const Ray> rays, const Progress& progress) const {
  return trace_all(any_, rays, &ForestTraceResult::occluded, progress);
}

std::uint64_t ForestTracer::invalid_rays() const {
  return context_.download_values<std::uint32_t>(invalid_, 1).front();
}

}  // namespace gnomon
