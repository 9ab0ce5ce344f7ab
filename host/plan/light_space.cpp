#include "gnomon/plan/light_space.h"

#include <cmath>

#include "gnomon/shared/hit_math.h"
#include "gnomon/tree/box_frame.h"

namespace gnomon {

namespace {

double sum_of(const std::array<double, 3>& values) {
  return values[0] + values[1] + values[2];
}

}  // namespace

LightSpace light_space_of(std::span<const Ray> rays) {
  LightSpace out;
  std::array<double, 3> mean{};
  for (const Ray& ray : rays) {
    if (gn_ray_is_valid(&ray) == 0) continue;
    double square = 0.0;
    double along = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      square += double{ray.direction[k]} * double{ray.direction[k]};
      along += double{ray.direction[k]} * mean[k];
    }
    // A line has no sense: what runs the other way sees the same.
    const double by = (along < 0.0 ? -1.0 : 1.0) / std::sqrt(square);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += by * double{ray.direction[k]};
  }
  if (!(std::fabs(mean[0]) + std::fabs(mean[1]) + std::fabs(mean[2]) > 0.0)) return out;
  out.direction = mean;
  const std::vector<Ray> along = turned(rays, frame_along(mean, {}));
  const double seen = sum_of(mean_components(along));
  if (seen > 0.0) out.obliquity = sum_of(mean_components(rays)) / seen;
  return out;
}

double seen_total(const Bvh& bvh, const std::array<double, 3>& mean) {
  double sum = 0.0;
  for (const Node& node : bvh.nodes) {
    double extent[3];
    for (int k = 0; k < 3; ++k) extent[k] = double{node.hi[k]} - double{node.lo[k]};
    const double step = node.count > 0 ? kTriangleCost * node.count : 2.0 * kBoxCost;
    sum += step * (mean[0] * extent[1] * extent[2] + mean[1] * extent[0] * extent[2] +
                   mean[2] * extent[0] * extent[1]);
  }
  return sum;
}

}  // namespace gnomon
