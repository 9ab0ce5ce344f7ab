// What the failure map knows of one tree under one light: counts and predictions, no times. Feeds the bench
// of failures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cases.h"
#include "gnomon/measure/all_pierced.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon::bench {

// The batches that every tree of a light is measured with.
struct CaseRays {
  std::vector<GnRay> own;     // the light's, as its measure says
  std::vector<GnRay> shadow;  // from what a camera sees to the light
  std::vector<GnRay> other;   // from anywhere to anywhere: they know nothing of the light
};
[[nodiscard]] CaseRays rays_of(const CaseScene& scene, const LightCase& light, std::uint64_t count);

// Boxes and triangles tested a ray, nearest child first and pruned, on the binary tree.
struct Work {
  double boxes = 0.0;
  double triangles = 0.0;
  // In the thesis' unit: a box 1, a triangle 1.2.
  [[nodiscard]] double cost() const { return boxes + kPiercedTriangleCost * triangles; }
};

struct TreeFigures {
  Bvh tree;
  SplitTally tally;
  BvhStats stats;
  double idle_share = 0.0;          // of inner nodes both of whose children measure as much as they do
  std::optional<double> overlap_4;  // of siblings, to level 4, as the rays see them
  double predicted = 0.0;           // all-pierced cost of the light's rays, by their own measure
  double predicted_surface = 0.0;   // by surface area
  MeanCost pierced;                 // what it is
  Work closest;                     // the light's rays
  Work any;
  Work shadow;
  Work other;
};

[[nodiscard]] TreeFigures figures_of(const CaseScene& scene, const LightCase& light, const Method& method,
                                     const CaseRays& rays);

[[nodiscard]] Work work_of(const Bvh& tree, std::span<const GnTriangle> triangles,
                           std::span<const GnRay> rays, bool any_hit);

}  // namespace gnomon::bench
