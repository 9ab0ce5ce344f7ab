#include "gnomon/scene/area_light.h"

#include <cmath>
#include <utility>

namespace gnomon {
namespace {

// Below this share of the whole area a summed normal is only rounding, or the surface closes around a volume.
constexpr double kFacesAllWays = 1e-6;

}  // namespace

bool emits(const Material& material) {
  return material.emission[0] > 0.0F || material.emission[1] > 0.0F || material.emission[2] > 0.0F;
}

Light make_area_light(const Scene& scene, std::string name, const Material& material,
                      std::vector<std::uint32_t> triangles) {
  double area = 0.0;
  double centroid[3] = {};
  double normal[3] = {};
  for (const std::uint32_t index : triangles) {
    const Triangle& t = scene.triangles[index];
    double e[3];
    double f[3];
    for (unsigned axis = 0; axis < 3; ++axis) {
      e[axis] = static_cast<double>(t.v1[axis]) - static_cast<double>(t.v0[axis]);
      f[axis] = static_cast<double>(t.v2[axis]) - static_cast<double>(t.v0[axis]);
    }
    const double cross[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    const double twice_area = std::hypot(cross[0], cross[1], cross[2]);
    area += twice_area;
    for (unsigned axis = 0; axis < 3; ++axis) {
      normal[axis] += cross[axis];
      centroid[axis] += twice_area * (static_cast<double>(t.v0[axis]) + (e[axis] + f[axis]) / 3.0);
    }
  }
  Light light;
  light.name = std::move(name);
  light.kind = LightKind::kArea;
  light.color = material.emission;
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  const bool faces_one_way = length > kFacesAllWays * area;
  for (unsigned axis = 0; axis < 3; ++axis) {
    light.position[axis] = static_cast<float>(area > 0.0 ? centroid[axis] / area : 0.0);
    light.direction[axis] = static_cast<float>(faces_one_way ? normal[axis] / length : 0.0);
  }
  light.triangles = std::move(triangles);
  return light;
}

}  // namespace gnomon
