#include "gnomon/compare/own_entrant.h"

#include <algorithm>

#include "gnomon/cl/launch.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/tree/bvh_check.h"

namespace gnomon::compare {
namespace {

class OwnEntrant : public Entrant {
 public:
  OwnEntrant(const cl::Context& context, const Scene& scene, const OwnMethod& method)
      : context_(context), scene_(scene), method_(method) {
    method_.build.check();
    const cl::DeviceInfo& device = context.device();
    wide_flavour_ = device.is_cpu && device.loop_limit == 0;
    if (method.accuracy == Accuracy::kFast && !wide_flavour_)
      throw Error(ErrorCode::kInvalidArgument,
                  "this device traces binary trees, for which there are no fast hits");
  }

  void build(const Progress& progress) override {
    tracer_.reset();
    counter_.reset();
    host_.reset();
    wide_ = {};
    tree_ = {};
    report_ = {};
    tree_ = build_device(context_, scene_.triangles, method_.build, &report_, progress);
    if (wide_flavour_) wide_ = collapse_device(context_, tree_, {}, &report_);
    TraceOptions options;
    options.accuracy = method_.accuracy;
    options.flavour = wide_flavour_ ? TraceFlavour::kPacket : TraceFlavour::kThread;
    tracer_ = make_tracer(options);
  }

  void trace(const Batch& batch) override {
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

  Answers answers(const Batch& batch) override {
    return {tracer_->closest(batch.rays).hits, tracer_->any(batch.rays).occluded};
  }

  std::vector<Hit> closest(std::span<const Ray> rays) override { return tracer_->closest(rays).hits; }

  BuildRow facts() override {
    BuildRow row;
    const Bvh& host = *tree();
    if (const auto fault = check_bvh(host, scene_.triangles, method_.build))
      throw Error(ErrorCode::kDevice, "the tree is broken: " + fault->what + "; gnomon validate says more");
    const BvhStats stats = stats_of(host, {});
    row.bytes = wide_flavour_ ? wide_.bytes() : tree_.bytes();
    row.scratch_bytes = report_.scratch_bytes;
    row.tree_hash = tree_hash(host);
    row.nodes = stats.nodes;
    row.max_depth = stats.max_depth;
    row.sah_cost = stats.sah_cost;
    row.flavour = to_string(tracer_->flavour());
    return row;
  }

  std::optional<Work> work(const Batch& batch) override {
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

  std::vector<float> boxes(std::span<const Ray> rays) override {
    const TraceResult result = counter().closest(rays);
    std::vector<float> boxes;
    for (const GnRayCounters& ray : result.counters) boxes.push_back(static_cast<float>(ray.boxes));
    return boxes;
  }

  const Bvh* tree() override {
    if (!host_ && tree_.node_count > 0) host_ = download_bvh(context_, tree_);
    return host_ ? &*host_ : nullptr;
  }
  const DeviceBvh* device_tree() override { return tree_.node_count > 0 ? &tree_ : nullptr; }

  void forget_tree() override {
    host_.reset();
    if (wide_flavour_) tree_ = {};
  }

  std::optional<double> predicted_cost(const Bvh& bvh) override {
    return method_.rays ? gnomon::predicted_cost(bvh, method_.rays->area, method_.rays->measure)
                        : predicted_surface_cost(bvh);
  }

 private:
  std::unique_ptr<Tracer> make_tracer(const TraceOptions& options) const {
    return wide_flavour_ ? std::make_unique<Tracer>(context_, wide_, options)
                         : std::make_unique<Tracer>(context_, tree_, options);
  }

  // Packets share tests: what one ray costs is counted with each by itself.
  const Tracer& counter() {
    if (!counter_) {
      TraceOptions options;
      options.flavour = wide_flavour_ ? TraceFlavour::kWide : TraceFlavour::kThread;
      options.counters = true;
      counter_ = make_tracer(options);
    }
    return *counter_;
  }

  const cl::Context& context_;
  const Scene& scene_;
  OwnMethod method_;
  bool wide_flavour_ = false;
  DeviceBvh tree_;
  DeviceWideBvh wide_;
  BuildReport report_;
  std::optional<Bvh> host_;
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<Tracer> counter_;
};

}  // namespace

std::unique_ptr<Entrant> enter_own(const cl::Context& context, const Scene& scene, const OwnMethod& method) {
  return std::make_unique<OwnEntrant>(context, scene, method);
}

}  // namespace gnomon::compare
