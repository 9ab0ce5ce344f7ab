// Comparisons of hit distances that must not be decided by rounding: against the ray's range, and with one
// another. The distances themselves come from exact_intersect (oracle.h). Feeds the oracle and the judge.
#pragma once

#include "gnomon/tree/oracle.h"

namespace gnomon {

// One triangle that a ray's line meets, with what exact_intersect said of it.
struct FoundHit {
  const Triangle* triangle = nullptr;
  ExactHit hit;
};

// A ray with finite origin and direction, the longest component of its direction between 2^-100 and 2^100 in
// magnitude, and no NaN in its range; others miss everything.
[[nodiscard]] bool is_traceable(const Ray& ray);

// The range that rays are traced in: their own, but for what lies beyond the largest float.
struct FiniteRange {
  explicit FiniteRange(const Ray& ray);
  float tmin;
  float tmax;
};

// Whether t is in the finite range, decided for the exact t.
[[nodiscard]] bool in_range(const Ray& ray, const FoundHit& found);

// Whether a's exact t is smaller than b's, both on the same ray.
[[nodiscard]] bool nearer(const Ray& ray, const FoundHit& a, const FoundHit& b);

}  // namespace gnomon
