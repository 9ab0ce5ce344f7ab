// A plan's trees made ready to trace a picture. Feeds `render`.
#pragma once

#include <memory>

#include "gnomon/render/path_tracer.h"
#include "plan_choice.h"

namespace gnomon::app {

// What a tree of the plan has beside its boxes, an order or local trees, as the tracer of this flavour takes
// it; null where the tree on the device is all there is to trace.
[[nodiscard]] std::unique_ptr<DeviceWideBvh> wide_form(const cl::Context& context, const Scene& scene,
                                                       const DeviceBvh& tree, const PlanTree& kept,
                                                       TraceFlavour flavour);

// Chosen for rays_of_picture's kinds in their order. Where the plan chose no other tree it is the plain one,
// which must outlive this as context and scene must.
class PlannedTracers {
 public:
  PlannedTracers(const cl::Context& context, const Scene& scene, const TimedBuild& plain,
                 const PlanOutcome& plan, const TraceOptions& how);
  [[nodiscard]] PathTracers tracers() const { return {*closest_.tracer, *any_.tracer}; }
  [[nodiscard]] const DeviceBvh& closest_tree() const { return closest_.own ? *closest_.own : plain_.tree; }

 private:
  // The tracer refers to the others.
  struct Ready {
    std::unique_ptr<DeviceBvh> own;
    std::unique_ptr<DeviceWideBvh> wide;
    std::unique_ptr<Tracer> tracer;
  };
  [[nodiscard]] Ready ready(const cl::Context& context, const Scene& scene, const PlanTree* kept,
                            const TraceOptions& how) const;

  const TimedBuild& plain_;
  Ready closest_, any_;
};

}  // namespace gnomon::app
