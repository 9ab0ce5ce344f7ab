#include "gnomon/tree/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gnomon {

namespace {

// Three coordinates of many points: corner k of a block along the filter's axes.
struct Corner {
  const float* x;
  const float* y;
  const float* z;
};

}  // namespace

LineFilter::LineFilter(const GnRay& ray) : origin_{ray.origin[0], ray.origin[1], ray.origin[2]} {
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::fabs(ray.direction[axis]) > std::fabs(ray.direction[longest])) longest = axis;
  }
  axes_ = {(longest + 1) % 3, (longest + 2) % 3, longest};
  for (std::size_t i = 0; i < 2; ++i) {
    slope_[i] = static_cast<float>(static_cast<double>(ray.direction[axes_[i]]) / ray.direction[longest]);
  }
}

LineFilter::Block::Block(std::span<const GnTriangle> triangles) : count(triangles.size()) {
  lo.fill(std::numeric_limits<float>::infinity());
  hi.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    const float* const source[3] = {triangles[i].v0, triangles[i].v1, triangles[i].v2};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float value = source[corner][axis];
        corners[corner][axis][i] = value;
        lo[axis] = value < lo[axis] ? value : lo[axis];
        hi[axis] = value > hi[axis] ? value : hi[axis];
      }
    }
  }
}

// The largest coordinate of any corner seen from the origin, rounded down by less than one part in 2^23.
float LineFilter::reach(const Block& block) const {
  float largest = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest = std::max(
        {largest, std::fabs(block.lo[axis] - origin_[axis]), std::fabs(block.hi[axis] - origin_[axis])});
  }
  return largest;
}

// Seen along the line a corner is at (X - sx Z, Y - sy Z), the line at (0, 0). A triangle all of whose
// corners are on one side of it in x or in y, by more than rounding can explain, is not met. With h = 2^-24
// the computed X - s Z is within 2.1 h |X| + 4.1 h |Z| of the exact one (|s| <= 1; the subtractions of the
// origin, the slope, the product and the last subtraction each round once), so within 6.3 h of the reach; 8 h
// leave room for the reach's own rounding and for underflow, which moves nothing by more than 2^-124.
std::size_t LineFilter::mark(const Block& block, float slack, Indices& marks) const {
  const auto corner = [&](std::size_t k) {
    return Corner{block.corners[k][axes_[0]], block.corners[k][axes_[1]], block.corners[k][axes_[2]]};
  };
  const Corner a = corner(0);
  const Corner b = corner(1);
  const Corner c = corner(2);
  const float ox = origin_[axes_[0]];
  const float oy = origin_[axes_[1]];
  const float oz = origin_[axes_[2]];
  const float sx = slope_[0];
  const float sy = slope_[1];
  std::uint32_t total = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    const float az = a.z[i] - oz;
    const float bz = b.z[i] - oz;
    const float cz = c.z[i] - oz;
    const float ax = (a.x[i] - ox) - sx * az;
    const float bx = (b.x[i] - ox) - sx * bz;
    const float cx = (c.x[i] - ox) - sx * cz;
    const float ay = (a.y[i] - oy) - sy * az;
    const float by = (b.y[i] - oy) - sy * bz;
    const float cy = (c.y[i] - oy) - sy * cz;
    const float min_x = gn_min(gn_min(ax, bx), cx);
    const float max_x = gn_max(gn_max(ax, bx), cx);
    const float min_y = gn_min(gn_min(ay, by), cy);
    const float max_y = gn_max(gn_max(ay, by), cy);
    marks[i] = static_cast<std::uint32_t>(min_x <= slack) & static_cast<std::uint32_t>(max_x >= -slack) &
               static_cast<std::uint32_t>(min_y <= slack) & static_cast<std::uint32_t>(max_y >= -slack);
    total += marks[i];
  }
  return total;
}

std::size_t LineFilter::keep(const Block& block, Indices& kept) const {
  const float extent = reach(block);
  // Outside these bounds a product could overflow, or underflow to something that matters: then nothing is
  // dropped.
  if (!(extent >= 0x1p-60F && extent <= 0x1p60F)) {
    std::iota(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(block.count), 0U);
    return block.count;
  }
  Indices marks;
  if (mark(block, 0x1p-21F * extent, marks) == 0) return 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    if (marks[i] != 0) kept[count++] = static_cast<std::uint32_t>(i);
  }
  return count;
}

}  // namespace gnomon
