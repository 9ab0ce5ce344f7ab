// What the tests of generators, export and ray sets share: plain geometry in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <vector>

#include "gnomon/scene/ray_set.h"
#include "gnomon/scene/scene.h"

namespace gnomon_test {

using Point = glm::dvec3;

inline Point to_point(const float* v) {
  return {v[0], v[1], v[2]};
}
inline Point to_point(const gnomon::Vec3& v) {
  return {v[0], v[1], v[2]};
}

// Twice the area times the unit normal.
inline Point area_vector(const gnomon::Triangle& t) {
  return glm::cross(to_point(t.v1) - to_point(t.v0), to_point(t.v2) - to_point(t.v0));
}

// The nearest hit by trying every triangle (Moeller and Trumbore).
inline gnomon::Hit nearest_hit(const gnomon::Scene& scene, const gnomon::Ray& ray) {
  gnomon::Hit best{std::numeric_limits<float>::infinity(), 0.0F, 0.0F, GN_NONE};
  const Point origin = to_point(ray.origin);
  const Point direction = to_point(ray.direction);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const gnomon::Triangle& triangle = scene.triangles[i];
    const Point e1 = to_point(triangle.v1) - to_point(triangle.v0);
    const Point e2 = to_point(triangle.v2) - to_point(triangle.v0);
    const Point p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) continue;
    const Point s = (origin - to_point(triangle.v0)) / determinant;
    const Point q = glm::cross(s, e1);
    const double u = glm::dot(s, p);
    const double v = glm::dot(direction, q);
    const double t = glm::dot(e2, q);
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t < static_cast<double>(ray.tmin) ||
        t >= static_cast<double>(best.t))
      continue;
    best = {static_cast<float>(t), static_cast<float>(u), static_cast<float>(v),
            static_cast<std::uint32_t>(i)};
  }
  return best;
}

inline std::vector<gnomon::Hit> nearest_hits(const gnomon::Scene& scene,
                                             const std::vector<gnomon::Ray>& rays) {
  std::vector<gnomon::Hit> hits;
  for (const gnomon::Ray& ray : rays) hits.push_back(nearest_hit(scene, ray));
  return hits;
}

// How far a point is from a triangle (closest point by Ericson, Real-Time Collision Detection, 5.1.5).
inline double distance_to(const gnomon::Triangle& t, const Point& p) {
  const Point a = to_point(t.v0);
  const Point b = to_point(t.v1);
  const Point c = to_point(t.v2);
  const auto to_segment = [&](const Point& from, const Point& to) {
    const double along = glm::dot(p - from, to - from) / glm::dot(to - from, to - from);
    return glm::length(p - from - std::min(1.0, std::max(0.0, along)) * (to - from));
  };
  const Point normal = glm::normalize(glm::cross(b - a, c - a));
  const Point foot = p - glm::dot(p - a, normal) * normal;
  const bool inside = glm::dot(glm::cross(b - a, foot - a), normal) >= 0.0 &&
                      glm::dot(glm::cross(c - b, foot - b), normal) >= 0.0 &&
                      glm::dot(glm::cross(a - c, foot - c), normal) >= 0.0;
  if (inside) return std::abs(glm::dot(p - a, normal));
  return std::min(to_segment(a, b), std::min(to_segment(b, c), to_segment(c, a)));
}

inline double clearance(const gnomon::Scene& scene, const Point& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const gnomon::Triangle& t : scene.triangles) nearest = std::min(nearest, distance_to(t, p));
  return nearest;
}

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline bool same_rays(const std::vector<gnomon::Ray>& a, const std::vector<gnomon::Ray>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(gnomon::Ray)) == 0;
}

// A square floor of side 4 at y = 0 under a camera at height 2 that looks straight down.
inline gnomon::Scene floor_scene() {
  gnomon::Scene scene;
  scene.materials.resize(1);
  scene.triangles = {{{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}}, {{-2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}};
  scene.material_ids = {0, 0};
  gnomon::Camera camera;
  camera.position = {0.0F, 2.0F, 0.0F};
  camera.forward = {0.0F, -1.0F, 0.0F};
  camera.up = {0.0F, 0.0F, -1.0F};
  camera.fov_y = 1.2F;
  scene.cameras = {camera};
  return scene;
}

// A folder of its own that is gone at the end of the test.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("gnomon-" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& file) const { return path_ / file; }
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace gnomon_test
