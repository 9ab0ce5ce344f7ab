#include "gnomon/scene/ray_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "gnomon/scene/morton_grid.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

using Point = glm::dvec3;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::array<std::string_view, 5> kKindNames{"primary", "bounce", "shadow", "random", "parallel"};

Point to_point(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Ray make_ray(const Point& origin, const Point& direction) {
  Ray ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(origin[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  ray.tmax = kInfinity;
  return ray;
}

// The bounds as a box that is never empty: an empty scene counts as a unit box around the origin.
struct Box {
  Point lo;
  Point hi;
  [[nodiscard]] Point middle() const { return 0.5 * (lo + hi); }
  [[nodiscard]] double diagonal() const { return glm::length(hi - lo); }
};
Box box_of(const Scene& scene) {
  if (scene.triangles.empty()) return {Point{-0.5}, Point{0.5}};
  const Bounds bounds = bounds_of(scene);
  return {to_point(bounds.lo), to_point(bounds.hi)};
}

// Right and up for rays along `forward`.
struct Axes {
  Point right;
  Point up;
};
Axes axes_across(const Point& forward) {
  const Point other = std::abs(forward.y) < 0.99 ? Point{0.0, 1.0, 0.0} : Point{0.0, 0.0, 1.0};
  const Point right = glm::normalize(glm::cross(forward, other));
  return {right, glm::cross(right, forward)};
}

}  // namespace

std::string_view to_string(RayKind kind) {
  return kKindNames[static_cast<std::size_t>(kind)];
}

std::optional<RayKind> ray_kind_from(std::string_view name) {
  const auto* const found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<RayKind>(found - kKindNames.begin());
}

bool asks_any_hit(RayKind kind) {
  return kind == RayKind::kShadow || kind == RayKind::kParallel;
}

bool run_together(RayKind kind, const Scene& scene) {
  if (kind == RayKind::kShadow)
    return scene.lights.empty() || (scene.lights.size() == 1 && scene.lights[0].kind != LightKind::kArea);
  return kind == RayKind::kPrimary || kind == RayKind::kParallel;
}

Camera default_camera(const Scene& scene) {
  const Box box = box_of(scene);
  const Point back = glm::normalize(Point{0.55, 0.4, 1.0});
  const double reach = box.diagonal() > 0.0 ? box.diagonal() : 1.0;
  Camera camera;
  camera.name = "default";
  camera.fov_y = 0.8F;
  // At 1.35 diagonals the sphere around the bounds (radius 0.5) fills 0.76 radians: all of it is in view.
  const Point eye = box.middle() + 1.35 * reach * back;
  const Axes axes = axes_across(-back);
  for (int axis = 0; axis < 3; ++axis) {
    camera.position[axis] = static_cast<float>(eye[axis]);
    camera.forward[axis] = static_cast<float>(-back[axis]);
    camera.up[axis] = static_cast<float>(axes.up[axis]);
  }
  return camera;
}

std::vector<Ray> primary_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed) {
  const Camera camera = scene.cameras.empty() ? default_camera(scene) : scene.cameras.front();
  const double aspect = camera.aspect > 0.0F ? camera.aspect : 1.0;
  const Point forward = to_point(camera.forward);
  const Point up = to_point(camera.up);
  const double half_turns = static_cast<double>(camera.fov_y) / (4.0 * kPi);
  const double half_height = sin_turns(half_turns) / cos_turns(half_turns);
  const Point rise = half_height * up;
  const Point side = half_height * aspect * glm::cross(forward, up);
  std::vector<Ray> rays;
  rays.reserve(count);
  for_each_cell(count, aspect, seed, [&](double u, double v) {
    const Point direction = forward + (2.0 * u - 1.0) * side + (1.0 - 2.0 * v) * rise;
    rays.push_back(make_ray(to_point(camera.position), glm::normalize(direction)));
  });
  return rays;
}

std::vector<Ray> random_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed) {
  const Box box = box_of(scene);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    SteadyRandom random(seed, i);
    const double x = random.unit();
    const double y = random.unit();
    const Point share{x, y, random.unit()};
    const double height = random.between(-1.0, 1.0);  // Archimedes: uniform height, uniform on the sphere
    const double radius = std::sqrt(std::max(0.0, 1.0 - height * height));
    const double turns = random.unit();
    rays.push_back(make_ray(box.lo + share * (box.hi - box.lo),
                            {radius * cos_turns(turns), height, radius * sin_turns(turns)}));
  }
  return rays;
}

std::vector<Ray> parallel_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed) {
  Point forward{0.0, -1.0, 0.0};
  const auto sun = std::find_if(scene.lights.begin(), scene.lights.end(),
                                [](const Light& light) { return light.kind == LightKind::kDirectional; });
  if (sun != scene.lights.end()) forward = glm::normalize(to_point(sun->direction));
  const Axes axes = axes_across(forward);
  const Box box = box_of(scene);
  // A box's half extent along a direction is the sum of its half sides' shares.
  const Point half = 0.5 * (box.hi - box.lo);
  const auto reach = [&](const Point& axis) {
    return glm::dot(half, glm::abs(axis)) + 1e-6 * box.diagonal();
  };
  const double wide = std::max(reach(axes.right), 1e-30);
  const double high = std::max(reach(axes.up), 1e-30);
  const Point start = box.middle() - (reach(forward) + 0.01 * box.diagonal()) * forward;
  std::vector<Ray> rays;
  rays.reserve(count);
  for_each_cell(count, wide / high, seed, [&](double u, double v) {
    rays.push_back(
        make_ray(start + (2.0 * u - 1.0) * wide * axes.right + (1.0 - 2.0 * v) * high * axes.up, forward));
  });
  return rays;
}

}  // namespace gnomon
