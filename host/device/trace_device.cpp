#include "gnomon/device/trace_device.h"

#include <algorithm>
#include <iterator>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/ray_batches.h"

namespace gnomon {

namespace {

TraceFlavour flavour_for(const cl::DeviceInfo& device, const TraceOptions& options, bool framed) {
  if (framed && (options.flavour == TraceFlavour::kThread || options.flavour == TraceFlavour::kCompact)) {
    throw Error(ErrorCode::kInvalidArgument, std::string("the ") + to_string(options.flavour) +
                                                 " flavour takes no trees whose boxes stand in a frame of "
                                                 "their own (a plan's light-space tree); use wide or "
                                                 "packet");
  }
  if (options.flavour != TraceFlavour::kAuto) return options.flavour;
  if (device.is_cpu && device.loop_limit == 0 && options.step_limit == 0) return TraceFlavour::kPacket;
  return framed ? TraceFlavour::kWide : TraceFlavour::kThread;
}

GnBounds box_of(const GnNode& root) {
  return {{root.lo[0], root.lo[1], root.lo[2]}, 0.0F, {root.hi[0], root.hi[1], root.hi[2]}, 0.0F};
}

GnBounds box_of(const GnWideNode& root) {
  GnBounds box{};
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = *std::min_element(std::begin(root.planes[2 * k]), std::end(root.planes[2 * k]));
    box.hi[k] = *std::max_element(std::begin(root.planes[2 * k + 1]), std::end(root.planes[2 * k + 1]));
  }
  return box;
}

GnBounds box_of(const CompactNode& root) {
  GnBounds box{
      {GN_INFINITY, GN_INFINITY, GN_INFINITY}, 0.0F, {-GN_INFINITY, -GN_INFINITY, -GN_INFINITY}, 0.0F};
  for (std::uint32_t slot = 0; slot < GN_WIDTH; ++slot) {
    if ((root.scales >> (24 + slot) & 1U) == 0 && gn_byte_of(root.counts, slot) == 0) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const float scale = gn_axis_scale(root.scales, k);
      const auto plane = [&](std::uint32_t p) {
        return gn_plane_at(root.origin[k], scale, gn_byte_of(root.planes[p], slot));
      };
      box.lo[k] = std::min(box.lo[k], plane(2 * k));
      box.hi[k] = std::max(box.hi[k], plane(2 * k + 1));
    }
  }
  return box;
}

// For rays to be sorted in; none when they are not. frame: that boxes stand in, or null.
template <typename Node>
std::unique_ptr<RaySort> sort_in(const cl::Context& context, const cl::Buffer& nodes,
                                 const TraceOptions& options, const BoxFrame* frame = nullptr) {
  if (!options.sort_rays && options.lights.empty()) return nullptr;
  if (frame != nullptr) {  // rays begin where triangles are, not where boxes stand
    const float size = frame->size;
    return std::make_unique<RaySort>(context, GnBounds{{-size, -size, -size}, 0.0F, {size, size, size}, 0.0F},
                                     options.lights);
  }
  return std::make_unique<RaySort>(context, box_of(context.download_values<Node>(nodes, 1).front()),
                                   options.lights);
}

}  // namespace

const char* to_string(TraceFlavour flavour) {
  switch (flavour) {
    case TraceFlavour::kAuto:
      return "auto";
    case TraceFlavour::kThread:
      return "thread";
    case TraceFlavour::kWide:
      return "wide";
    case TraceFlavour::kPacket:
      return "packet";
    case TraceFlavour::kCompact:
      return "compact";
  }
  return "?";
}

const char* to_string(Accuracy accuracy) {
  return accuracy == Accuracy::kFast ? "fast" : "watertight";
}

Tracer::Tracer(const cl::Context& context, const DeviceBvh& tree, const TraceOptions& options)
    : context_(context),
      flavour_(flavour_for(context.device(), options, tree.frame.has_value())),
      sorts_closest_(options.sort_rays) {
  if (flavour_ != TraceFlavour::kThread && !collapse(tree, options)) flavour_ = TraceFlavour::kThread;
  if (flavour_ == TraceFlavour::kThread) {
    trace_binary(tree, options);
  } else if (flavour_ == TraceFlavour::kCompact) {
    compacted_ = compact_device(context, collapsed_);
    collapsed_ = {};
    trace_compact(compacted_, options);
  } else {
    trace_wide(collapsed_, options);
  }
}

