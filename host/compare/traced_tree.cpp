#include "gnomon/compare/traced_tree.h"

#include <algorithm>

#include "gnomon/cl/launch.h"
#include "gnomon/device/join_wide.h"

namespace gnomon::compare {

bool traces_wide(const cl::DeviceInfo& device) {
  return device.is_cpu && device.loop_limit == 0;
}

TracedTree::TracedTree(const cl::Context& context, DeviceBvh tree, const Options& options,
                       BuildReport* report)
    : context_(context), wide_flavour_(traces_wide(context.device())), tree_(std::move(tree)) {
  if (wide_flavour_) wide_ = collapse_device(context_, tree_, {}, report);
  set_up(options);
}

TracedTree::TracedTree(const cl::Context& context, const OrderedTree& tree,
                       std::span<const Triangle> triangles)
    : context_(context),
      wide_flavour_(traces_wide(context.device())),
      tree_(upload_bvh(context, tree.bvh, triangles)) {
  if (wide_flavour_)
    wide_ = collapse_with_regions(context_, tree_, triangles, tree.local, tree.ranks, tree.weights);
  set_up({});
}

void TracedTree::set_up(const Options& options) {
  TraceOptions how;
  how.accuracy = options.accuracy;
  how.portable = options.portable;
  how.flavour = wide_flavour_ ? TraceFlavour::kPacket : TraceFlavour::kThread;
  tracer_ = make_tracer(how);
}

std::unique_ptr<Tracer> TracedTree::make_tracer(const TraceOptions& options) const {
  return wide_flavour_ ? std::make_unique<Tracer>(context_, wide_, options)
                       : std::make_unique<Tracer>(context_, tree_, options);
}

// Packets share tests: what one ray costs is counted with each by itself.
const Tracer& TracedTree::counter() {
  if (!counter_) {
    TraceOptions options;
    options.flavour = wide_flavour_ ? TraceFlavour::kWide : TraceFlavour::kThread;
    options.counters = true;
    counter_ = make_tracer(options);
  }
  return *counter_;
}

void TracedTree::trace(const Batch& batch) const {
  // Devices that end loops need many passes: the blocking calls stop when all rays are through.
  if (context_.device().loop_limit != 0) {
    static_cast<void>(batch.any_hit ? tracer_->any(batch.rays) : tracer_->closest(batch.rays));
    return;
  }
  const auto count = static_cast<std::uint32_t>(batch.rays.size());
  cl_mem rays = batch.device_rays.mem.get();
  cl_mem answers = batch.device_answers.mem.get();
  cl::wait(batch.any_hit ? tracer_->enqueue_any(rays, answers, count)
                         : tracer_->enqueue_closest(rays, answers, count));
}

Answers TracedTree::answers(const Batch& batch) const {
  return {tracer_->closest(batch.rays).hits, tracer_->any(batch.rays).occluded};
}

std::vector<Hit> TracedTree::closest(std::span<const Ray> rays) const {
  return tracer_->closest(rays).hits;
}

Work TracedTree::work(const Batch& batch) {
  const TraceResult result = batch.any_hit ? counter().any(batch.rays) : counter().closest(batch.rays);
  Work work;
  for (const GnRayCounters& ray : result.counters) {
    work.boxes_per_ray += ray.boxes;
    work.triangles_per_ray += ray.triangles;
  }
  const auto rays = static_cast<double>(std::max<std::size_t>(1, batch.rays.size()));
  work.boxes_per_ray /= rays;
  work.triangles_per_ray /= rays;
  return work;
}

std::vector<float> TracedTree::boxes(std::span<const Ray> rays) {
  const TraceResult result = counter().closest(rays);
  std::vector<float> boxes;
  for (const GnRayCounters& ray : result.counters) boxes.push_back(static_cast<float>(ray.boxes));
  return boxes;
}

std::string TracedTree::flavour() const {
  return to_string(tracer_->flavour());
}

void TracedTree::forget_tree() {
  if (wide_flavour_) tree_ = {};
}

}  // namespace gnomon::compare
