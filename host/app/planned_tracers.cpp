#include "planned_tracers.h"

#include <algorithm>

namespace gnomon::app {

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
  // The binary tree has no slots for an order to be of, and is not collapsed.
  if ((kept->tree.ranks.empty() && kept->tree.weights.empty()) ||
      !has_slots(context.device(), TraceFlavour::kAuto)) {
    out.tracer = std::make_unique<Tracer>(context, *out.own, how);
    return out;
  }
  out.wide = std::make_unique<DeviceWideBvh>(
      collapse_device(context, *out.own, {}, nullptr, kept->tree.ranks, kept->tree.weights));
  out.tracer = std::make_unique<Tracer>(context, *out.wide, how);
  return out;
}

}  // namespace gnomon::app
