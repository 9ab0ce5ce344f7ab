// Binning a range of primitives and choosing a split from the bins: the inner loops of the builder.
// Device only. Feeds bin.cl, split.cl (large nodes) and subtree.cl (small ones).
#ifndef GNOMON_BIN_H
#define GNOMON_BIN_H

#include "group.h"

// How doubled centroids of a node map to bins.
typedef struct GnBinning {
  float4 base;
  float4 scale;
} GnBinning;

static inline GnBinning binning_of(const GnTask* task) {
  GnBinning binning;
  binning.base = (float4)(task->centroid_lo[0], task->centroid_lo[1], task->centroid_lo[2], 0.0f);
  binning.scale = (float4)(gn_bin_scale(task->centroid_lo[0], task->centroid_hi[0], GN_BINS),
                           gn_bin_scale(task->centroid_lo[1], task->centroid_hi[1], GN_BINS),
                           gn_bin_scale(task->centroid_lo[2], task->centroid_hi[2], GN_BINS), 0.0f);
  return binning;
}

// gn_bin_of on three axes at once.
static inline uint3 bins_of(float8 primitive, GnBinning binning) {
  const float3 place = ((primitive.lo.xyz + primitive.hi.xyz) - binning.base.xyz) * binning.scale.xyz;
  return min(convert_uint3(place), (uint3)(GN_BINS - 1u));
}

static inline void clear_bins(__local GnBin* bins, __local uint* counts) {
  uint i;
  for (i = GN_LOCAL_ID; i < 3u * GN_BINS; i += GN_WGS) {
#if GN_WGS == 1
    vstore4((float4)(INFINITY), 0, bins[i].lo);
    vstore4((float4)(-INFINITY), 0, bins[i].hi);
#else
    __local int* keys = (__local int*)(bins + i);
    int k;
    for (k = 0; k < 8; ++k) keys[k] = ordered_of(k < 4 ? INFINITY : -INFINITY);
#endif
    counts[i] = 0u;
  }
  GN_GROUP_BARRIER();
}

static inline void add_to_bin(__local GnBin* bin, __local uint* count, float8 primitive) {
#if GN_WGS == 1
  const float4 lo = vload4(0, bin->lo);
  const float4 hi = vload4(0, bin->hi);
  vstore4(GN_VMIN(primitive.lo, lo), 0, bin->lo);
  vstore4(GN_VMAX(primitive.hi, hi), 0, bin->hi);
  *count += 1u;
#else
  volatile __local int* keys = (volatile __local int*)bin;
  atomic_min(keys + 0, ordered_of(primitive.s0));
  atomic_min(keys + 1, ordered_of(primitive.s1));
  atomic_min(keys + 2, ordered_of(primitive.s2));
  atomic_max(keys + 4, ordered_of(primitive.s4));
  atomic_max(keys + 5, ordered_of(primitive.s5));
  atomic_max(keys + 6, ordered_of(primitive.s6));
  atomic_inc((volatile __local uint*)count);
#endif
}

// Bins [begin, end) on all three axes into bins and counts (3 * GN_BINS each, axis after axis).
static inline void bin_range(__global const float8* primitives, uint begin, uint end, GnBinning binning,
                             __local GnBin* bins, __local uint* counts) {
  uint i;
  clear_bins(bins, counts);
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const float8 primitive = primitives[i];
    const uint3 place = bins_of(primitive, binning);
    add_to_bin(bins + place.x, counts + place.x, primitive);
    add_to_bin(bins + GN_BINS + place.y, counts + GN_BINS + place.y, primitive);
    add_to_bin(bins + 2u * GN_BINS + place.z, counts + 2u * GN_BINS + place.z, primitive);
  }
  GN_GROUP_BARRIER();
#if GN_WGS != 1
  for (i = GN_LOCAL_ID; i < 3u * GN_BINS * 8u; i += GN_WGS) {
    __local int* key = (__local int*)bins + i;
    *key = as_int(float_of_ordered(*key));
  }
  GN_GROUP_BARRIER();
#endif
}

// The best split of all three axes; every work-item receives it. An axis without extent offers none.
static inline GnSplit choose_split(__local const GnBin* bins, __local const uint* counts, GnBinning binning,
                                   uint count, __local GnSplit* best_of_axis) {
  GnSplit best;
  uint axis;
  const float scale[3] = {binning.scale.x, binning.scale.y, binning.scale.z};
#if GN_WGS == 1
  for (axis = 0u; axis < 3u; ++axis) {
#else
  for (axis = GN_LOCAL_ID; axis < 3u; axis += GN_WGS) {
#endif
    GnSplit split = {INFINITY, GN_NONE, 0u, 0u};
    if (scale[axis] > 0.0f) {
      split = gn_sweep_axis(bins + axis * GN_BINS, counts + axis * GN_BINS, GN_BINS, axis, count);
    }
    best_of_axis[axis] = split;
  }
  GN_GROUP_BARRIER();
  best = best_of_axis[0];
  for (axis = 1u; axis < 3u; ++axis) {
    const GnSplit split = best_of_axis[axis];
    if (split.axis != GN_NONE && (best.axis == GN_NONE || gn_split_is_better(&split, &best, count))) best = split;
  }
  return best;
}

// Union of the boxes of bins [from, to) of one axis.
static inline GnBoxPair box_of_bins(__local const GnBin* bins, __local const uint* counts, uint from, uint to) {
  GnBoxPair box = empty_pair();
  uint i;
  for (i = from; i < to; ++i) {
    if (counts[i] == 0u) continue;
    box.lo = GN_VMIN(vload4(0, bins[i].lo), box.lo);
    box.hi = GN_VMAX(vload4(0, bins[i].hi), box.hi);
  }
  return box;
}

#endif
