// How the answers of one batch differ from the exact ones: what less accuracy costs in hits. Feeds `trace`
// and the bench of accuracy.
#pragma once

#include <cstdint>
#include <span>

#include "gnomon/shared/layout.h"

namespace gnomon {

struct HitDifference {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;            // by the exact answers
  std::uint64_t lost = 0;            // of them, not found, or one farther by more than 1e-4 of t in its place
  std::uint64_t added = 0;           // where there is none, or one nearer by more than that
  std::uint64_t other_triangle = 0;  // as far within 1e-4, but another triangle at another t
  double max_t_ulp = 0.0;            // how far t is off at most, of hits of the same triangle
  [[nodiscard]] std::uint64_t wrong() const { return lost + added + other_triangle; }
};

// Both or neither of each pair are given; their lengths are equal.
[[nodiscard]] HitDifference difference_of(std::span<const GnHit> exact, std::span<const GnHit> other);
// Any-hit answers, 0 or 1.
[[nodiscard]] HitDifference difference_of(std::span<const std::uint32_t> exact,
                                          std::span<const std::uint32_t> other);

}  // namespace gnomon
