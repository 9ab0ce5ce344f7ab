#include "gnomon/measure/all_pierced.h"

#include <cmath>

#include "gnomon/measure/node_box.h"

namespace gnomon {

double all_pierced_cost(const Bvh& bvh, const Ray3d& ray) {
  if (bvh.nodes.empty()) return 0.0;
  double cost = 0.0;
  std::vector<std::uint32_t> waiting{0};
  while (!waiting.empty()) {
    const Node& node = bvh.nodes[waiting.back()];
    waiting.pop_back();
    if (!intersect(ray, box_of(node))) continue;
    if (node.count > 0) {
      cost += kPiercedTriangleCost * node.count;
    } else {
      cost += kPiercedInnerCost;
      waiting.push_back(node.first + 1);
      waiting.push_back(node.first);
    }
  }
  return cost;
}

std::vector<double> all_pierced_costs(const Bvh& bvh, std::span<const GnRay> rays) {
  std::vector<double> costs;
  costs.reserve(rays.size());
  for (const GnRay& ray : rays) costs.push_back(all_pierced_cost(bvh, to_ray3d(ray)));
  return costs;
}

MeanCost mean_of(std::span<const double> values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (count - 1.0) / count) : 0.0};
}

}  // namespace gnomon
