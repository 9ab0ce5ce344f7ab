// How rays of pictures are best traced: which order their shadow rays go in. Feeds render_paths and `trace`.
#pragma once

#include <vector>

#include "gnomon/device/trace_device.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

// A scene's points, spots and suns, or the sun of a scene without lights; the first 31.
[[nodiscard]] std::vector<RayLight> ray_lights_of(const Scene& scene);

// For the tracers of a PathTracer: with sort_by_light, shadow rays light by light, where a device traces
// packets. The same picture either way.
[[nodiscard]] TraceOptions picture_tracing(const cl::DeviceInfo& device, const Scene& scene,
                                           bool sort_by_light);

}  // namespace gnomon
