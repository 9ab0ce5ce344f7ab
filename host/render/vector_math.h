// The vector type of the picture's arithmetic and its way from and to the scene's. Feeds the files of
// host/render.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gnomon/scene/scene.h"

namespace gnomon {

using Point = glm::dvec3;  // points, directions and colours alike
using Point2 = glm::dvec2;

[[nodiscard]] inline Point to_point(const float* v) {
  return {v[0], v[1], v[2]};
}
[[nodiscard]] inline Point to_point(const Vec3& v) {
  return to_point(v.data());
}
[[nodiscard]] inline Vec3 to_vec3(const Point& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// How bright a linear colour looks (Rec. 709 weights).
[[nodiscard]] inline double luminance(const Point& color) {
  return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

// Two unit vectors that make a right-handed frame with the unit vector `normal`.
struct Tangents {
  Point x;
  Point y;
};
[[nodiscard]] inline Tangents tangents_of(const Point& normal) {
  const Point other = normal.y < -0.9 || normal.y > 0.9 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0};
  const Point x = glm::normalize(glm::cross(other, normal));
  return {x, glm::cross(normal, x)};
}

}  // namespace gnomon
