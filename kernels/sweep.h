// The split sweep of a serial group, all three axes side by side: gn_sweep_axis for measures that three face weights
// describe, with the same operations in the same order in each lane, so with the same split. Bins are as a serial group
// leaves them (bin.h): lower corner, upper corner negated. Device only. Feeds bin.h.
#ifndef GNOMON_SWEEP_H
#define GNOMON_SWEEP_H

#include "group.h"

// Extents of three boxes, lane by axis they were binned along.
typedef struct GnExtents {
  float4 x;
  float4 y;
  float4 z;
} GnExtents;

static inline GnExtents extents_of(float8 along_x, float8 along_y, float8 along_z) {
  // hi - lo rounds like -(lo + -hi).
  const float4 a = -(along_x.lo + along_x.hi);
  const float4 b = -(along_y.lo + along_y.hi);
  const float4 c = -(along_z.lo + along_z.hi);
  GnExtents d;
  d.x = (float4)(a.x, b.x, c.x, 0.0f);
  d.y = (float4)(a.y, b.y, c.y, 0.0f);
  d.z = (float4)(a.z, b.z, c.z, 0.0f);
  return d;
}

// gn_linear_measure and gn_surface_measure.
static inline float4 linear_measures(const float* w, GnExtents d) {
  return d.x * (w[1] * d.z + w[2] * d.y) + w[0] * d.y * d.z;
}
static inline float4 surface_measures(GnExtents d) { return d.x * (d.y + d.z) + d.y * d.z; }

static inline int4 counts_at(__local const uint* counts, uint bin) {
  return (int4)((int)counts[bin], (int)counts[GN_BINS + bin], (int)counts[2u * GN_BINS + bin], 0);
}

#define GN_BIN_AT(bins, axis, bin) (*(__local const float8*)((bins) + (axis)*GN_BINS + (bin)))

// The cheapest split of every axis, to best_of_axis; axis == GN_NONE where there is none: on an axis without extent all
// are in the first bin, and no plane divides them. w: the measure's face weights.
static inline void sweep_three_axes(const float* w, int breaks_ties, __local const GnBin* bins,
                                    __local const uint* counts, uint plane_count, uint count,
                                    __local GnSplit* best_of_axis) {
  float4 right_cost[GN_BINS], right_measure[GN_BINS], right_tie[GN_BINS];
  float8 x = (float8)(INFINITY), y = x, z = x;
  int4 seen = (int4)(0);
  uint i, axis;
  for (i = GN_BINS - 1u; i > 0u; --i) {
    x = GN_VMIN(GN_BIN_AT(bins, 0u, i), x);
    y = GN_VMIN(GN_BIN_AT(bins, 1u, i), y);
    z = GN_VMIN(GN_BIN_AT(bins, 2u, i), z);
    seen += counts_at(counts, i);
    const GnExtents d = extents_of(x, y, z);
    right_measure[i] = linear_measures(w, d);
    right_cost[i] = right_measure[i] * convert_float4(seen);
    if (breaks_ties) right_tie[i] = surface_measures(d) * convert_float4(seen);
  }
  float4 best_cost = (float4)(INFINITY), best_tie = (float4)(0.0f), best_left = (float4)(0.0f);
  int4 best_plane = (int4)(-1), best_even = (int4)(0), best_seen = (int4)(0);
  x = (float8)(INFINITY);
  y = x;
  z = x;
  seen = (int4)(0);
  for (i = 0u; i < plane_count; ++i) {
    const int4 here = counts_at(counts, i);
    x = GN_VMIN(GN_BIN_AT(bins, 0u, i), x);
    y = GN_VMIN(GN_BIN_AT(bins, 1u, i), y);
    z = GN_VMIN(GN_BIN_AT(bins, 2u, i), z);
    seen += here;
    const GnExtents d = extents_of(x, y, z);
    const float4 left = linear_measures(w, d);
    const float4 cost = left * convert_float4(seen) + right_cost[i + 1u];
    const int4 even = min(seen, (int4)((int)count) - seen);
    const int4 valid = (here > 0) & (seen < (int4)((int)count));
    // gn_split_is_better; what comes first is better than nothing.
    int4 better = even > best_even;
    float4 tie = (float4)(0.0f);
    if (breaks_ties) {
      tie = surface_measures(d) * convert_float4(seen) + right_tie[i + 1u];
      better = (tie < best_tie) | ((tie == best_tie) & better);
    }
    better = valid & ((best_plane < 0) | (cost < best_cost) | ((cost == best_cost) & better));
    best_cost = select(best_cost, cost, better);
    best_tie = select(best_tie, tie, better);
    best_left = select(best_left, left, better);
    best_plane = select(best_plane, (int4)((int)i), better);
    best_even = select(best_even, even, better);
    best_seen = select(best_seen, seen, better);
  }
  {
    float costs[4], ties[4], lefts[4];
    int planes[4], left_counts[4];
    vstore4(best_cost, 0, costs);
    vstore4(best_tie, 0, ties);
    vstore4(best_left, 0, lefts);
    vstore4(best_plane, 0, planes);
    vstore4(best_seen, 0, left_counts);
    for (axis = 0u; axis < 3u; ++axis) {
      GnSplit split = gn_no_split();
      if (planes[axis] >= 0) {
        split.cost = costs[axis];
        split.axis = axis;
        split.plane = (uint)planes[axis];
        split.left_count = (uint)left_counts[axis];
        split.tie = ties[axis];
        split.left_measure = lefts[axis];
        split.right_measure = ((const float*)(right_measure + planes[axis] + 1))[axis];
      }
      best_of_axis[axis] = split;
    }
  }
}

#endif
