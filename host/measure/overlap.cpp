#include "gnomon/measure/overlap.h"

#include <vector>

#include "gnomon/measure/node_box.h"

namespace gnomon {

double sibling_overlap(const Bvh& bvh, const InfluenceArea& area, RayMeasure measure,
                       std::uint32_t max_level) {
  struct Place {
    std::uint32_t node;
    std::uint32_t level;
  };
  std::vector<Place> waiting;
  if (!bvh.nodes.empty()) waiting.push_back({0, 1});
  double shared = 0.0;
  double possible = 0.0;
  while (!waiting.empty()) {
    const Place at = waiting.back();
    waiting.pop_back();
    const Node& node = bvh.nodes[at.node];
    if (node.count > 0 || at.level > max_level) continue;
    const Polygon2d left = culled_hull(area, box_of(bvh.nodes[node.first]), measure);
    const Polygon2d right = culled_hull(area, box_of(bvh.nodes[node.first + 1]), measure);
    shared += area_of(intersection_of(left, right));
    possible += smaller(area_of(left), area_of(right));
    waiting.push_back({node.first, at.level + 1});
    waiting.push_back({node.first + 1, at.level + 1});
  }
  return possible > 0.0 ? shared / possible : 0.0;
}

}  // namespace gnomon
