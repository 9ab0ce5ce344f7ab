// Rays aimed at what tracers lose: corners, edges, faces' planes. Feeds the cases and the soak.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "gnomon/stability/meshes.h"

namespace gnomon::stability {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

[[nodiscard]] Ray ray_of(const Point& origin, const Point& direction, float tmin = 0.0F,
                         float tmax = kInfinity);

[[nodiscard]] Point middle_of(const Point& a, const Point& b);

// From `origin` to `target`, which it meets at t = 1 exactly where floats hold the difference.
[[nodiscard]] Ray towards(const Point& origin, const Point& target);

// Whether the ray has the point exactly at t = 1.
[[nodiscard]] bool passes_exactly(const Ray& ray, const Point& target);

// A ray that meets the target at t = 1, exactly so nearly always: its direction's components are multiples of
// the target's last bits, not longer than the target's coordinates or `reach`. For scenes at any place.
[[nodiscard]] Ray through(const Point& target, float reach, SteadyRandom& random);

// A point of the triangle: a corner (0), the middle of an edge (1), about its middle (2).
[[nodiscard]] Point place_on(const Triangle& triangle, std::uint32_t kind, SteadyRandom& random);

// Bounds of all corners.
struct Extent {
  Point lo;
  Point hi;
  [[nodiscard]] float size() const;  // the longest side
};
[[nodiscard]] Extent extent_of(std::span<const Triangle> triangles);

}  // namespace gnomon::stability
