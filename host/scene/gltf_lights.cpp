#include "gnomon/scene/gltf_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <string_view>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

Vec3 rounded(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

float in_float_range(double value) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, 0.0, kMost));
}

// Nothing for a vector without a direction: zero, infinite or NaN.
std::optional<glm::dvec3> unit(const glm::dvec3& v) {
  const double length = std::hypot(v.x, v.y, v.z);
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return v / length;
}

// Where a node stands and looks.
struct Pose {
  glm::dvec3 position;
  glm::dvec3 forward;
  glm::dvec3 up;
};

std::optional<Pose> pose_of(const glm::dmat4& world) {
  const glm::dvec3 position(world[3]);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(position[axis]) <= static_cast<double>(kMaxCoordinate))) return std::nullopt;
  }
  const auto forward = unit(-glm::dvec3(world[2]));
  const auto y = unit(glm::dvec3(world[1]));
  if (!forward || !y) return std::nullopt;
  // Shear may tilt y; up is what of it stands at right angles to the view.
  const auto up = unit(*y - glm::dot(*y, *forward) * *forward);
  if (!up) return std::nullopt;
  return Pose{position, *forward, *up};
}

std::size_t require_index(int index, std::size_t count, const std::string& place, const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= count) {
    bad_scene(place + ": " + what + ' ' + std::to_string(index) + " does not exist, there are " +
              std::to_string(count) + std::string(kExportAgain));
  }
  return static_cast<std::size_t>(index);
}

std::string either(const std::string& first, const std::string& second) {
  return first.empty() ? second : first;
}

// Fills what only one kind of light has. Throws for a type that KHR_lights_punctual does not define.
void read_kind(const tinygltf::Light& source, const std::string& place, Light& light) {
  if (source.type == "point") {
    light.kind = LightKind::kPoint;
  } else if (source.type == "directional") {
    light.kind = LightKind::kDirectional;
  } else if (source.type == "spot") {
    light.kind = LightKind::kSpot;
    const double outer = std::clamp(source.spot.outerConeAngle, 0.0, glm::half_pi<double>());
    light.outer_cone = static_cast<float>(outer);
    light.inner_cone = static_cast<float>(std::clamp(source.spot.innerConeAngle, 0.0, outer));
  } else {
    bad_scene(place + ": light type " + in_quotes(source.type) +
              " does not exist; use point, spot or directional");
  }
}

}  // namespace

void add_camera(const tinygltf::Model& model, const PlacedNode& placed, Scene& scene) {
  const tinygltf::Node& node = model.nodes[placed.node];
  if (node.camera < 0) return;
  const std::string place = numbered("node", placed.node, node.name);
  const std::size_t index = require_index(node.camera, model.cameras.size(), place, "camera");
  const tinygltf::Camera& source = model.cameras[index];
  const std::string name = numbered("camera", index, source.name);
  if (source.type != "perspective") {
    scene.report.notes.push_back("Orthographic cameras are not supported: " + name + " was left out.");
    return;
  }
  const double fov_y = source.perspective.yfov;
  const auto pose = pose_of(placed.world);
  if (!pose || !(fov_y > 0.0 && fov_y < glm::pi<double>())) {
    scene.report.notes.push_back("Left out " + name + ": it has no usable place, direction or angle.");
    return;
  }
  Camera camera;
  camera.name = either(source.name, node.name);
  camera.position = rounded(pose->position);
  camera.forward = rounded(pose->forward);
  camera.up = rounded(pose->up);
  camera.fov_y = static_cast<float>(fov_y);
  camera.aspect = in_float_range(source.perspective.aspectRatio);
  scene.cameras.push_back(std::move(camera));
}

void add_light(const tinygltf::Model& model, const PlacedNode& placed, Scene& scene) {
  const tinygltf::Node& node = model.nodes[placed.node];
  // tinygltf 2.7 reads what lights there are, but leaves which one a node has in its extensions.
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension == node.extensions.end()) return;
  const std::string place = numbered("node", placed.node, node.name);
  const int stated = extension->second.Get("light").GetNumberAsInt();
  const std::size_t index = require_index(stated, model.lights.size(), place, "light");
  const tinygltf::Light& source = model.lights[index];
  const std::string name = numbered("light", index, source.name);
  Light light;
  light.name = either(source.name, node.name);
  read_kind(source, place + ", " + name, light);
  const auto pose = pose_of(placed.world);
  if (!pose) {
    scene.report.notes.push_back("Left out " + name + ": it has no usable place or direction.");
    return;
  }
  light.position = rounded(pose->position);
  light.direction = rounded(pose->forward);
  light.range = in_float_range(source.range);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double factor = source.color.empty() ? 1.0 : source.color[channel];
    light.color[channel] = in_float_range(factor * source.intensity);
  }
  scene.lights.push_back(std::move(light));
}

}  // namespace gnomon
