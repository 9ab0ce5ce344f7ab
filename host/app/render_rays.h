// The rays a picture's paths will be, before they are traced: a small picture of the same view with other
// seeds. Feeds `render`'s plan.
#pragma once

#include <vector>

#include "gnomon/plan/choose.h"
#include "gnomon/render/render.h"

namespace gnomon::app {

// Rays that look for the nearest hit, then rays that ask lights, as many of each depth as paths have;
// `expected` is how many the picture will trace. Nothing for a kind that no path has.
[[nodiscard]] std::vector<PlanRays> rays_of_picture(const cl::Context& context, const Tracer& tracer,
                                                    const Scene& scene, const RenderOptions& options,
                                                    const Progress& progress);

}  // namespace gnomon::app
