// Subtrees of a small tree moved, one after the other, to where sampled segments have the least to do. Not
// public. Feeds optimise_for_rays.
#pragma once

#include <array>
#include <cstdint>
#include <queue>
#include <vector>

#include "gnomon/plan/met_part.h"
#include "gnomon/plan/optimise_for_rays.h"

namespace gnomon {

class SampleMover {
 public:
  // All must outlive it.
  SampleMover(SegmentSet& segments, const MetPart& part, const SampleMeasure& measure);

  // Moves the node that promises most, then the next, until none promises enough or the work is done.
  void run(const SampledOptions& options);

  // The tree as it was given.
  void take_back();

  // The tree as it is now, children behind their parents, and its nodes' measures.
  [[nodiscard]] Bvh tree() const;
  [[nodiscard]] std::vector<float> measures() const;

  [[nodiscard]] float cost(std::uint32_t met, float areas) const {
    return static_cast<float>(met) * per_segment_ + areas * per_area_;
  }
  [[nodiscard]] float areas_of(const GnBox& box) const {
    return gn_linear_measure(measure_.face_weights.data(), box.lo, box.hi);
  }
  // Of the inner nodes' weight, the share that moves saved.
  [[nodiscard]] double saved() const { return weight_ > 0.0 ? gained_ / weight_ : 0.0; }
  // So far, in box tests of a tracer.
  [[nodiscard]] double work() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  struct Item {
    GnBox box;
    float cost = 0.0F;
    std::uint32_t parent = kNone;
    std::array<std::uint32_t, 2> children{kNone, kNone};
    std::uint32_t subtree = kNone;  // of a leaf, the part's
    std::uint32_t turn = 0;         // of what is queued for it only the newest counts
  };
  struct Queued {
    float promise;
    std::uint32_t item;
    std::uint32_t turn;
    bool operator<(const Queued& other) const {
      return promise < other.promise || (promise == other.promise && item > other.item);
    }
  };
  // An item below which the node may go; joint: what meets the box around it and the node.
  struct Waiting {
    std::uint32_t item;
    float saved;
    SegmentMask joint;
  };
  struct Place {
    std::uint32_t beside = kNone;
    std::uint32_t pivot = kNone;  // lowest item above both
    float gain = 0.0F;
  };

  [[nodiscard]] bool inner(std::uint32_t item) const { return items_[item].children[0] != kNone; }
  [[nodiscard]] std::uint32_t sibling(std::uint32_t item) const {
    const auto& pair = items_[items_[item].parent].children;
    return pair[0] == item ? pair[1] : pair[0];
  }
  void run_plain(const SampledOptions& options);
  void run_wide(const SampledOptions& options);
  [[nodiscard]] float promise(std::uint32_t item);
  [[nodiscard]] Place search(std::uint32_t item);
  [[nodiscard]] float cost_within(const GnBox& box, const SegmentMask& within, SegmentMask& known,
                                  float enough);
  Waiting weigh(std::uint32_t item, std::uint32_t beside, std::uint32_t pivot, float saved,
                const SegmentMask& within, bool own_sibling);
  void search_below(std::uint32_t item, std::uint32_t pivot);
  void wait(const Waiting& one, float own);
  void move(std::uint32_t item, const Place& place);
  void shrink(std::uint32_t from, std::uint32_t pivot);
  void grow(std::uint32_t item, std::uint32_t pivot);
  void queue(std::uint32_t item);

  SegmentSet& segments_;
  const MetPart& part_;
  const SampleMeasure& measure_;
  float per_segment_ = 0.0F;
  float per_area_ = 0.0F;
  float least_ = 0.0F;
  std::uint32_t root_ = 0;
  std::vector<Item> items_;
  std::vector<SegmentMask> masks_;  // one an item
  std::priority_queue<Queued> queue_;
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> chain_;
  Place best_;
  std::uint32_t left_ = 0;  // items this search may still look below
  double weight_ = 0.0;     // of the inner nodes as they were given
  double gained_ = 0.0;
  std::uint64_t bounds_ = 0;
  std::uint64_t searches_ = 0;
};

}  // namespace gnomon
