// Moving a tree's subtrees to where sampled rays have the least to do: reinsertion (optimise.h) with boxes
// weighed by the share of sampled segments that meet them. Areas model rays as endless lines; segments know
// where rays begin, end and are stopped. Plain C++, on the host. Feeds plans, benches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/plan/ray_sample.h"
#include "gnomon/tree/optimise.h"

namespace gnomon {

// More segments than this are thinned to it.
inline constexpr std::uint32_t kMostSegments = 1024;

struct SampleMeasure {
  // A box weighs its share of the segments plus prior_share times its measure by these weights over the
  // root's: the areas decide where no sampled segment came. mixed_weights() makes them.
  std::array<float, 3> face_weights{1.0F, 1.0F, 1.0F};
  float prior_share = 0.5F;  // > 0, at most 1000

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

struct SampledTree {
  Bvh bvh;
  std::vector<float> measures;      // of its nodes, for merge_leaves
  std::uint64_t segment_tests = 0;  // of segments against boxes: the work it took
};

// The tree with its inner nodes' weight brought down; options.face_weights are not read. Segments are rays
// with their ranges (segments_of); nodes that none of them meets stay where they are. Deterministic. Throws
// Error{kInvalidArgument} (options; a tree deeper than 128).
[[nodiscard]] SampledTree optimise_for_rays(const Bvh& bvh, std::span<const Ray> segments,
                                            const SampleMeasure& measure,
                                            const OptimiseOptions& options = {});

}  // namespace gnomon
