#include "render_plan.h"

#include "gnomon/scene/ray_set.h"
#include "interrupt.h"
#include "render_rays.h"

namespace gnomon::app {
namespace {

// An upper bound, to ask whether it is worth finding out: paths are rarely longer.
constexpr double kMostRaysOfPath = 12.0;

}  // namespace

PlanOutcome plan_picture(const PlanRequest& request, const RenderOptions& options, const cl::Context& context,
                         const TimedBuild& plain, const Scene& scene, const Progress& progress) {
  if (!request.instead.empty()) return no_plan(request, request.instead + " says which tree");
  const double paths = static_cast<double>(options.width) * options.height * options.samples;
  const double most = request.expected != 0 ? static_cast<double>(request.expected) : kMostRaysOfPath * paths;
  const std::vector<Ray> seen = primary_rays(scene, 256, options.seed);
  PlanTask task{context, scene, plain, {{Query::kClosest, seen, most}}, "at most", {}};
  task.wide = traces_wide(context.device(), TraceFlavour::kAuto);
  if (request.name == "auto") {
    const Outlook outlook = outlook_of(plain.host, scene.triangles, task.to_come);
    if (!outlook.pays) return plan_for(request, task, progress);
  }
  const Tracer tracer(context, plain.tree);
  const std::vector<PlanRays> rays = rays_of_picture(context, tracer, scene, options, progress);
  stop_if_interrupted();
  task.to_come.clear();
  for (const PlanRays& kind : rays) {
    const double expected = request.expected != 0 ? static_cast<double>(request.expected) : kind.expected;
    task.to_come.push_back({kind.query, kind.probe, expected});
  }
  task.draw = [&] {
    std::vector<PlanRays> drawn = rays;
    for (std::size_t i = 0; i < drawn.size(); ++i) drawn[i].expected = task.to_come[i].expected;
    return drawn;
  };
  return plan_for(request, task, progress);
}

}  // namespace gnomon::app
