#include "gnomon/compare/own_entrant.h"

#include "gnomon/measure/prediction.h"
#include "gnomon/tree/bvh_check.h"

namespace gnomon::compare {
namespace {

class OwnEntrant : public Entrant {
 public:
  OwnEntrant(const cl::Context& context, const Scene& scene, const OwnMethod& method)
      : context_(context), scene_(scene), method_(method) {
    method_.build.check();
    if (traces_wide(context.device())) return;
    if (method.tracing.accuracy == Accuracy::kFast)
      throw Error(ErrorCode::kInvalidArgument,
                  "this device traces binary trees, for which there are no fast hits");
    if (method.tracing.portable)
      throw Error(ErrorCode::kInvalidArgument, "this device is traced by OpenCL C alone in any case");
  }

  void build(const Progress& progress) override {
    traced_.reset();
    host_.reset();
    report_ = {};
    DeviceBvh tree = build_device(context_, scene_.triangles, method_.build, &report_, progress);
    traced_.emplace(context_, std::move(tree), method_.tracing, &report_);
  }

  void trace(const Batch& batch) override { traced_->trace(batch); }
  Answers answers(const Batch& batch) override { return traced_->answers(batch); }
  std::vector<Hit> closest(std::span<const Ray> rays) override { return traced_->closest(rays); }
  std::optional<Work> work(const Batch& batch) override { return traced_->work(batch); }
  std::vector<float> boxes(std::span<const Ray> rays) override { return traced_->boxes(rays); }

  BuildRow facts() override {
    BuildRow row;
    const Bvh& host = *tree();
    if (const auto fault = check_bvh(host, scene_.triangles, method_.build))
      throw Error(ErrorCode::kDevice, "the tree is broken: " + fault->what + "; gnomon validate says more");
    const BvhStats stats = stats_of(host, {});
    row.bytes = traced_->bytes();
    row.scratch_bytes = report_.scratch_bytes;
    row.tree_hash = tree_hash(host);
    row.nodes = stats.nodes;
    row.max_depth = stats.max_depth;
    row.sah_cost = stats.sah_cost;
    row.flavour = traced_->flavour();
    return row;
  }

  const Bvh* tree() override {
    if (!host_ && traced_ && traced_->tree() != nullptr) host_ = download_bvh(context_, *traced_->tree());
    return host_ ? &*host_ : nullptr;
  }
  const DeviceBvh* device_tree() override { return traced_->tree(); }

  void forget_tree() override {
    host_.reset();
    traced_->forget_tree();
  }

  std::optional<double> predicted_cost(const Bvh& bvh) override {
    return method_.rays ? gnomon::predicted_cost(bvh, method_.rays->area, method_.rays->measure)
                        : predicted_surface_cost(bvh);
  }

 private:
  const cl::Context& context_;
  const Scene& scene_;
  OwnMethod method_;
  BuildReport report_;
  std::optional<TracedTree> traced_;
  std::optional<Bvh> host_;
};

}  // namespace

std::unique_ptr<Entrant> enter_own(const cl::Context& context, const Scene& scene, const OwnMethod& method) {
  return std::make_unique<OwnEntrant>(context, scene, method);
}

}  // namespace gnomon::compare
