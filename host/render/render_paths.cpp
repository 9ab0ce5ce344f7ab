#include <optional>

#include "gnomon/render/picture_tracing.h"
#include "gnomon/render/render.h"

namespace gnomon {
namespace {

// Boxes tested by camera rays, added to their pixels.
void count_boxes(const Tracer& counting, const PathTracer& paths, const TracedRays& traced,
                 std::vector<float>& boxes) {
  const TraceResult result = counting.closest(traced.rays);
  for (std::size_t i = 0; i < traced.rays.size(); ++i)
    boxes[paths.pixel_of(traced.paths[i].cell)] += static_cast<float>(result.counters[i].boxes);
}

}  // namespace

RenderResult render_paths(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
                          const RenderOptions& options, const Progress& progress,
                          const RayObserver& observer) {
  options.check();
  const Tracer tracer(context, tree, picture_tracing(context.device(), scene, options.sort_by_light));
  return render_paths(context, {tracer, tracer}, tree, scene, options, progress, observer);
}

RenderResult render_paths(const cl::Context& context, const PathTracers& tracers, const DeviceBvh& tree,
                          const Scene& scene, const RenderOptions& options, const Progress& progress,
                          const RayObserver& observer) {
  options.check();
  PathOptions how;
  how.width = options.width;
  how.height = options.height;
  how.seed = options.seed;
  PathTracer paths(context, tracers, scene, how);
  RenderResult result;
  std::optional<Tracer> counting;
  if (options.heat_map) {
    TraceOptions counters;
    counters.counters = true;
    counting.emplace(context, tree, counters);
    result.boxes.resize(std::size_t{options.width} * options.height);
  }
  RayObserver watch;
  if (counting || observer) {
    watch = [&](const TracedRays& traced) {
      if (counting && traced.use == RayUse::kCamera) count_boxes(*counting, paths, traced, result.boxes);
      if (observer) observer(traced);
    };
  }
  paths.add_samples(options.samples, progress, watch);
  for (float& boxes : result.boxes) boxes /= static_cast<float>(options.samples);
  result.picture = paths.picture();
  result.coverage = paths.coverage();
  result.camera_rays = paths.counts().camera_rays;
  result.other_rays = paths.counts().bounce_rays + paths.counts().shadow_rays;
  result.kernel_ms = paths.counts().trace_ms;
  result.notes = paths.notes();
  return result;
}

}  // namespace gnomon
