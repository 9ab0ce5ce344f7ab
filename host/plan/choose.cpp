#include "gnomon/plan/choose.h"

#include <cmath>

#include "gnomon/base/error.h"
#include "gnomon/plan/chooser.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

PlanBuilder reference_builder() {
  return {[](std::span<const Triangle> triangles, const BuildOptions& options) {
            return build_reference(triangles, options);
          },
          [](const Bvh& bvh, const OptimiseOptions& options) { return optimise_reference(bvh, options); }};
}

Plan make_plan(std::span<const Triangle> triangles, std::span<const PlanRays> rays,
               const PlanOptions& options, const PlanBuilder& builder, const Progress& progress) {
  options.check();
  report(progress, "baseline", 0.0);
  PlanPool pool(triangles, options, builder);
  Plan plan;
  plan.trees.push_back(pool.baseline());
  plan.baseline_units = pool.baseline_units();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(rays[i].expected >= 0.0 && std::isfinite(rays[i].expected))) {
      throw Error(ErrorCode::kInvalidArgument, "expected rays of " + rays[i].name + " = " +
                                                   std::to_string(rays[i].expected) +
                                                   " are no finite number >= 0");
    }
    report(progress, rays[i].name, static_cast<double>(i + 1) / static_cast<double>(rays.size() + 1));
    Decision decision = Chooser(triangles, rays[i], options, pool, plan.trees).run();
    plan.planning_units += decision.probe_units;
    if (decision.tree != 0) plan.kept_units += plan.trees[decision.tree].build_units;
    plan.decisions.push_back(std::move(decision));
  }
  plan.planning_units += pool.work();
  return plan;
}

}  // namespace gnomon
