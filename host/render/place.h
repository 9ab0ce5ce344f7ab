// Where rays hit, and rays from there. Feeds light_rays.cpp and render.cpp.
#pragma once

#include <cstdint>

#include "gnomon/render/sample_pattern.h"
#include "gnomon/render/vector_math.h"
#include "gnomon/scene/ray_set.h"

namespace gnomon {

// A point of a surface, moved off it a little to the side its ray came from.
struct Place {
  Point position;
  Point normal;  // unit, on that side
  Point albedo;
  std::uint32_t pixel;   // that its light ends up in
  std::uint32_t sample;  // of that pixel

  [[nodiscard]] Point2 random(std::uint64_t seed, std::uint32_t purpose) const {
    return sample_point(seed, pixel, purpose, sample);
  }
};

// What random numbers are for.
enum Purpose : std::uint32_t {
  kWithinPixel,
  kAmbientDirection,
  kLightChoice,
  kLightPoints,  // the rest: two for each light
};

[[nodiscard]] inline Ray make_ray(const Point& origin, const Point& direction, double tmax) {
  Ray ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(origin[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  ray.tmax = static_cast<float>(tmax);
  return ray;
}

}  // namespace gnomon
