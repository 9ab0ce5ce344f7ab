// The numbers that claims are checked by. Feeds claims.cpp alone.
#pragma once

#include <cmath>

#include "claims.h"
#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/projection.h"
#include "gnomon/measure/node_box.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/scene/steady_random.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon::bench {

inline constexpr std::uint64_t kManyRays = 20000;

inline double of_sah(const Look& look, const std::string& method, Work TreeFigures::*work) {
  return (look.trees.at(method).*work).cost() / (look.trees.at("SAH").*work).cost();
}

inline double pierced_of_sah(const Look& look, const std::string& method) {
  return look.trees.at(method).pierced.mean / look.trees.at("SAH").pierced.mean;
}

inline double error_of(const TreeFigures& tree, double predicted) {
  return prediction_error(tree.pierced.mean, predicted);
}

inline double share_split_on(const TreeFigures& tree, std::size_t axis) {
  return static_cast<double>(tree.tally.split_on[axis]) / static_cast<double>(tree.tally.inner_nodes);
}

inline std::size_t main_axis(const Vec3d& d) {
  const auto size = [&](std::size_t k) { return std::fabs(d[k]); };
  return size(0) >= size(1) && size(0) >= size(2) ? 0 : size(1) >= size(2) ? 1 : 2;
}

// Of inner nodes those that none of the light's rays meet.
inline double unseen_share(const Look& look, const TreeFigures& tree) {
  double inner = 0.0;
  double unseen = 0.0;
  for (const Node& node : tree.tree.nodes) {
    if (node.count > 0) continue;
    inner += 1.0;
    unseen += culled_measure(look.light.area, box_of(node), look.light.rays) == 0.0 ? 1.0 : 0.0;
  }
  return unseen / inner;
}

// Any hit of the shadow rays that reach the light, or of those that do not, over SAH's tree.
inline double shadow_of_sah(const Look& look, const std::string& method, bool lit) {
  const std::vector<GnTriangle>& triangles = look.scene.scene.triangles;
  const Bvh& sah = look.trees.at("SAH").tree;
  const auto hits = trace_reference(sah, triangles, look.rays.shadow, true).hits;
  std::vector<GnRay> chosen;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if ((hits[i].primitive == GN_NONE) == lit) chosen.push_back(look.rays.shadow[i]);
  }
  return work_of(look.trees.at(method).tree, triangles, chosen, true).cost() /
         work_of(sah, triangles, chosen, true).cost();
}

// Lines from everywhere through the root's box: what surface area takes all rays for.
inline double surface_error(const TreeFigures& tree) {
  const Box3d root = box_of(tree.tree.nodes.front());
  const Vec3d middle = 0.5 * (root.lo + root.hi);
  const double radius = 0.5 * length(root.hi - root.lo);
  const auto seeds =
      area_rays(InfluenceArea::omni(middle, radius), RayMeasure::kSolidAngle, kManyRays, kMeasureSeed);
  SteadyRandom random(kMeasureSeed);
  std::vector<double> costs;
  for (const GnRay& seed : seeds) {
    const Vec3d d{seed.direction[0], seed.direction[1], seed.direction[2]};
    const AreaFrame frame = look_along(middle - 2.0 * radius * d, d, kWorldUp);
    double x = 0.0;
    double y = 0.0;
    do {
      x = random.between(-1.0, 1.0);
      y = random.between(-1.0, 1.0);
    } while (x * x + y * y > 1.0);
    const Ray3d line{to_world(frame, {radius * x, radius * y, 0.0}), d};
    if (intersect(line, root)) costs.push_back(all_pierced_cost(tree.tree, line));
  }
  return prediction_error(mean_of(costs).mean, tree.predicted_surface);
}

// How often two trees' means over 1000 rays each, of different seeds, name another one as cheaper than their
// exact predictions do.
inline double wrong_ranks(const Look& look, const TreeFigures& a, const TreeFigures& b) {
  constexpr int kTrials = 40;
  int wrong = 0;
  for (int i = 0; i < kTrials; ++i) {
    const auto sample = [&](const TreeFigures& tree, int which) {
      const auto seed = kFitSeed + 2 * static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(which);
      return mean_of(all_pierced_costs(tree.tree, area_rays(look.light.area, look.light.rays, 1000, seed)))
          .mean;
    };
    wrong += (sample(a, 0) < sample(b, 1)) != (a.predicted < b.predicted) ? 1 : 0;
  }
  return static_cast<double>(wrong) / kTrials;
}

// The policy with nothing barred: every axis is tried.
inline double unbarred_of_sah(const Look& look, const std::string& method) {
  Method free = method_named(look.light, method);
  free.options.policy.quality_threshold = 0.0F;
  free.options.policy.excellent = free.options.policy.acceptable = 1e-6F;
  const Bvh tree = build_reference(look.scene.scene.triangles, free.options);
  return work_of(tree, look.scene.scene.triangles, look.rays.own, false).cost() /
         look.trees.at("SAH").closest.cost();
}

}  // namespace gnomon::bench
