// The oracle's fast lane: for each ray, which triangles its line might meet. It looks at every triangle (no
// tree, no boxes of several triangles) and drops only those that provably lie to one side of the line. Not
// for deciding hits: exact_hit does. Feeds oracle and judge.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gnomon/shared/layout.h"

namespace gnomon {

// A ray's line as the filter needs it: with d[axis] the largest component, the point at depth z along that
// axis is at origin + slope * z in the two others.
class LineFilter {
 public:
  explicit LineFilter(const GnRay& ray);

  static constexpr std::size_t kBlock = 256;  // triangles tested at a time: 9 KiB, stays in the first cache

  // Corner coordinates, one array for each, and the extent of them all.
  struct Block {
    explicit Block(std::span<const GnTriangle> triangles);
    std::size_t count;
    std::array<float, 3> lo;
    std::array<float, 3> hi;
    alignas(64) float corners[3][3][kBlock];  // [corner][axis][triangle]
  };
  using Indices = std::array<std::uint32_t, kBlock>;

  // Writes the places in the block of all triangles that the line might meet, in order; returns how many.
  std::size_t keep(const Block& block, Indices& kept) const;

 private:
  [[nodiscard]] float reach(const Block& block) const;
  std::size_t mark(const Block& block, float slack, Indices& marks) const;

  std::array<float, 3> origin_;
  std::array<std::size_t, 3> axes_;  // the two short ones, then the long one
  std::array<float, 2> slope_;
};

// Calls visit(place of the ray in `filters`, triangle index) for every pair that the filter keeps, for each
// ray in ascending order of triangles. Several rays share the copying of triangles into blocks.
template <typename Visit>
void visit_candidates(std::span<const LineFilter> filters, std::span<const GnTriangle> triangles,
                      Visit&& visit) {
  LineFilter::Indices kept;
  for (std::size_t begin = 0; begin < triangles.size(); begin += LineFilter::kBlock) {
    const std::size_t size = std::min(LineFilter::kBlock, triangles.size() - begin);
    const LineFilter::Block block(triangles.subspan(begin, size));
    for (std::size_t ray = 0; ray < filters.size(); ++ray) {
      const std::size_t count = filters[ray].keep(block, kept);
      for (std::size_t i = 0; i < count; ++i) visit(ray, static_cast<std::uint32_t>(begin + kept[i]));
    }
  }
}

}  // namespace gnomon
