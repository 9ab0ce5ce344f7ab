// The split sweep of a serial group where three face weights measure all: surface area, parallel rays and their mixtures,
// which most builds are. The same split as gn_sweep_axis on each axis, found without a chain of comparisons from plane to
// plane: extents of all that is left and right of every plane first, then costs of two planes side by side and their
// minimum, then the first of the best among the cheapest. Bins are as a serial group leaves them (bin.h): lower corner,
// upper corner negated. Device only. Feeds sweep.h.
#ifndef GNOMON_FACE_SWEEP_H
#define GNOMON_FACE_SWEEP_H

#include "group.h"

#if GN_WGS == 1

// From so many primitives on a plane's evenness and number do not fit one word.
#define GN_FACE_SWEEP_MOST (1u << 26)
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

// Extents of the sides of two neighbouring planes, lane by axis; lanes 3 and 7 are nobody's. In two steps, of two vectors
// each, as a shuffle takes them.
typedef struct GnTwoSides {
  float8 x;
  float8 y;
  float8 z;
} GnTwoSides;

static inline GnTwoSides sides_at(const GnSideExtents* in, uint plane) {
  const float8 a = vload8(0, in->along[0] + 4u * plane);
  const float8 b = vload8(0, in->along[1] + 4u * plane);
  const float8 c = vload8(0, in->along[2] + 4u * plane);
  const float8 ab = (float8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5);
  const float8 ab_z = (float8)(a.s2, b.s2, a.s2, b.s2, a.s6, b.s6, a.s6, b.s6);
  GnTwoSides out;
  out.x = (float8)(ab.s0, ab.s1, c.s0, c.s0, ab.s4, ab.s5, c.s4, c.s4);
  out.y = (float8)(ab.s2, ab.s3, c.s1, c.s1, ab.s6, ab.s7, c.s5, c.s5);
  out.z = (float8)(ab_z.s0, ab_z.s1, c.s2, c.s2, ab_z.s4, ab_z.s5, c.s6, c.s6);
  return out;
}

// gn_weighed_faces and gn_half_surface on eight lanes.
static inline float8 faces_of(const float* w, GnTwoSides d) { return d.x * (w[1] * d.z + w[2] * d.y) + w[0] * d.y * d.z; }
static inline float8 half_surfaces_of(GnTwoSides d) { return d.x * (d.y + d.z) + d.y * d.z; }

// The lesser of both halves, in both: oclgrind 21.10 does not survive a vector of eight made of two.
static inline float8 least_of_both(float8 x) { return GN_VMIN(x, x.s45670123); }

// The cheapest split of every axis, to best_of_axis; axis == GN_NONE where there is none: on an axis without extent all are
// in the first bin, and no plane divides them. w: the face weights. breaks_ties: a literal, as GnMeasure has it. bin_count:
// 2 .. GN_BINS. count: below GN_FACE_SWEEP_MOST.
GN_LANES_INLINE void sweep_by_faces(const float* w, const int breaks_ties, __local const GnBin* bins,
                                    __local const uint* counts, uint bin_count, uint count, __local GnSplit* best_of_axis) {
  const uint planes = bin_count - 1u;
  GnSideExtents left, right;
  int seen[4u * (GN_BINS + 1u)];
  float8 cost[GN_BINS / 2u + 1u], tie[GN_BINS / 2u + 1u], left_measure[GN_BINS / 2u + 1u], right_measure[GN_BINS / 2u + 1u];
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
    const GnTwoSides lefts = sides_at(&left, i), rights = sides_at(&right, i);
    const float8 left_faces = faces_of(w, lefts), right_faces = faces_of(w, rights);
    const float8 both = left_faces * convert_float8(here) + right_faces * convert_float8(rest);
    const float8 valid = select((float8)(INFINITY), both, (here > 0) & (rest > 0));
    cost[i / 2u] = valid;
    left_measure[i / 2u] = left_faces;
    right_measure[i / 2u] = right_faces;
    if (breaks_ties)
      tie[i / 2u] = half_surfaces_of(lefts) * convert_float8(here) + half_surfaces_of(rights) * convert_float8(rest);
    least = GN_VMIN(valid, least);
  }
  least = least_of_both(least);
  float8 least_tie = (float8)(breaks_ties ? INFINITY : 0.0f);
  if (breaks_ties) {
    for (i = 0u; i < planes; i += 2u)
      least_tie = GN_VMIN(select((float8)(INFINITY), tie[i / 2u], cost[i / 2u] == least), least_tie);
    least_tie = least_of_both(least_tie);
  }
  // Evenness, then the lower plane: one number, the larger the better.
  int8 rank = (int8)(-1);
  int8 turned = (int8)((1 << GN_PLANE_BITS) - 1) - (int8)(0, 0, 0, 0, 1, 1, 1, 1);
  for (i = 0u; i < planes; i += 2u) {
    const int8 here = vload8(0, seen + 4u * i);
    const int8 even = min(here, (int8)((int)count) - here);
    int8 best = cost[i / 2u] == least;
    if (breaks_ties) best &= tie[i / 2u] == least_tie;
    rank = max(rank, select((int8)(-1), (even << (int8)((int)GN_PLANE_BITS)) | turned, best));
    turned -= 2;
  }
  {
    float costs[4], ties[4];
    int ranks[4];
    vstore4(least.lo, 0, costs);
    vstore4(least_tie.lo, 0, ties);
    vstore4(max(rank.lo, rank.hi), 0, ranks);
    for (axis = 0u; axis < 3u; ++axis) {
      GnSplit split = gn_no_split();
      if (costs[axis] < INFINITY) {
        const uint plane = (1u << GN_PLANE_BITS) - 1u - ((uint)ranks[axis] & ((1u << GN_PLANE_BITS) - 1u));
        split.cost = costs[axis];
        split.axis = axis;
        split.plane = plane;
        split.left_count = (uint)seen[4u * plane + axis];
        split.tie = ties[axis];
        split.left_measure = ((const float*)left_measure)[4u * plane + axis];
        split.right_measure = ((const float*)right_measure)[4u * plane + axis];
      }
      best_of_axis[axis] = split;
    }
  }
}

#endif  // GN_WGS == 1

#endif
