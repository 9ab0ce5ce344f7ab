#include "gnomon/tree/oracle.h"

#include <array>
#include <cassert>
#include <limits>

#include "gnomon/tree/candidates.h"
#include "gnomon/tree/exact_hit.h"

namespace gnomon {

OracleHit oracle_closest(const Ray& ray, std::span<const Triangle> triangles) {
  assert(triangles.size() < GN_NONE);
  OracleHit closest{std::numeric_limits<double>::infinity(), GN_NONE};
  if (!is_traceable(ray)) return closest;
  FoundHit best;
  const std::array<LineFilter, 1> filter{LineFilter(ray)};
  visit_candidates(filter, triangles, [&](std::size_t, std::uint32_t index) {
    const FoundHit found{&triangles[index], exact_intersect(ray, triangles[index])};
    if (!found.hit.inside || !in_range(ray, found)) return;
    if (best.triangle != nullptr && !nearer(ray, found, best))
      return;  // indices ascend: the lowest of equals stays
    best = found;
    closest = {found.hit.t, index};
  });
  return closest;
}

}  // namespace gnomon
