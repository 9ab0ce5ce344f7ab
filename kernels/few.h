// Binning a node of few primitives, which most nodes are. Device only. Feeds subtree.cl.
#ifndef GNOMON_FEW_H
#define GNOMON_FEW_H

#include "bin.h"

// A node of few primitives has no use for bins that are empty: a serial group numbers only as many as there are primitives,
// which leaves the order of those that hold any, and so the split, as they were.
#if GN_WGS == 1 && GN_BINS > 8 && !GN_PUBLISHED_BINS && !GN_ORDERED_AXES
#define GN_FEW 8u
// Bins `count` primitives, at most GN_FEW, into the first `count` bins of each axis. bin_at: receives which of the GN_BINS
// bins that is, axis after axis, for those that hold any.
static inline void bin_few(__global const float8* primitives, uint count, GnBinning binning, __local GnBin* bins,
                           __local uint* counts, uint* bin_at) {
  int4 place[GN_FEW], rank[GN_FEW];
  uint i, k;
  for (i = 0u; i < count; ++i) {
    const float8 primitive = primitives[i];
    place[i] = places_of(primitive, binning);
    rank[i] = (int4)(0);
    for (k = 0u; k < i; ++k) {
      rank[i] -= place[k] < place[i];  // true is -1
      rank[k] -= place[i] < place[k];
    }
    for (k = 0u; k < 3u; ++k) {
      *(__local float8*)(bins + k * GN_BINS + i) = (float8)(INFINITY);
      counts[k * GN_BINS + i] = 0u;
    }
  }
  for (i = 0u; i < count; ++i) {
    const uint3 at = as_uint4(rank[i]).xyz;
    add_on_three_axes(bins, counts, at, with_upper_negated(primitives[i]));
    bin_at[at.x] = (uint)place[i].x;
    bin_at[GN_FEW + at.y] = (uint)place[i].y;
    bin_at[2u * GN_FEW + at.z] = (uint)place[i].z;
  }
}

// Two primitives can be divided one way only, and every axis that divides them rates it alike: the first of those has it.
// swaps: receives whether the second one is on the left. The plane is left out: there is nothing to partition.
static inline GnSplit split_of_two(const GnMeasure* measure, int how, float8 first, float8 second, GnBinning binning,
                                   uint* swaps) {
  const int4 place = places_of(first, binning), other = places_of(second, binning);
  GnSplit split = gn_no_split();
  const uint axis = place.x != other.x ? 0u : place.y != other.y ? 1u : place.z != other.z ? 2u : GN_NONE;
  *swaps = 0u;
  if (axis != GN_NONE) {
    float boxes[16];
    const uint swapped = axis == 0u ? place.x > other.x : axis == 1u ? place.y > other.y : place.z > other.z;
    vstore8(swapped ? second : first, 0, boxes);
    vstore8(swapped ? first : second, 1, boxes);
    split.axis = axis;
    split.left_count = 1u;
    split.left_measure = gn_box_measure(measure, how, boxes, boxes + 4);
    split.right_measure = gn_box_measure(measure, how, boxes + 8, boxes + 12);
    split.cost = split.left_measure + split.right_measure;
    *swaps = swapped;
  }
  return split;
}
#else
#define GN_FEW 0u
#endif

#endif
