#include "gnomon/measure/prediction.h"

#include <cmath>
#include <limits>

#include "gnomon/areas/cone_weights.h"
#include "gnomon/measure/all_pierced.h"
#include "gnomon/measure/node_box.h"

namespace gnomon {
namespace {

// What a node adds to the cost of a ray that pierces it.
double cost_of(const Node& node) {
  return node.count > 0 ? kPiercedTriangleCost * node.count : kPiercedInnerCost;
}

double surface_of(const Box3d& box) {
  return 2.0 * weighted_measure({1.0, 1.0, 1.0}, box);
}

}  // namespace

double predicted_cost(const Bvh& bvh, const InfluenceArea& area, RayMeasure measure, RayStart start) {
  const double window = window_measure(area, measure);
  double cost = 0.0;
  for (const Node& node : bvh.nodes)
    cost += cost_of(node) * (culled_measure(area, box_of(node), measure, start) / window);
  return cost;
}

double predicted_surface_cost(const Bvh& bvh) {
  if (bvh.nodes.empty()) return 0.0;
  const double root = surface_of(box_of(bvh.nodes.front()));
  double cost = 0.0;
  for (const Node& node : bvh.nodes)
    cost += cost_of(node) * (root > 0.0 ? smaller(1.0, surface_of(box_of(node)) / root) : 1.0);
  return cost;
}

double prediction_error(double real, double predicted) {
  if (real == predicted) return 0.0;
  return predicted > 0.0 ? std::abs(real - predicted) / predicted : std::numeric_limits<double>::infinity();
}

}  // namespace gnomon
