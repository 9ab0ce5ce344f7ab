// The thesis' tests run again on one set-up: its four builders on its triangles and rays, and three-axis
// trees beside them. Counts and costs only; what they are compared with is the caller's business
// (published_results). Feeds the command line.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/areas/ray_measure.h"
#include "gnomon/base/progress.h"
#include "gnomon/measure/all_pierced.h"
#include "gnomon/measure/published_builder.h"
#include "gnomon/measure/set_up.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

// Builds a tree: build_reference, or a device's.
using TreeBuilder = std::function<Bvh(std::span<const GnTriangle>, const BuildOptions&)>;

struct ReproduceOptions {
  std::uint64_t rays = 1000;               // of the thesis' caster, for every cost
  std::uint64_t prediction_rays = 256000;  // for the check of predictions: 0.1 % noise
  std::uint64_t seed = 1;
};

// A scene and its global tree, which all its set-ups share. The thesis' program kept triangles without area
// (InvalidPolicy::kKeepFlat): they cost in its trees although nothing hits them. Ours leave them out.
struct ReproduceScene {
  Scene scene;
  std::string hash;
  Bvh global;  // the thesis' own
};
[[nodiscard]] ReproduceScene prepare_scene(Scene scene, const TreeBuilder& build);

// Boxes and triangles tested a ray.
struct Work {
  double boxes = 0.0;
  double triangles = 0.0;
};

// One tree on one set-up, on rays of one measure. Costs are all-pierced ones.
struct TreeRun {
  std::string builder;     // "Full" ... "TrueLongest", "SAH3", "PAH3"
  std::string heuristics;  // what it really is
  std::string members;     // how its triangles were chosen: "octree-vertices" or "exact"
  RayMeasure rays = RayMeasure::kParallel;
  std::uint64_t triangles = 0;
  BvhStats stats;
  double build_ms = 0.0;
  // Axes whose planes were tried, over inner nodes (thesis: attempted planes). Where leaves hold several
  // triangles this passes 3: leaves were tried as well.
  double planes_tried = 0.0;
  std::array<double, 3> axis_share{};           // of inner nodes that are divided along x, y, z
  std::array<double, 3> axis_fallback_share{};  // of inner nodes whose policy fell back on x, y, z
  MeanCost local;
  double predicted_published = 0.0;  // PAH as the thesis measures it: by area in the window's plane
  double predicted_matching = 0.0;   // by the rays' own measure
  double predicted_surface = 0.0;    // SAH
  Work closest;                      // ordered and pruned
  Work any;
  double local_hit_share = 0.0;
  double global_hit_share = 0.0;
  MeanCost global;         // of the global tree alone
  double miss_cost = 0.0;  // of the global tree, over rays that miss the local one
  MeanCost total;          // local, and on a miss the global tree from the start
  // The share of hits from which local and fallback beat the global tree alone; none without misses.
  std::optional<double> break_even_hit_share;
  std::array<double, 5> overlap{};  // to levels 4, 7, 10, 15 and all
};

// How well the measures predict on rays of one of them.
struct PredictionRun {
  RayMeasure rays = RayMeasure::kParallel;
  RayMeasure measure = RayMeasure::kParallel;
  bool surface = false;  // predicted by SAH, not by `measure`
  MeanCost real;
  double predicted = 0.0;
};

struct SetUpReport {
  std::vector<TreeRun> trees;
  std::vector<PredictionRun> predictions;
};

// The measures of an area's rays, the thesis' caster's first.
[[nodiscard]] std::vector<RayMeasure> ray_measures_of(const InfluenceArea& area);

// Runs the published variants that the set-up names; and where Full is among them (the others repeat a set-up
// with another window) TrueLongest for points, SAH3 and PAH3 for every measure of rays, and the check of
// predictions on the PAH3 trees. Throws Error: kInvalidArgument (an unknown variant), kBadScene (no triangle
// in the area), kCancelled.
[[nodiscard]] SetUpReport run_set_up(const SetUp& set_up, const ReproduceScene& scene,
                                     const ReproduceOptions& options, const TreeBuilder& build,
                                     const Progress& progress = {});

// The check of predictions alone, for an area that the thesis has not.
[[nodiscard]] std::vector<PredictionRun> check_predictions(const InfluenceArea& area,
                                                           const ReproduceScene& scene,
                                                           const ReproduceOptions& options,
                                                           const TreeBuilder& build);

}  // namespace gnomon
