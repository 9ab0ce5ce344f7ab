#include "gnomon/plan/optimise_for_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "gnomon/base/error.h"
#include "gnomon/shared/ray_math.h"
#include "gnomon/shared/reinsert_math.h"
#include "gnomon/tree/optimiser.h"

namespace gnomon {

namespace {

// Which segments meet a box.
using Mask = std::array<std::uint64_t, kMostSegments / 64>;

GnBox box_of(const Node& node) {
  GnBox box;
  gn_load_box(&node, &box);
  return box;
}

GnBox around(const GnBox& a, const GnBox& b) {
  GnBox both;
  for (int k = 0; k < 3; ++k) {
    both.lo[k] = gn_min(a.lo[k], b.lo[k]);
    both.hi[k] = gn_max(a.hi[k], b.hi[k]);
  }
  return both;
}

// What boxes weigh, and where a node would weigh least (as gn_find_move searches). A larger box is met by all
// the segments that meet a smaller one inside it, so few are left to be tested: those that meet the box
// around both and neither of the two.
class SampleCosts {
 public:
  SampleCosts(std::span<const Ray> segments, const SampleMeasure& measure) : measure_(measure) {
    for (const Ray& ray : thinned(segments, kMostSegments)) {
      if (gn_ray_is_valid(&ray) == 0) continue;
      segments_.push_back(
          {gn_ray_frame(&ray), gn_finite_tmin(ray.tmin), gn_slab_limit(gn_finite_tmax(ray.tmax))});
    }
    words_ = (segments_.size() + 63) / 64;
    if (!segments_.empty()) per_segment_ = 1.0F / static_cast<float>(segments_.size());
  }

  void prepare(const std::vector<Node>& slots) {
    if (masks_.empty()) {
      const float root = linear(box_of(slots[GN_ROOT_SLOT]));
      per_measure_ = root > 0.0F ? measure_.prior_share / root : 0.0F;
    }
    masks_.resize(slots.size() * words_);
    costs_.resize(slots.size());
    Mask all{};
    for (std::size_t i = 0; i < segments_.size(); ++i) all[i / 64] |= std::uint64_t{1} << (i % 64);
    meet(slots, GN_ROOT_SLOT, all);
    std::vector<std::uint32_t> open{GN_ROOT_SLOT};
    while (!open.empty()) {
      const Node& node = slots[open.back()];
      const Mask within = mask_of(open.back());
      open.pop_back();
      if (!is_inner_slot(node)) continue;
      for (const std::uint32_t child : {node.first, node.first + 1}) {
        meet(slots, child, within);
        open.push_back(child);
      }
    }
  }

  [[nodiscard]] float of(const std::vector<Node>&, std::uint32_t slot) const { return costs_[slot]; }

  [[nodiscard]] GnMove find(const std::vector<Node>& slots, const std::vector<std::uint32_t>& above,
                            std::uint32_t node) {
    Search search{slots, node, box_of(slots[node]), mask_of(node), costs_[node], {}, {}, GN_SEARCH_PAIRS};
    std::uint32_t pivot = above[node / 2];
    std::uint32_t beside = node ^ 1U;
    GnMove& move = search.move;
    move = {node, GN_NONE, 0, GN_LEAST_GAIN * search.own, 0, pivot, {0, 0}};
    // Where no segment comes the areas' passes before this one have had their say.
    if (!meets_any(node)) return move;
    GnBox shrunk = box_of(slots[beside]);  // of what will be left of the pivot
    Mask shrunk_mask = mask_of(beside);
    float saved = costs_[pivot];
    bool first = true;
    while (true) {
      const Mask within = mask_of(pivot);
      Mask joint;
      const float gain = saved - joint_cost(search, beside, within, joint);
      if (!first && gain > move.gain) {
        move.gain = gain;
        move.target = beside;
        move.pivot = pivot;
      }
      if (is_inner_slot(slots[beside]) && gain + costs_[beside] - search.own > move.gain)
        search.waiting.push_back({slots[beside].first, gain + costs_[beside], joint});
      search_below(search, pivot);
      if (!first) {
        for (std::size_t w = 0; w < words_; ++w) shrunk_mask[w] |= masks_[beside * words_ + w];
        shrunk = around(shrunk, box_of(slots[beside]));
        saved += costs_[pivot] - cost_within(shrunk, within, shrunk_mask);
      }
      const GnBox whole = box_of(slots[pivot]);
      const bool same =
          std::equal(shrunk.lo, shrunk.lo + 3, whole.lo) && std::equal(shrunk.hi, shrunk.hi + 3, whole.hi);
      // Where the pivot does not shrink, nothing above it does.
      if (pivot == GN_ROOT_SLOT || search.left == 0 || (same && saved - search.own <= move.gain)) return move;
      beside = pivot ^ 1U;
      pivot = above[pivot / 2];
      first = false;
    }
  }