Tracer::Tracer(const cl::Context& context, const DeviceWideBvh& tree, const TraceOptions& options)
    : context_(context),
      flavour_(options.flavour == TraceFlavour::kAuto ? TraceFlavour::kPacket : options.flavour),
      sorts_closest_(options.sort_rays) {
  if (options.flavour == TraceFlavour::kThread) {
    throw Error(
        ErrorCode::kInvalidArgument,
        "the thread flavour traces binary trees, not wide ones; give it the tree before the collapse");
  }
  if (flavour_ == TraceFlavour::kCompact) {
    compacted_ = compact_device(context, tree);
    trace_compact(compacted_, options);
  } else {
    trace_wide(tree, options);
  }
}

Tracer::Tracer(const cl::Context& context, const DeviceCompactBvh& tree, const TraceOptions& options)
    : context_(context), flavour_(TraceFlavour::kCompact), sorts_closest_(options.sort_rays) {
  if (options.flavour != TraceFlavour::kAuto && options.flavour != TraceFlavour::kCompact) {
    throw Error(ErrorCode::kInvalidArgument, std::string("the ") + to_string(options.flavour) +
                                                 " flavour does not trace compact trees; give it the tree "
                                                 "that this one was made from");
  }
  trace_compact(tree, options);
}

// False: the tree has no wide form, and the caller left the flavour to us.
bool Tracer::collapse(const DeviceBvh& tree, const TraceOptions& options) {
  try {
    collapsed_ = collapse_device(context_, tree);
    return true;
  } catch (const Error& error) {
    if (options.flavour != TraceFlavour::kAuto || tree.frame) throw;
    if (error.code() != ErrorCode::kInvalidArgument) throw;
    return false;
  }
}

void Tracer::trace_binary(const DeviceBvh& tree, const TraceOptions& options) {
  plan_ = std::make_unique<TracePlan>(plan_trace(context_.device(), options, tree.max_depth,
                                                 std::uint64_t{tree.node_count} + tree.triangle_count,
                                                 sizeof(GnWalk)));
  sort_ = sort_in<GnNode>(context_, tree.nodes, options);
  nodes_ = tree.nodes.mem.get();
  triangles_ = tree.leaf_triangles.mem.get();
  set_up("trace.cl");
}

void Tracer::trace_wide(const DeviceWideBvh& tree, const TraceOptions& options) {
  plan_ = std::make_unique<TracePlan>(plan_wide_trace(context_.device(), options, tree.depth));
  if (tree.frame) {
    plan_->framed = true;
    frame_ = context_.create_buffer("box_frame", sizeof(BoxFrame));
    context_.upload_values<BoxFrame>(frame_, std::span(&*tree.frame, 1));
  }
  if (!tree.regions.empty()) {
    plan_->regions = static_cast<std::uint32_t>(tree.regions.size());
    regions_ = context_.create_buffer("regions", tree.regions.size() * sizeof(GnRegion));
    context_.upload_values<GnRegion>(regions_, tree.regions);
  }
  sort_ = sort_in<GnWideNode>(context_, tree.nodes, options, tree.frame ? &*tree.frame : nullptr);
  nodes_ = tree.nodes.mem.get();
  triangles_ = tree.leaves.mem.get();
  set_up(flavour_ == TraceFlavour::kPacket ? "trace_packet.cl" : "trace_wide.cl");
}

void Tracer::trace_compact(const DeviceCompactBvh& tree, const TraceOptions& options) {
  plan_ = std::make_unique<TracePlan>(plan_compact_trace(context_.device(), options, tree));
  sort_ = sort_in<CompactNode>(context_, tree.nodes, options);
  nodes_ = tree.nodes.mem.get();
  triangles_ = tree.leaves.mem.get();
  set_up("trace_compact.cl");
}

