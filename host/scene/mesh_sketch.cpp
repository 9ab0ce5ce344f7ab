#include "gnomon/scene/mesh_sketch.h"

#include <array>
#include <cmath>

#include "gnomon/scene/area_light.h"

namespace gnomon {
namespace {

Point to_point(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

// Twice the area times the normal, exact enough that 0 means collinear or equal corners.
Point area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(to_point(b) - to_point(a), to_point(c) - to_point(a));
}

// Any unit vector at right angles to a unit vector.
Point perpendicular(const Point& axis) {
  const Point other = std::abs(axis.y) < 0.9 ? Point{0.0, 1.0, 0.0} : Point{1.0, 0.0, 0.0};
  return glm::normalize(glm::cross(other, axis));
}

// One light per emissive material, as the importers make them.
void add_area_lights(Scene& scene) {
  std::vector<std::vector<std::uint32_t>> emitting(scene.materials.size());
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const std::uint32_t id = scene.material_ids[i];
    if (emits(scene.materials[id])) emitting[id].push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t id = 0; id < emitting.size(); ++id) {
    if (emitting[id].empty()) continue;
    const Material& material = scene.materials[id];
    scene.lights.push_back(make_area_light(scene, material.name, material, std::move(emitting[id])));
  }
}

}  // namespace

Vec3 to_vec3(const Point& point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
}

Frame upright(const Point& origin, double turns) {
  const double c = cos_turns(turns);
  const double s = sin_turns(turns);
  return {origin, {c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c}};
}

Frame aimed(const Point& from, const Point& to) {
  const Point y = glm::normalize(to - from);
  const Point x = perpendicular(y);
  return {from, x, y, glm::cross(x, y)};
}

double share_of(const MeshSketch& sketch, std::uint64_t goal, std::uint64_t objects) {
  if (goal <= sketch.count() || objects == 0) return 0.0;
  return static_cast<double>(goal - sketch.count()) / static_cast<double>(objects);
}

unsigned at_least(unsigned least, double wanted) {
  const double rounded = std::floor(wanted + 0.5);
  return rounded > static_cast<double>(least) ? static_cast<unsigned>(rounded) : least;
}

MeshSketch::MeshSketch(std::string_view name, std::uint64_t expected_triangles) {
  scene_.name = name;
  scene_.triangles.reserve(expected_triangles + expected_triangles / 16);
  scene_.material_ids.reserve(expected_triangles + expected_triangles / 16);
}

MaterialId MeshSketch::material(std::string name, const Vec3& color, float roughness, const Vec3& emission) {
  scene_.materials.push_back({std::move(name), color, emission, roughness});
  return static_cast<MaterialId>(scene_.materials.size() - 1);
}

void MeshSketch::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Point vector = area_vector(a, b, c);
  if (vector.x == 0.0 && vector.y == 0.0 && vector.z == 0.0) return;
  scene_.triangles.push_back({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}});
  scene_.material_ids.push_back(current_);
}

