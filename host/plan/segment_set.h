// Sampled segments against boxes: which of them meet one, as a mask of bits, many at a time. Not public.
// Feeds optimise_for_rays, child orders.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/plan/optimise_for_rays.h"
#include "gnomon/shared/reinsert_math.h"

namespace gnomon {

// A bit for each segment of a set.
struct SegmentMask {
  static constexpr std::size_t kWords = kMostSegments / 64;
  std::array<std::uint64_t, kWords> words{};

  [[nodiscard]] bool any() const {
    std::uint64_t all = 0;
    for (const std::uint64_t word : words) all |= word;
    return all != 0;
  }
  [[nodiscard]] std::uint32_t count() const {
    int sum = 0;
    for (const std::uint64_t word : words) sum += std::popcount(word);
    return static_cast<std::uint32_t>(sum);
  }
  SegmentMask& operator|=(const SegmentMask& other) {
    for (std::size_t w = 0; w < kWords; ++w) words[w] |= other.words[w];
    return *this;
  }
  friend SegmentMask operator|(SegmentMask a, const SegmentMask& b) { return a |= b; }
};

// Rays with their ranges, neighbours side by side: those that meet a small box are then bits of few words.
class SegmentSet {
 public:
  // Rays that are not traceable are left out. around: the scene.
  SegmentSet(std::span<const Ray> segments, const GnBox& around);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const SegmentMask& all() const { return all_; }
  // The ray of each bit.
  [[nodiscard]] std::span<const Ray> rays() const { return rays_; }

  // Bits of `open` whose segments meet the box (gn_box_entry), of those in word `word`.
  [[nodiscard]] std::uint64_t meets(std::size_t word, std::uint64_t open, const GnBox& box);
  // Adds to `known` what of `within` meets the box.
  void meet(const GnBox& box, const SegmentMask& within, SegmentMask& known);

  // Work so far: 64 segments at once, and single ones.
  [[nodiscard]] std::uint64_t wide_tests() const { return wide_tests_; }
  [[nodiscard]] std::uint64_t single_tests() const { return single_tests_; }

 private:
  static constexpr std::size_t kLanes = 64;
  struct alignas(64) Block {
    std::array<std::array<float, kLanes>, 3> origin, inverse;
    std::array<std::array<std::uint32_t, kLanes>, 3> backwards;  // all bits where the direction is negative
    std::array<float, kLanes> tmin, limit;
  };
  [[nodiscard]] static bool lane_meets(const Block& block, std::size_t lane, const GnBox& box);
  [[nodiscard]] static std::uint64_t block_meets(const Block& block, const GnBox& box);

  std::vector<Block> blocks_;
  std::vector<Ray> rays_;
  SegmentMask all_;
  std::size_t size_ = 0;
  std::uint64_t wide_tests_ = 0;
  std::uint64_t single_tests_ = 0;
};

}  // namespace gnomon
