// Axis-aligned boxes in double precision. Feeds every file of this room.
#pragma once

#include <limits>

#include "gnomon/areas/vector.h"

namespace gnomon {

// All points with lo <= x <= hi. It may be flat; lo > hi on any axis is the empty box, which is the default.
struct Box3d {
  Vec3d lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3d hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
           -std::numeric_limits<double>::infinity()};
};

// Also true where a bound is NaN.
[[nodiscard]] inline bool is_empty(const Box3d& box) {
  return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

// One of its eight corners: bit k of `number` takes hi instead of lo on axis k.
[[nodiscard]] inline Vec3d corner_of(const Box3d& box, unsigned number) {
  Vec3d corner = box.lo;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if ((number >> axis & 1U) != 0) corner[axis] = box.hi[axis];
  }
  return corner;
}

// Exact, the boundary included.
[[nodiscard]] inline bool contains(const Box3d& box, const Vec3d& p) {
  bool inside = true;
  for (unsigned axis = 0; axis < 3; ++axis) inside &= box.lo[axis] <= p[axis] && p[axis] <= box.hi[axis];
  return inside;
}

// Whether they share a point; touching counts. Exact. (Thesis A.4.)
[[nodiscard]] inline bool overlap(const Box3d& a, const Box3d& b) {
  bool shared = !is_empty(a) && !is_empty(b);
  for (unsigned axis = 0; axis < 3; ++axis) shared &= a.lo[axis] <= b.hi[axis] && a.hi[axis] >= b.lo[axis];
  return shared;
}

inline void extend(Box3d& box, const Vec3d& p) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    box.lo[axis] = smaller(box.lo[axis], p[axis]);
    box.hi[axis] = larger(box.hi[axis], p[axis]);
  }
}

}  // namespace gnomon
