// The split sweep of a serial group where three face weights measure all and nothing but evenness settles ties: surface area
// and its like, which most builds are. The same split as sweep_three_axes, found without a chain of comparisons from plane to
// plane: extents of all that is left and right of every plane first, then costs of two planes side by side and their minimum,
// then the first of the most even among the cheapest. Device only. Feeds sweep.h.
#ifndef GNOMON_FACE_SWEEP_H
#define GNOMON_FACE_SWEEP_H

#include "group.h"

#if GN_WGS == 1

// Beyond so many primitives a plane's evenness and number do not fit one word.
#define GN_FACE_SWEEP_MOST (1u << 25)
#define GN_PLANE_BITS 6u

// Extents of what is on one side of every plane: a row per axis it was binned along, four floats a plane.
typedef struct GnSideExtents {
  float along[3][4u * (GN_BINS + 1u)];
} GnSideExtents;

// hi - lo rounds like -(lo + -hi), which a bin's two halves are.
static inline void store_extents(GnSideExtents* out, uint plane, float8 along_x, float8 along_y, float8 along_z) {
  vstore4(-(along_x.lo + along_x.hi), plane, out->along[0]);
  vstore4(-(along_y.lo + along_y.hi), plane, out->along[1]);
  vstore4(-(along_z.lo + along_z.hi), plane, out->along[2]);
}

// Measures of the sides of two neighbouring planes, lane by axis; lanes 3 and 7 are nobody's. In two steps, of two vectors
// each, as a shuffle takes them.
static inline float8 measures_at(const GnSideExtents* in, uint plane, const float* w) {
  const float8 a = vload8(0, in->along[0] + 4u * plane);
  const float8 b = vload8(0, in->along[1] + 4u * plane);
  const float8 c = vload8(0, in->along[2] + 4u * plane);
  const float8 ab = (float8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5);
  const float8 ab_z = (float8)(a.s2, b.s2, a.s2, b.s2, a.s6, b.s6, a.s6, b.s6);
  const float8 x = (float8)(ab.s0, ab.s1, c.s0, c.s0, ab.s4, ab.s5, c.s4, c.s4);
  const float8 y = (float8)(ab.s2, ab.s3, c.s1, c.s1, ab.s6, ab.s7, c.s5, c.s5);
  const float8 z = (float8)(ab_z.s0, ab_z.s1, c.s2, c.s2, ab_z.s4, ab_z.s5, c.s6, c.s6);
  return x * (w[1] * z + w[2] * y) + w[0] * y * z;
}

// As sweep_three_axes. bin_count: 2 .. GN_BINS.
static inline void sweep_by_faces(const float* w, __local const GnBin* bins, __local const uint* counts, uint bin_count,
                                  uint count, __local GnSplit* best_of_axis) {
  const uint planes = bin_count - 1u;
  GnSideExtents left, right;
  int seen[4u * (GN_BINS + 1u)];
  float8 cost[GN_BINS / 2u + 1u], left_measure[GN_BINS / 2u + 1u], right_measure[GN_BINS / 2u + 1u];
  float8 x = (float8)(INFINITY), y = x, z = x, other_x = x, other_y = x, other_z = x;
  int4 so_far = (int4)(0);
  uint i, axis;
  for (i = 0u; i < planes; ++i) {
    const uint j = planes - i;
    x = GN_VMIN(GN_BIN_AT(bins, 0u, i), x);
    y = GN_VMIN(GN_BIN_AT(bins, 1u, i), y);
    z = GN_VMIN(GN_BIN_AT(bins, 2u, i), z);
    so_far += (int4)((int)counts[i], (int)counts[GN_BINS + i], (int)counts[2u * GN_BINS + i], 0);
    store_extents(&left, i, x, y, z);
    vstore4(so_far, i, seen);
    other_x = GN_VMIN(GN_BIN_AT(bins, 0u, j), other_x);
    other_y = GN_VMIN(GN_BIN_AT(bins, 1u, j), other_y);
    other_z = GN_VMIN(GN_BIN_AT(bins, 2u, j), other_z);
    store_extents(&right, j - 1u, other_x, other_y, other_z);
  }
  // An odd one out has a neighbour that divides nothing.
  store_extents(&left, planes, x, y, z);
  store_extents(&right, planes, x, y, z);
  vstore4((int4)(0), planes, seen);

  float8 least = (float8)(INFINITY);
  for (i = 0u; i < planes; i += 2u) {
    const int8 here = vload8(0, seen + 4u * i);
    const int8 rest = (int8)((int)count) - here;
    const float8 lefts = measures_at(&left, i, w), rights = measures_at(&right, i, w);
    const float8 both = lefts * convert_float8(here) + rights * convert_float8(rest);
    const float8 valid = select((float8)(INFINITY), both, (here > 0) & (rest > 0));
    cost[i / 2u] = valid;
    left_measure[i / 2u] = lefts;
    right_measure[i / 2u] = rights;
    least = GN_VMIN(valid, least);
  }
  least.lo = GN_VMIN(least.lo, least.hi);
  least.hi = least.lo;
  // Evenness, then the lower plane: one number, the larger the better.
  int8 rank = (int8)(-1);
  int8 turned = (int8)((int4)((1 << GN_PLANE_BITS) - 1), (int4)((1 << GN_PLANE_BITS) - 2));
  for (i = 0u; i < planes; i += 2u) {
    const int8 here = vload8(0, seen + 4u * i);
    const int8 even = min(here, (int8)((int)count) - here);
    rank = max(rank, select((int8)(-1), (even << (int8)((int)GN_PLANE_BITS)) | turned, cost[i / 2u] == least));
    turned -= 2;
  }
  {
    float costs[4];
    int ranks[4];
    vstore4(least.lo, 0, costs);
    vstore4(max(rank.lo, rank.hi), 0, ranks);
    for (axis = 0u; axis < 3u; ++axis) {
      GnSplit split = gn_no_split();
      if (costs[axis] < INFINITY) {
        const uint plane = (1u << GN_PLANE_BITS) - 1u - ((uint)ranks[axis] & ((1u << GN_PLANE_BITS) - 1u));
        split.cost = costs[axis];
        split.axis = axis;
        split.plane = plane;
        split.left_count = (uint)seen[4u * plane + axis];
        split.tie = 0.0f;
        split.left_measure = ((const float*)left_measure)[4u * plane + axis];
        split.right_measure = ((const float*)right_measure)[4u * plane + axis];
      }
      best_of_axis[axis] = split;
    }
  }
}

#endif  // GN_WGS == 1

#endif
