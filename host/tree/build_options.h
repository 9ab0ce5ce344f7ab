// What a caller may ask of a builder, with ranges. Feeds the reference builder and the device builder alike.
#pragma once

#include <cstdint>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/shared/build_layout.h"

namespace gnomon {

// How a tree is built.
enum class Builder : std::uint32_t {
  kBalanced,  // top down, binned over three axes, by any measure
  kFast,      // along the Morton curve, bottom up, by surface area: host/notes/fast-builder.md
  kBest,      // balanced over parts of large triangles, then optimised: host/notes/best-builder.md
};
[[nodiscard]] const char* to_string(Builder builder);

// Which axes a node may be divided along (kernels/shared/axis_policy.h).
enum class AxisPolicy : std::uint32_t {
  kAll = GN_AXES_ALL,    // the cheapest split of all three
  kSpfh = GN_AXES_SPFH,  // splitting plane facing heuristic: axes the area's rays cross least, others as a
                         // fallback
  kLsph = GN_AXES_LSPH,  // longest side plane heuristic: long axes first
};
[[nodiscard]] const char* to_string(AxisPolicy policy);

// The thesis' builder. Its constants are those of its program.
struct PublishedRules {
  float quality_threshold = 0.4F;  // axes of less quality are not tried but for the fallback; [0, 1]
  float acceptable = 1.3F;  // ratio of the children's probabilities to the father's: no fallback; (0, 1e6]
  float excellent = 0.9F;   // no other axis either; (0, 1e6]
  bool rays_from_point = false;  // SPFH with a measure that is not itself of a point: from measure.origin
  bool repaired = true;  // false: an earlier split is forgotten at the fallback, and metrics are mixed
  std::uint32_t max_metric_depth =
      100;  // maxNonFallbackLevels: from here on surface area and long axes; 0..1000
};

// How the thesis' program ends a tree, instead of by cost.
struct PublishedLeaves {
  bool on = false;                // also bins barycentres over the node's box, as that program does
  std::uint32_t min_split = 2;    // maxTrianglesPerLeaf: fewer make a leaf; 1..255
  std::uint32_t max_depth = 100;  // maxLevels: deeper nodes are leaves; 1..1000
  float max_cost = 0.0F;          // maxLeafCost: cheaper nodes are leaves; >= 0
  float max_probability = 0.0F;   // maxLeafHitProbability: less probable ones; [0, 1]
  float max_area = 0.0F;          // maxLeafArea: of smaller surface area; >= 0
};

// Half the surface area: rays from everywhere (Goldsmith & Salmon 1987; MacDonald & Booth 1990).
[[nodiscard]] GnMeasure surface_area_measure();

struct BuildOptions {
  // kFast reads bins, max_leaf_size and the costs; it refuses other measures, axis policies, published_leaves
  // and another median_depth. kBest takes measures that three face weights express (surface area, parallel rays, their
  // mixtures) and all axes; its leaf order may name a triangle in several leaves.
  Builder builder = Builder::kBalanced;
  // What a box's hit probability is taken to be. Others than surface area: gnomon/areas/measure.h.
  // measure.area_share mixes one with surface area.
  GnMeasure measure = surface_area_measure();
  AxisPolicy axes = AxisPolicy::kAll;
  PublishedRules policy;  // read unless axes is kAll
  PublishedLeaves published_leaves;
  std::uint32_t bins = 16;          // per axis, 2..64
  std::uint32_t max_leaf_size = 8;  // triangles, 1..255
  float cost_traversal = 1.0F;      // of visiting an inner node, in the unit of cost_triangle; (0, 1000]
  float cost_triangle = 1.0F;       // of testing one triangle; (0, 1000]
  std::uint32_t median_depth =
      64;  // from this depth on nodes are halved by count: bounds depth at + log2(n); 1..64

  // How the device works, never what it builds: 0 asks the device.
  std::uint32_t work_group_size = 0;  // power of two up to 256; 1: the serial flavour
  std::uint32_t subtree_size = 0;     // triangles one work-group builds alone; 32..1048576
  std::uint32_t chunk_size = 0;       // triangles one work-group bins in a large node; 64..1048576

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// The measure and axis policy in a word: "sah", "pah-solid-angle", "sah+spfh" ...
[[nodiscard]] std::string heuristic_name(const BuildOptions& options);

// The options as the builders' shared code reads them, settled for a scene with this box.
[[nodiscard]] GnHeuristic heuristic_of(const BuildOptions& options, const float lo[3], const float hi[3]);

}  // namespace gnomon