void Tracer::set_up(const char* source) {
  closest_ = context_.programs().kernel({source}, plan_->program_options(), "trace_closest");
  any_ = context_.programs().kernel({source}, plan_->program_options(), "trace_any");
  invalid_ = context_.create_buffer("invalid_rays", sizeof(std::uint32_t));
  no_counters_ = context_.create_buffer("no_counters", sizeof(GnRayCounters));
  context_.fill(invalid_, 0);
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;

EnqueuePass Tracer::enqueuer(const cl::Handle<cl_kernel>& kernel) const {
  return [this, &kernel](const Launch& launch, const Passes& passes, std::uint32_t pass,
                         std::span<const cl_event> wait_for) {
    return enqueue(kernel, launch, passes, pass, wait_for);
  };
}

cl::Handle<cl_event> Tracer::enqueue(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                     const Passes& passes, std::uint32_t pass,
                                     std::span<const cl_event> wait_for) const {
  cl::set_arguments(kernel.get(), nodes_, triangles_, launch.rays, launch.answers, invalid_, launch.counters,
                    launch.count);
  if (plan_->framed) cl::set_arguments_from(kernel.get(), 7, frame_);
  if (plan_->regions != 0) cl::set_arguments_from(kernel.get(), 7, regions_, plan_->regions);
  if (plan_->step_limit != 0) {
    cl::set_arguments_from(kernel.get(), 7, passes.states, passes.waiting, passes.entries, passes.paused,
                           pass);
  }
  const std::size_t local = plan_->work_group_size;
  const std::size_t rays = std::size_t{plan_->rays_per_item} * local;
  const std::size_t global = (std::max(launch.count, 1U) + rays - 1) / rays * local;
  return cl::enqueue(context_.queue(), kernel.get(), global, local, wait_for);
}

RaySort* Tracer::sort_for(std::size_t answer_bytes) const {
  return answer_bytes == sizeof(Hit) && !sorts_closest_ ? nullptr : sort_.get();
}

cl::Handle<cl_event> Tracer::enqueue_batch(const cl::Handle<cl_kernel>& kernel, const Launch& launch,
                                           std::size_t answer_bytes, std::span<const cl_event> wait_for,
                                           cl::StageTimes* times) const {
  cl::StageTimes unwanted;
  cl::StageTimes& taken = times == nullptr ? unwanted : *times;
  RaySort* const sort = sort_for(answer_bytes);
  const Launch order = sort == nullptr ? launch : sort->begin(launch, answer_bytes, false, wait_for, taken);
  cl::Handle<cl_event> last = enqueue_passes(
      context_, *plan_, order, sort == nullptr ? wait_for : std::span<const cl_event>{}, enqueuer(kernel));
  taken.add("trace", cl::Handle<cl_event>::share(last.get()));
  if (sort == nullptr) return last;
  last = sort->end(launch, answer_bytes, false, taken);
  taken.add("sort rays", cl::Handle<cl_event>::share(last.get()));
  return last;
}

cl::Handle<cl_event> Tracer::enqueue_closest(cl_mem rays, cl_mem hits, std::uint32_t count,
                                             std::span<const cl_event> wait_for,
                                             cl::StageTimes* times) const {
  return enqueue_batch(closest_, {rays, hits, no_counters_.mem.get(), count}, sizeof(Hit), wait_for, times);
}

cl::Handle<cl_event> Tracer::enqueue_any(cl_mem rays, cl_mem occluded, std::uint32_t count,
                                         std::span<const cl_event> wait_for, cl::StageTimes* times) const {
  return enqueue_batch(any_, {rays, occluded, no_counters_.mem.get(), count}, sizeof(std::uint32_t), wait_for,
                       times);
}

template <typename Answer>
TraceResult Tracer::trace_all(const cl::Handle<cl_kernel>& kernel, std::span<const Ray> rays,
                              std::vector<Answer> TraceResult::*answers, const Progress& progress) const {
  TraceResult result;
  const std::uint64_t invalid_before = invalid_rays();
  result.kernel_ms = trace_in_batches(context_, *plan_, rays, result.*answers, result.counters,
                                      enqueuer(kernel), progress, sort_for(sizeof(Answer)));
  result.invalid_rays = invalid_rays() - invalid_before;
  return result;
}

TraceResult Tracer::closest(std::span<const Ray> rays, const Progress& progress) const {
  return trace_all(closest_, rays, &TraceResult::hits, progress);
}

TraceResult Tracer::any(std::span<const Ray> rays, const Progress& progress) const {
  return trace_all(any_, rays, &TraceResult::occluded, progress);
}

std::uint64_t Tracer::invalid_rays() const {
  return context_.download_values<std::uint32_t>(invalid_, 1).front();
}

}  // namespace gnomon
