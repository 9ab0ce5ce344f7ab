#include "gnomon/tree/hit_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace gnomon {

HitDifference difference_of(std::span<const GnHit> exact, std::span<const GnHit> other) {
  assert(exact.size() == other.size());
  HitDifference sum;
  sum.rays = exact.size();
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const GnHit& a = exact[i];
    const GnHit& b = other[i];
    const bool hit = a.primitive != GN_NONE;
    const bool found = b.primitive != GN_NONE;
    sum.hits += hit ? 1 : 0;
    if (!hit && !found) continue;
    const double t = a.t;
    const double off = found && hit ? b.t - t : hit ? 1.0 : -1.0;
    const double near = hit && found ? 1e-4 * std::fabs(t) : 0.0;
    if (off > near) {
      sum.lost += 1;
    } else if (off < -near) {
      sum.added += 1;
    } else if (a.primitive != b.primitive) {
      sum.other_triangle += off != 0.0 ? 1 : 0;
    } else {
      const double ulp = std::ldexp(1.0, t == 0.0 ? -149 : std::max(std::ilogb(t) - 23, -149));
      sum.max_t_ulp = std::max(sum.max_t_ulp, std::fabs(off) / ulp);
    }
  }
  return sum;
}

HitDifference difference_of(std::span<const std::uint32_t> exact, std::span<const std::uint32_t> other) {
  assert(exact.size() == other.size());
  HitDifference sum;
  sum.rays = exact.size();
  for (std::size_t i = 0; i < exact.size(); ++i) {
    sum.hits += exact[i] != 0 ? 1 : 0;
    sum.lost += exact[i] != 0 && other[i] == 0 ? 1 : 0;
    sum.added += exact[i] == 0 && other[i] != 0 ? 1 : 0;
  }
  return sum;
}

}  // namespace gnomon