void MeshSketch::quad(const Point& a, const Point& b, const Point& c, const Point& d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void MeshSketch::box(const Frame& frame, const Point& lo, const Point& hi) {
  std::array<Point, 8> v;
  for (unsigned i = 0; i < 8; ++i) {
    v[i] = frame.at((i & 1U) != 0 ? hi.x : lo.x, (i & 2U) != 0 ? hi.y : lo.y, (i & 4U) != 0 ? hi.z : lo.z);
  }
  quad(v[0], v[4], v[6], v[2]);
  quad(v[1], v[3], v[7], v[5]);
  quad(v[0], v[1], v[5], v[4]);
  quad(v[2], v[6], v[7], v[3]);
  quad(v[0], v[2], v[3], v[1]);
  quad(v[4], v[5], v[7], v[6]);
}

void MeshSketch::lathe(const Frame& frame, std::span<const glm::dvec2> profile, unsigned sides) {
  std::vector<Point> spokes(sides);
  for (unsigned i = 0; i < sides; ++i) {
    const double turns = static_cast<double>(i) / sides;
    spokes[i] = cos_turns(turns) * frame.x - sin_turns(turns) * frame.z;
  }
  sheet(
      sides, static_cast<unsigned>(profile.size() - 1),
      [&](unsigned i, unsigned j) {
        return frame.origin + profile[j].x * spokes[i] + profile[j].y * frame.y;
      },
      Rim::kClosed);
}

void MeshSketch::ellipsoid(const Frame& frame, const Point& radii, unsigned sides, unsigned rings) {
  Frame scaled = frame;
  scaled.x *= radii.x;
  scaled.z *= radii.z;
  std::vector<glm::dvec2> profile(rings + 1);
  for (unsigned j = 0; j <= rings; ++j) {
    const double turns = 0.5 * j / rings;
    profile[j] = {j == 0 || j == rings ? 0.0 : sin_turns(turns), -radii.y * cos_turns(turns)};
  }
  lathe(scaled, profile, sides);
}

void MeshSketch::tube(std::span<const Point> path, std::span<const double> radii, unsigned sides) {
  const auto last = static_cast<unsigned>(path.size() - 1);
  std::vector<std::pair<Point, Point>> axes(path.size());
  Point x = perpendicular(glm::normalize(path[1] - path[0]));
  for (unsigned j = 0; j <= last; ++j) {
    const Point along = glm::normalize(path[j < last ? j + 1 : last] - path[j > 0 ? j - 1 : 0]);
    const Point across =
        x - glm::dot(x, along) * along;  // carried on from ring to ring: the bar does not twist
    x = glm::dot(across, across) > 1e-12 ? glm::normalize(across) : perpendicular(along);
    axes[j] = {x, glm::cross(x, along)};
  }
  sheet(
      sides, last,
      [&](unsigned i, unsigned j) {
        const double turns = static_cast<double>(i) / sides;
        return path[j] + radii[j] * (cos_turns(turns) * axes[j].first - sin_turns(turns) * axes[j].second);
      },
      Rim::kClosed);
}

void MeshSketch::bar(const Point& from, const Point& to, double radius, unsigned sides) {
  const std::array<Point, 2> path{from, to};
  const std::array<double, 2> radii{radius, radius};
  tube(path, radii, sides);
}

void MeshSketch::limb(const Point& from, const Point& to, double radius_from, double radius_to,
                      unsigned sides, unsigned rings) {
  const Frame frame = aimed(from, to);
  const double length = glm::length(to - from);
  const unsigned cap = rings < 4 ? 1 : (rings - 1) / 2;
  std::vector<glm::dvec2> profile;
  for (unsigned j = 0; j <= cap; ++j) {
    const double turns = 0.25 * j / cap;
    profile.push_back({j == 0 ? 0.0 : radius_from * sin_turns(turns), -radius_from * cos_turns(turns)});
  }
  for (unsigned j = 0; j <= cap; ++j) {
    const double turns = 0.25 - 0.25 * j / cap;
    profile.push_back({j == cap ? 0.0 : radius_to * sin_turns(turns), length + radius_to * cos_turns(turns)});
  }
  lathe(frame, profile, sides);
}

void MeshSketch::camera(std::string name, const Point& eye, const Point& target, double fov_y,
                        double aspect) {
  Camera camera;
  camera.name = std::move(name);
  camera.position = to_vec3(eye);
  const Point forward = glm::normalize(target - eye);
  const Point right = glm::normalize(glm::cross(forward, Point{0.0, 1.0, 0.0}));
  camera.forward = to_vec3(forward);
  camera.up = to_vec3(glm::cross(right, forward));
  camera.fov_y = static_cast<float>(fov_y);
  camera.aspect = static_cast<float>(aspect);
  scene_.cameras.push_back(std::move(camera));
}

void MeshSketch::sun(const Point& travels, const Vec3& irradiance) {
  Light light;
  light.name = "sun";
  light.kind = LightKind::kDirectional;
  light.direction = to_vec3(glm::normalize(travels));
  light.color = irradiance;
  scene_.lights.push_back(std::move(light));
}

void MeshSketch::point_light(std::string name, const Point& position, const Vec3& intensity) {
  Light light;
  light.name = std::move(name);
  light.position = to_vec3(position);
  light.color = intensity;
  scene_.lights.push_back(std::move(light));
}

void MeshSketch::spot_light(std::string name, const Point& position, const Point& target,
                            const Vec3& intensity, double outer_cone) {
  Light light;
  light.name = std::move(name);
  light.kind = LightKind::kSpot;
  light.position = to_vec3(position);
  light.direction = to_vec3(glm::normalize(target - position));
  light.color = intensity;
  light.inner_cone = static_cast<float>(0.7 * outer_cone);
  light.outer_cone = static_cast<float>(outer_cone);
  scene_.lights.push_back(std::move(light));
}

Scene MeshSketch::finish() {
  add_area_lights(scene_);
  return std::exchange(scene_, Scene{});
}

}  // namespace gnomon
