// A plan for the rays of a picture. Feeds `render` and bench/render_bench.cpp.
#pragma once

#include "gnomon/render/render.h"
#include "plan_choice.h"

namespace gnomon::app {

// Paths are to be traced, options.samples a pixel. The plain tree traces two small pictures of the same view,
// one to fit to and one to judge by, once it is clear that planning can pay. Throws as make_plan and
// PathTracer.
[[nodiscard]] PlanOutcome plan_picture(const PlanRequest& request, const RenderOptions& options,
                                       const cl::Context& context, const TimedBuild& plain,
                                       const Scene& scene, const Progress& progress);

}  // namespace gnomon::app
