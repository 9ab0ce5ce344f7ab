// Improving a finished binary tree by moving subtrees to where they cost less (host/notes/best-builder.md),
// in plain C++: what the device's optimiser (optimise_device.h) is tested against, bit for bit. Feeds the
// best builder's reference, tests and tools.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"
#include "gnomon/tree/depth_map.h"

namespace gnomon {

struct OptimiseOptions {
  // What boxes cost: w . (dy dz, dx dz, dx dy). 1 each is surface area (SAH); |n| are parallel rays along n
  // (PAH), and mixtures of both are other weights (kernels/shared/measure_math.h). >= 0, finite.
  std::array<float, 3> face_weights{1.0F, 1.0F, 1.0F};
  // Beside face weights: rays of areas, of any measure, less where a depth map says that they are stopped
  // before. At most GN_MOST_COST_AREAS.
  std::vector<AreaCost> areas{};
  // Beside both: segments of rays that stand for what is traced, from tmin to tmax, as closest rays end at
  // their hit. Traceable. A search tests each against every box it looks at.
  std::vector<GnRay> segments{};
  float segments_share = 4.0F;  // what a box that all segments meet costs, in faces of the root; >= 0, finite
  std::uint32_t max_passes = 6;  // 0..64
  float share = 0.05F;           // of the nodes, the most costly ones, that a pass tries to move; (0, 1]
  float least_gain = 0.01F;      // passes end when one saves less than this share of the cost; [0, 1)
  // A node for which no better place was found is searched for again only once something below its
  // grandparent has moved: a third of the searches or less, for half a percent more cost at most.
  bool leave_settled = false;
  std::uint32_t max_depth =
      96;  // a pass that makes the tree deeper than this and than it was is taken back; 1..128

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// The tree with its inner nodes' cost brought down by parallel reinsertion (Meister, Bittner 2018): leaves
// stay, what is above them changes, and a triangle that one leaf holds twice is held once. Numbered as
// builders number. Any boxes will do: leaves' are kept. Throws Error: kInvalidArgument (options; a tree
// deeper than 128).
[[nodiscard]] Bvh optimise_reference(const Bvh& bvh, const OptimiseOptions& options = {});

// What each node's box costs by face weights, areas and segments, scaled as optimising a tree with this root
// scales them. Throws Error{kInvalidArgument} (options).
[[nodiscard]] std::vector<float> box_costs(const Bvh& bvh, const OptimiseOptions& options);

// Segments as box costs read them, GN_SEGMENT_PLANES planes.
[[nodiscard]] std::vector<float> segment_planes(std::span<const GnRay> segments);

// What a segment that meets a box costs, where the root's faces cost root_faces; 0 where there is none.
[[nodiscard]] float cost_per_segment(const OptimiseOptions& options, float root_faces);

// Throws Error{kInvalidArgument} for a tree deeper than the search's stacks can follow.
void require_depth(std::uint32_t depth);

// What passes are decided by: how many nodes cost what, and what the inner ones cost together.
struct TreeWeight {
  std::vector<std::uint32_t> bins;  // nodes but the root, by gn_cost_bin
  std::uint64_t units = 0;          // GN_ROOT_UNITS is the root's cost
  std::uint32_t depth = 0;
};

// The lowest bin of the `share` of the nodes that cost most; at least the highest bin that is not empty.
[[nodiscard]] std::uint32_t candidate_floor(std::span<const std::uint32_t> bins, float share);

// Factor from a cost to units; 0 for a tree that is too small or flat to be measured, which is left as it is.
[[nodiscard]] float units_of(float root_cost);

// The passes, the same decisions for device and reference. Steps: weigh() -> TreeWeight of the tree as it is
// now; move(floor) tries to move nodes that cost as much and returns how many it moved; take_back() undoes
// the last move.
template <typename Steps>
void run_passes(Steps& steps, const OptimiseOptions& options) {
  TreeWeight before = steps.weigh();
  const std::uint32_t deepest = before.depth > options.max_depth ? before.depth : options.max_depth;
  for (std::uint32_t pass = 0; pass < options.max_passes; ++pass) {
    if (steps.move(candidate_floor(before.bins, options.share)) == 0) return;
    TreeWeight after = steps.weigh();
    if (after.depth > deepest || after.units > before.units) {
      steps.take_back();
      return;
    }
    const double saved = static_cast<double>(before.units - after.units);
    if (saved < static_cast<double>(options.least_gain) * static_cast<double>(before.units)) return;
    before = std::move(after);
  }
}

}  // namespace gnomon
