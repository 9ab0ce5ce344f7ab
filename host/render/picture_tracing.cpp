#include "gnomon/render/picture_tracing.h"

#include "gnomon/render/light_set.h"
#include "gnomon/shared/light_key.h"

namespace gnomon {

std::vector<RayLight> ray_lights_of(const Scene& scene) {
  std::vector<RayLight> lights;
  const auto add = [&](const Light& light) {
    const bool sun = light.kind == LightKind::kDirectional;
    if (light.kind == LightKind::kArea || lights.size() == GN_MOST_RAY_LIGHTS) return;
    lights.push_back({sun, sun ? light.direction : light.position});
  };
  for (const Light& light : scene.lights) add(light);
  if (scene.lights.empty()) add(default_sun());
  return lights;
}

TraceOptions picture_tracing(const cl::DeviceInfo& device, const Scene& scene, bool sort_by_light) {
  TraceOptions options;
  if (sort_by_light && device.is_cpu && device.loop_limit == 0) options.lights = ray_lights_of(scene);
  return options;
}

}  // namespace gnomon