  [[nodiscard]] float cost_of(const Node& node) {
    Mask all;
    all.fill(~std::uint64_t{0});
    Mask none{};
    return cost_within(box_of(node), all, none);
  }
  [[nodiscard]] std::uint64_t tests() const { return tests_; }

 private:
  struct Segment {
    GnRayFrame frame;
    float tmin;
    float limit;
  };
  // A pair whose parent may take the node in; joint: what meets the box around the parent and the node.
  struct Waiting {
    std::uint32_t first;
    float saved;
    Mask joint;
  };
  struct Search {
    const std::vector<Node>& slots;
    std::uint32_t node;
    GnBox box;
    Mask mask;
    float own;
    GnMove move;
    std::vector<Waiting> waiting;
    std::uint32_t left;  // pairs it may still look at
  };

  [[nodiscard]] float linear(const GnBox& box) const {
    return gn_linear_measure(measure_.face_weights.data(), box.lo, box.hi);
  }

  [[nodiscard]] bool meets_any(std::uint32_t slot) const {
    for (std::size_t w = 0; w < words_; ++w) {
      if (masks_[slot * words_ + w] != 0) return true;
    }
    return false;
  }

  [[nodiscard]] Mask mask_of(std::uint32_t slot) const {
    Mask mask{};
    for (std::size_t w = 0; w < words_; ++w) mask[w] = masks_[slot * words_ + w];
    return mask;
  }

  void meet(const std::vector<Node>& slots, std::uint32_t slot, const Mask& within) {
    Mask mask{};
    costs_[slot] = cost_within(box_of(slots[slot]), within, mask);
    for (std::size_t w = 0; w < words_; ++w) masks_[slot * words_ + w] = mask[w];
  }

  // known: segments that surely meet the box; becomes all that do. within: those that may. Once it is clear
  // that the box costs `enough` or more the rest is not tested, and something from there up is returned.
  float cost_within(const GnBox& box, const Mask& within, Mask& known, float enough = GN_INFINITY) {
    std::uint32_t met = 0;
    const float areas = linear(box);
    for (std::size_t w = 0; w < words_; ++w) {
      if (cost(met, areas) >= enough) break;
      std::uint64_t open = within[w] & ~known[w];
      while (open != 0) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(open));
        open &= open - 1;
        if (64 * w + bit >= segments_.size()) break;
        const Segment& segment = segments_[64 * w + bit];
        tests_ += 1;
        if (gn_box_entry(&segment.frame, box.lo, box.hi, segment.tmin, segment.limit) < GN_INFINITY)
          known[w] |= std::uint64_t{1} << bit;
      }
      met += static_cast<std::uint32_t>(std::popcount(known[w]));
    }
    return cost(met, areas);
  }

  [[nodiscard]] float cost(std::uint32_t met, float linear_measure) const {
    return static_cast<float>(met) * per_segment_ + linear_measure * per_measure_;
  }

