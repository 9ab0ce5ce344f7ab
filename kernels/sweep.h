// The split sweep of a serial group, all three axes side by side: gn_sweep_axis, with the same operations in the same order
// in each lane, so with the same split, for measures that have one form in all lanes (lanes.h) but are more than face
// weights (face_sweep.h). Bins are as a serial group leaves them (bin.h): lower corner, upper corner negated. Device only.
// Feeds bin.h.
#ifndef GNOMON_SWEEP_H
#define GNOMON_SWEEP_H

#include "group.h"

#if GN_WGS == 1

#define GN_BIN_AT(bins, axis, bin) (*(__local const float8*)((bins) + (axis)*GN_BINS + (bin)))
#include "face_sweep.h"

// Three boxes, lane by axis they were binned along.
static inline GnBoxes boxes_of(float8 along_x, float8 along_y, float8 along_z) {
  GnBoxes box;
  box.lo[0] = (float4)(along_x.s0, along_y.s0, along_z.s0, 0.0f);
  box.lo[1] = (float4)(along_x.s1, along_y.s1, along_z.s1, 0.0f);
  box.lo[2] = (float4)(along_x.s2, along_y.s2, along_z.s2, 0.0f);
  box.hi[0] = -(float4)(along_x.s4, along_y.s4, along_z.s4, 0.0f);
  box.hi[1] = -(float4)(along_x.s5, along_y.s5, along_z.s5, 0.0f);
  box.hi[2] = -(float4)(along_x.s6, along_y.s6, along_z.s6, 0.0f);
  return box;
}

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

static inline int4 counts_at(__local const uint* counts, uint bin) {
  return (int4)((int)counts[bin], (int)counts[GN_BINS + bin], (int)counts[2u * GN_BINS + bin], 0);
}

// How three boxes are weighed: `how` is a literal, as in gn_sweep_boxes. w: as gn_linear_part gives it. d: their extents.
GN_LANES_INLINE float4 measures_of(const GnMeasure* measure, const int how, const float* w, float8 x, float8 y, float8 z,
                                   GnExtents d) {
  const float4 linear = gn_weighed_faces(w, d.x, d.y, d.z);
  const GnBoxes box = boxes_of(x, y, z);
  return measure->area_scale * gn_lane_measures(measure, how, &box) + linear;
}

// As sweep_by_faces. how: GN_SEEN_ONE_STEP, GN_SEEN_FEW_STEPS, GN_SEEN_WHOLE or GN_SEEN_CUT. w: as gn_linear_part gives it.
// Steps are not taken for bins that are empty on all axes, as small nodes' are.
GN_LANES_INLINE void sweep_three_axes(const GnMeasure* measure, const int how, const float* w, __local const GnBin* bins,
                                      __local const uint* counts, uint bin_count, uint count,
                                      __local GnSplit* best_of_axis) {
  float4 right_cost[GN_BINS], right_measure[GN_BINS], right_tie[GN_BINS];
  float4 measured = (float4)(0.0f), costs_right = (float4)(0.0f), ties_right = (float4)(0.0f);
  const int breaks_ties = measure->breaks_ties != 0u;
  float8 x = (float8)(INFINITY), y = x, z = x;
  int4 seen = (int4)(0);
  uint i, axis;
  for (i = bin_count - 1u; i > 0u; --i) {
    const int4 here = counts_at(counts, i);
    if ((here.x | here.y | here.z) != 0) {
      x = GN_VMIN(GN_BIN_AT(bins, 0u, i), x);
      y = GN_VMIN(GN_BIN_AT(bins, 1u, i), y);
      z = GN_VMIN(GN_BIN_AT(bins, 2u, i), z);
      seen += here;
      const GnExtents d = extents_of(x, y, z);
      measured = measures_of(measure, how, w, x, y, z, d);
      costs_right = measured * convert_float4(seen);
      if (breaks_ties) ties_right = gn_half_surface(d.x, d.y, d.z) * convert_float4(seen);
    }
    right_measure[i] = measured;
    right_cost[i] = costs_right;
    right_tie[i] = ties_right;
  }
  float4 best_cost = (float4)(INFINITY), best_tie = (float4)(0.0f), best_left = (float4)(0.0f);
  int4 best_plane = (int4)(-1), best_even = (int4)(0), best_seen = (int4)(0);
  x = (float8)(INFINITY);
  y = x;
  z = x;
  seen = (int4)(0);
  for (i = 0u; i < GN_PLANES_BETWEEN(bin_count); ++i) {
    const int4 here = counts_at(counts, i);
    if ((here.x | here.y | here.z) == 0) continue;
    x = GN_VMIN(GN_BIN_AT(bins, 0u, i), x);
    y = GN_VMIN(GN_BIN_AT(bins, 1u, i), y);
    z = GN_VMIN(GN_BIN_AT(bins, 2u, i), z);
    seen += here;
    const GnExtents d = extents_of(x, y, z);
    const float4 left = measures_of(measure, how, w, x, y, z, d);
    const float4 cost = left * convert_float4(seen) + right_cost[i + 1u];
    const int4 even = min(seen, (int4)((int)count) - seen);
    const int4 valid = (here > 0) & (seen < (int4)((int)count));
    // gn_split_is_better; what comes first is better than nothing.
    int4 better = even > best_even;
    float4 tie = (float4)(0.0f);
    if (breaks_ties) {
      tie = gn_half_surface(d.x, d.y, d.z) * convert_float4(seen) + right_tie[i + 1u];
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

#endif  // GN_WGS == 1

#endif
