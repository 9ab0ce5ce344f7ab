#include "gnomon/areas/clip.h"

namespace gnomon {

Polygon3d clip(const Polygon3d& polygon, const Plane& plane) {
  Polygon3d kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d& p = polygon[i];
    const Vec3d& q = polygon[(i + 1) % polygon.size()];
    const double p_side = signed_distance(plane, p);
    const double q_side = signed_distance(plane, q);
    if (p_side >= 0.0) kept.push_back(p);
    if ((p_side > 0.0 && q_side < 0.0) || (p_side < 0.0 && q_side > 0.0)) {
      kept.push_back(p + p_side / (p_side - q_side) * (q - p));
    }
  }
  return kept;
}

Polygon3d clip(Polygon3d polygon, std::span<const Plane> planes) {
  for (const Plane& plane : planes) {
    if (polygon.empty()) break;
    polygon = clip(polygon, plane);
  }
  return polygon;
}

}  // namespace gnomon
