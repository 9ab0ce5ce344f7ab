// A plan's trees as one entrant: which tree traces a batch is what was decided for its kind of rays. Feeds
// the list of methods.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gnomon/compare/method.h"

namespace gnomon::compare {

// The rays to plan for; hits of rays are found by the function given.
using RaysToPlan = std::function<std::vector<PlanRays>(const FindHits& closest)>;

// Kinds of the source that the scene has rays of.
// The scene must outlive it.
[[nodiscard]] RaysToPlan drawn_for(const Scene& scene, const PlanSource& source);

// Of one light or camera.
[[nodiscard]] RaysToPlan planned_for(const RaysOf& rays);

// Building it draws the rays, plans, and makes each kept tree ready to trace. Context and scene must outlive
// it.
[[nodiscard]] std::unique_ptr<Entrant> enter_plan(const cl::Context& context, const Scene& scene,
                                                  const PlanBuilder& builder, const RaysToPlan& rays);

}  // namespace gnomon::compare