  float joint_cost(const Search& search, std::uint32_t slot, const Mask& within, Mask& joint,
                   float enough = GN_INFINITY) {
    for (std::size_t w = 0; w < words_; ++w) joint[w] = search.mask[w] | masks_[slot * words_ + w];
    return cost_within(around(search.box, box_of(search.slots[slot])), within, joint, enough);
  }

  // What joining costs at least: without a test.
  [[nodiscard]] float least_joint_cost(const Search& search, std::uint32_t slot) const {
    std::uint32_t met = 0;
    for (std::size_t w = 0; w < words_; ++w)
      met += static_cast<std::uint32_t>(std::popcount(search.mask[w] | masks_[slot * words_ + w]));
    return cost(met, linear(around(search.box, box_of(search.slots[slot]))));
  }

  void search_below(Search& search, std::uint32_t pivot) {
    GnMove& move = search.move;
    while (!search.waiting.empty() && search.left > 0) {
      const Waiting next = search.waiting.back();
      search.waiting.pop_back();
      if (!(next.saved - search.own > move.gain)) continue;
      search.left -= 1;
      std::array<Waiting, 2> below{};
      for (std::uint32_t side = 0; side < 2; ++side) {
        const std::uint32_t slot = next.first + side;
        const bool inner = is_inner_slot(search.slots[slot]);
        const float hope = next.saved - least_joint_cost(search, slot);
        below[side].saved = -GN_INFINITY;
        if (!(hope > move.gain) && !(inner && hope + costs_[slot] - search.own > move.gain)) continue;
        const float reach =
            inner ? gn_max(0.0F, costs_[slot] - search.own) : 0.0F;  // what may be saved below it
        const float enough = next.saved + reach - move.gain;
        const float gain = next.saved - joint_cost(search, slot, next.joint, below[side].joint, enough);
        if (gain > move.gain) {
          move.gain = gain;
          move.target = slot;
          move.pivot = pivot;
        }
        if (!inner) continue;
        below[side].first = search.slots[slot].first;
        below[side].saved = gain + costs_[slot];
      }
      // The more promising one is looked at first.
      const std::size_t better = below[1].saved > below[0].saved ? 1 : 0;
      for (const std::size_t side : {1 - better, better}) {
        if (below[side].saved - search.own > move.gain) search.waiting.push_back(below[side]);
      }
    }
  }

  const SampleMeasure& measure_;
  std::vector<Segment> segments_;
  std::size_t words_ = 0;
  float per_segment_ = 0.0F;
  float per_measure_ = 0.0F;
  std::vector<std::uint64_t> masks_;  // words_ a slot
  std::vector<float> costs_;
  std::uint64_t tests_ = 0;
};

}  // namespace

void SampleMeasure::check() const {
  for (const float w : face_weights) {
    if (w >= 0.0F && std::isfinite(w)) continue;
    throw Error(ErrorCode::kInvalidArgument, "sample option face_weights = " + std::to_string(w) +
                                                 " is outside its range of finite numbers >= 0");
  }
  if (prior_share > 0.0F && prior_share <= 1000.0F) return;
  throw Error(ErrorCode::kInvalidArgument, "sample option prior_share = " + std::to_string(prior_share) +
                                               " is outside its range (0, 1000]");
}

SampledTree optimise_for_rays(const Bvh& bvh, std::span<const Ray> segments, const SampleMeasure& measure,
                              const OptimiseOptions& options) {
  options.check();
  measure.check();
  if (bvh.nodes.empty()) return {bvh, {}, 0};
  SampleCosts costs(segments, measure);
  SampledTree out;
  out.bvh = Optimiser<SampleCosts>(bvh, options, costs).run();
  out.segment_tests = costs.tests();
  out.measures.reserve(out.bvh.nodes.size());
  for (const Node& node : out.bvh.nodes) out.measures.push_back(costs.cost_of(node));
  return out;
}

}  // namespace gnomon
