#include "planned_tracers.h"

#include "gnomon/device/join_wide.h"

namespace gnomon::app {

std::unique_ptr<DeviceWideBvh> wide_form(const cl::Context& context, const Scene& scene,
                                         const DeviceBvh& tree, const PlanTree& kept, TraceFlavour flavour) {
  const OrderedTree& own = kept.tree;
  // The binary tree has no slots for an order to be of, and is not collapsed.
  if (!has_slots(context.device(), flavour)) return nullptr;
  if (own.ranks.empty() && own.weights.empty() && own.local.empty()) return nullptr;
  return std::make_unique<DeviceWideBvh>(
      collapse_with_regions(context, tree, scene.triangles, own.local, own.ranks, own.weights));
}

PlannedTracers::PlannedTracers(const cl::Context& context, const Scene& scene, const TimedBuild& plain,
                               const PlanOutcome& plan, const TraceOptions& how)
    : plain_(plain) {
  const std::size_t kinds = plan.chosen.size();
  closest_ = ready(context, scene, kinds == 0 ? nullptr : plan.tree(0), how);
  // Without lights nothing asks: any tree will do.
  any_ = ready(context, scene, kinds == 0 ? nullptr : plan.tree(kinds - 1), how);
}

PlannedTracers::Ready PlannedTracers::ready(const cl::Context& context, const Scene& scene,
                                            const PlanTree* kept, const TraceOptions& how) const {
  Ready out;
  if (kept == nullptr) {
    out.tracer = std::make_unique<Tracer>(context, plain_.tree, how);
    return out;
  }
  out.own = std::make_unique<DeviceBvh>(upload_bvh(context, kept->tree.bvh, scene.triangles));
  out.wide = wide_form(context, scene, *out.own, *kept, TraceFlavour::kAuto);
  out.tracer = out.wide ? std::make_unique<Tracer>(context, *out.wide, how)
                        : std::make_unique<Tracer>(context, *out.own, how);
  return out;
}

}  // namespace gnomon::app
