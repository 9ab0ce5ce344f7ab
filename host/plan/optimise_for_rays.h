// Moving a tree's subtrees to where sampled rays have the least to do: reinsertion (optimise.h) with boxes
// weighed by the share of sampled segments that meet them. Areas model rays as endless lines; segments know
// where rays begin, end and are stopped. Plain C++, on the host, one move after the other. Feeds plans,
// benches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

// More segments than this are thinned to it.
inline constexpr std::uint32_t kMostSegments = 512;

struct SampleMeasure {
  // A box weighs its share of the segments plus prior_share times its measure by these weights over the
  // root's: the areas decide where no sampled segment came. mixed_weights() makes them.
  std::array<float, 3> face_weights{1.0F, 1.0F, 1.0F};
  float prior_share = 0.25F;  // > 0, at most 1000

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

struct SampledOptions {
  std::uint32_t least_met = 2;   // nodes that fewer segments meet are not looked into; from 1
  float least_saved = 1.5F;      // moves that spare the segments no more boxes than this are not made; >= 0
  double most_work = 1e12;       // in box tests: the moves that promise most come first; >= 0, finite
  std::uint32_t max_depth = 96;  // a tree that would become deeper than this and than it was stays as it is

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

struct SampledTree {
  Bvh bvh;
  std::vector<float> measures;  // of its nodes, for merge_leaves
  double saved = 0.0;           // share of the inner nodes' weight that is gone
  double work = 0.0;            // what it took, in box tests of a tracer (PlanPrices)
};

// The tree with its inner nodes' weight brought down. Segments are rays with their ranges (segments_of);
// `bvh` is numbered as builders number (bvh.h). Deterministic. Throws Error{kInvalidArgument} (options).
[[nodiscard]] SampledTree optimise_for_rays(const Bvh& bvh, std::span<const Ray> segments,
                                            const SampleMeasure& measure, const SampledOptions& options = {});

}  // namespace gnomon
