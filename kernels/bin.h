// Binning a range of primitives and choosing a split from the bins: the inner loops of the builder.
// Device only. Feeds bin.cl, split.cl (large nodes) and subtree.cl (small ones).
#ifndef GNOMON_BIN_H
#define GNOMON_BIN_H

#include "group.h"
#include "shared/axis_policy.h"

// 1: the heuristic's own axis policy orders axes (axis_policy.h). 0: all three are tried, and policies are left out.
#ifndef GN_ORDERED_AXES
#define GN_ORDERED_AXES 0
#endif

// What the published builder bins: barycentres over the node's box, its last plane left out. Ours: middles of boxes over
// their own bounds.
#ifndef GN_PUBLISHED_BINS
#define GN_PUBLISHED_BINS 0
#endif
#define GN_PLANES_BETWEEN(bin_count) ((bin_count)-1u - GN_PUBLISHED_BINS)

#include "sweep.h"

// A serial group bins many primitives into two sets by turns, the second behind the first, so that one need not wait until
// the other is in the bin that both are in.
#if GN_WGS == 1
#define GN_BIN_SETS 2
#else
#define GN_BIN_SETS 1
#endif
#define GN_MANY 64u

// How doubled centroids of a node (published: tripled barycentres) map to bins.
typedef struct GnBinning {
  float4 base;
  float4 scale;
#if GN_PUBLISHED_BINS
  __global const float* triangles;
#endif
} GnBinning;

#if GN_PUBLISHED_BINS
static inline GnBinning binning_of(const GnTask* task, __global const float* triangles) {
  const float4 lo = (float4)(task->lo[0], task->lo[1], task->lo[2], 0.0f);
  const float4 hi = (float4)(task->hi[0], task->hi[1], task->hi[2], 0.0f);
  GnBinning binning;
  binning.triangles = triangles;
  binning.base = 3.0f * lo;
  binning.scale = (float4)(gn_bin_scale(3.0f * lo.x, 3.0f * hi.x, GN_BINS), gn_bin_scale(3.0f * lo.y, 3.0f * hi.y, GN_BINS),
                           gn_bin_scale(3.0f * lo.z, 3.0f * hi.z, GN_BINS), 0.0f);
  return binning;
}

static inline uint3 bins_of(float8 primitive, GnBinning binning) {
  const size_t corner = 3u * (size_t)index_in(primitive.s3);
  const float3 sum = vload3(corner, binning.triangles) + vload3(corner + 1u, binning.triangles) +
                     vload3(corner + 2u, binning.triangles);
  const float3 place = (sum - binning.base.xyz) * binning.scale.xyz;
  return min(convert_uint3(GN_VMAX(place, (float3)(0.0f))), (uint3)(GN_BINS - 1u));
}
#else
static inline GnBinning binning_of(const GnTask* task, __global const float* triangles) {
  GnBinning binning;
  binning.base = (float4)(task->centroid_lo[0], task->centroid_lo[1], task->centroid_lo[2], 0.0f);
  binning.scale = (float4)(gn_bin_scale(task->centroid_lo[0], task->centroid_hi[0], GN_BINS),
                           gn_bin_scale(task->centroid_lo[1], task->centroid_hi[1], GN_BINS),
                           gn_bin_scale(task->centroid_lo[2], task->centroid_hi[2], GN_BINS), 0.0f);
  return binning;
}

// gn_bin_of on three axes at once. Four lanes and signed: one instruction; places are below 2^31, and the fourth lane is
// nobody's.
static inline int4 places_of(float8 primitive, GnBinning binning) {
  const float4 place = ((primitive.lo + primitive.hi) - binning.base) * binning.scale;
  return min(convert_int4(place), (int4)(GN_BINS - 1));
}
static inline uint3 bins_of(float8 primitive, GnBinning binning) {
  return as_uint4(places_of(primitive, binning)).xyz;
}
#endif

// Whether a primitive is in one of the bins [0, plane] of an axis: bins_of, its truncation and the comparison in one.
static inline uint in_first_bins(float8 primitive, GnBinning binning, uint axis, uint plane) {
#if GN_PUBLISHED_BINS
  const uint3 place = bins_of(primitive, binning);
  return (axis == 0u ? place.x : axis == 1u ? place.y : place.z) <= plane;
#else
  const float4 place = ((primitive.lo + primitive.hi) - binning.base) * binning.scale;
  const float on_axis = axis == 0u ? place.x : axis == 1u ? place.y : place.z;
  return on_axis < (float)(plane + 1u);
#endif
}

#if GN_WGS == 1
static inline void clear_bins(__local GnBin* bins, __local uint* counts) {
  uint i, k;
  for (i = 0u; i + 8u <= 3u * GN_BINS; i += 8u) {
    __local float8* eight = (__local float8*)(bins + i);
    eight[0] = (float8)(INFINITY);
    eight[1] = (float8)(INFINITY);
    eight[2] = (float8)(INFINITY);
    eight[3] = (float8)(INFINITY);
    eight[4] = (float8)(INFINITY);
    eight[5] = (float8)(INFINITY);
    eight[6] = (float8)(INFINITY);
    eight[7] = (float8)(INFINITY);
    vstore8((uint8)(0u), 0, counts + i);
  }
  for (k = i; k < 3u * GN_BINS; ++k) {
    *(__local float8*)(bins + k) = (float8)(INFINITY);
    counts[k] = 0u;
  }
}
#else
static inline void clear_bins(__local GnBin* bins, __local uint* counts) {
  uint i;
  for (i = GN_LOCAL_ID; i < 3u * GN_BINS; i += GN_WGS) {
    __local int* keys = (__local int*)(bins + i);
    int k;
    for (k = 0; k < 8; ++k) keys[k] = ordered_of(k < 4 ? INFINITY : -INFINITY);
    counts[i] = 0u;
  }
  GN_GROUP_BARRIER();
}
#endif

#if GN_WGS == 1
// In a serial group's local memory a bin holds its lower corner and its upper one negated: one minimum grows both.
static inline float8 with_upper_negated(float8 box) {
  return as_float8(as_uint8(box) ^ (uint8)(0u, 0u, 0u, 0u, 0x80000000u, 0x80000000u, 0x80000000u, 0x80000000u));
}
static inline void turn_bins(__local GnBin* bins) {
  uint i;
  for (i = 0u; i < 3u * GN_BINS; ++i) {
    __local float8* whole = (__local float8*)(bins + i);
    *whole = with_upper_negated(*whole);
  }
}
static inline void add_to_bin(__local GnBin* bin, __local uint* count, float8 negated) {
  __local float8* whole = (__local float8*)bin;
  *whole = GN_VMIN(negated, *whole);
  *count += 1u;
}
#else
static inline void turn_bins(__local GnBin* bins) { (void)bins; }
static inline void add_to_bin(__local GnBin* bin, __local uint* count, float8 primitive) {
  volatile __local int* keys = (volatile __local int*)bin;
  atomic_min(keys + 0, ordered_of(primitive.s0));
  atomic_min(keys + 1, ordered_of(primitive.s1));
  atomic_min(keys + 2, ordered_of(primitive.s2));
  atomic_max(keys + 4, ordered_of(primitive.s4));
  atomic_max(keys + 5, ordered_of(primitive.s5));
  atomic_max(keys + 6, ordered_of(primitive.s6));
  atomic_inc((volatile __local uint*)count);
}
#endif

static inline void add_on_three_axes(__local GnBin* bins, __local uint* counts, uint3 place, float8 box) {
  add_to_bin(bins + place.x, counts + place.x, box);
  add_to_bin(bins + GN_BINS + place.y, counts + GN_BINS + place.y, box);
  add_to_bin(bins + 2u * GN_BINS + place.z, counts + 2u * GN_BINS + place.z, box);
}

#if GN_WGS == 1
// Bins an even number of primitives from `begin` on and returns where it stopped: `end` or the last one.
static inline uint bin_by_turns(__global const float8* primitives, uint begin, uint end, GnBinning binning,
                                __local GnBin* bins, __local uint* counts) {
  __local GnBin* other_bins = bins + 3u * GN_BINS;
  __local uint* other_counts = counts + 3u * GN_BINS;
  uint i;
  clear_bins(other_bins, other_counts);
  for (i = begin; end - i >= 2u; i += 2u) {
    const float8 first = primitives[i], second = primitives[i + 1u];
    const uint3 at = bins_of(first, binning), other_at = bins_of(second, binning);
    add_on_three_axes(bins, counts, at, with_upper_negated(first));
    add_on_three_axes(other_bins, other_counts, other_at, with_upper_negated(second));
  }
  begin = i;
  for (i = 0u; i < 3u * GN_BINS; ++i) {
    __local float8* whole = (__local float8*)(bins + i);
    *whole = GN_VMIN(*(__local const float8*)(other_bins + i), *whole);
    counts[i] += other_counts[i];
  }
  return begin;
}
#endif

// Bins [begin, end) on all three axes into bins and counts (3 * GN_BINS each, axis after axis, GN_BIN_SETS times).
static inline void bin_range(__global const float8* primitives, uint begin, uint end, GnBinning binning,
                             __local GnBin* bins, __local uint* counts) {
  uint i;
  clear_bins(bins, counts);
#if GN_WGS == 1
  if (end - begin >= GN_MANY) begin = bin_by_turns(primitives, begin, end, binning, bins, counts);
#endif
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const float8 primitive = primitives[i];
#if GN_WGS == 1
    const float8 box = with_upper_negated(primitive);
#else
    const float8 box = primitive;
#endif
    add_on_three_axes(bins, counts, bins_of(primitive, binning), box);
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

// A task as axis policies see it. An axis without extent cannot be divided.
static inline GnNodeView view_of(const GnTask* task, GnBinning binning) {
  GnNodeView node;
  int k;
  for (k = 0; k < 3; ++k) {
    node.lo[k] = task->lo[k];
    node.hi[k] = task->hi[k];
  }
  node.probability = task->probability;
  node.count = task->end - task->begin;
  node.depth = task->depth;
  node.how = task->how;
  node.usable = (binning.scale.x > 0.0f ? 1u : 0u) | (binning.scale.y > 0.0f ? 2u : 0u) |
                (binning.scale.z > 0.0f ? 4u : 0u);
  return node;
}

// Every axis' cheapest split, each swept by a work-item of its own where there are several.
static inline void sweep_axes(const GnHeuristic* heuristic, int how, const GnNodeView* node, __local const GnBin* bins,
                              __local const uint* counts, uint bin_count, __local GnSplit* best_of_axis) {
  uint axis;
  for (axis = GN_LOCAL_ID; axis < 3u; axis += GN_WGS) {
    GnSplit split = gn_no_split();
    if ((node->usable >> axis & 1u) != 0u) {
      split = gn_sweep_axis(&heuristic->measure, how, bins + axis * GN_BINS, counts + axis * GN_BINS,
                            GN_PLANES_BETWEEN(bin_count), bin_count, axis, node->count);
    }
    best_of_axis[axis] = split;
  }
  GN_GROUP_BARRIER();
}

// The cheapest split of all three axes.
static inline GnSplit cheapest_split(const GnHeuristic* heuristic, int how, const GnNodeView* node,
                                     __local GnBin* bins, __local const uint* counts, uint bin_count,
                                     __local GnSplit* best_of_axis) {
  GnSplit best;
  uint axis;
#if GN_WGS == 1
  const GnMeasure* measure = &heuristic->measure;
  const int steps = gn_has_steps(measure);
  float w[3];
  const int linear = gn_linear_part(measure, how, w);
#if GN_PUBLISHED_BINS  // leave out the last plane
  const int by_faces = 0;
#else
  const int by_faces = linear && node->count < GN_FACE_SWEEP_MOST;
#endif
  if (by_faces) {
    if (measure->breaks_ties != 0u) {
      sweep_by_faces(w, 1, bins, counts, bin_count, node->count, best_of_axis);
    } else {
      sweep_by_faces(w, 0, bins, counts, bin_count, node->count, best_of_axis);
    }
  } else if (!linear && steps && how == GN_SEEN_ONE_STEP) {
    sweep_three_axes(measure, GN_SEEN_ONE_STEP, w, bins, counts, bin_count, node->count, best_of_axis);
  } else if (steps && how == GN_SEEN_FEW_STEPS) {
    sweep_three_axes(measure, GN_SEEN_FEW_STEPS, w, bins, counts, bin_count, node->count, best_of_axis);
  } else if (steps && how == GN_SEEN_WHOLE) {
    sweep_three_axes(measure, GN_SEEN_WHOLE, w, bins, counts, bin_count, node->count, best_of_axis);
  } else if (gn_kind_of(measure) == GN_MEASURE_WINDOW && how == GN_SEEN_CUT) {
    sweep_three_axes(measure, GN_SEEN_CUT, w, bins, counts, bin_count, node->count, best_of_axis);
  } else {
    turn_bins(bins);
    sweep_axes(heuristic, how, node, bins, counts, bin_count, best_of_axis);
    turn_bins(bins);
  }
#else
  sweep_axes(heuristic, how, node, bins, counts, bin_count, best_of_axis);
#endif
  best = best_of_axis[0];
  for (axis = 1u; axis < 3u; ++axis) {
    const GnSplit split = best_of_axis[axis];
    if (split.axis != GN_NONE && (best.axis == GN_NONE || gn_split_is_better(&split, &best, node->count))) best = split;
  }
  return best;
}

// The split the heuristic chooses, between the first bin_count bins of each axis (GN_BINS unless bin_few was here); every
// work-item receives it.
static inline GnSplit choose_split(const GnHeuristic* heuristic, int how, const GnNodeView* node,
                                   __local GnBin* bins, __local const uint* counts, uint bin_count,
                                   __local GnSplit* best_of_axis) {
#if !GN_ORDERED_AXES
  return cheapest_split(heuristic, how, node, bins, counts, bin_count, best_of_axis);
#else
  turn_bins(bins);
  if (GN_LOCAL_ID == 0u) {
    best_of_axis[0] = gn_policy_split(heuristic, how, node, bins, counts, GN_PLANES_BETWEEN(bin_count), bin_count, 0);
  }
  turn_bins(bins);
  GN_GROUP_BARRIER();
  return best_of_axis[0];
#endif
}

// Union of the boxes of bins [from, to) of one axis. Empty bins add nothing in either form.
static inline GnBoxPair box_of_bins(__local const GnBin* bins, uint from, uint to) {
  GnBoxPair box = empty_pair();
  uint i;
#if GN_WGS == 1
  float8 negated = (float8)(INFINITY);
  for (i = from; i < to; ++i) negated = GN_VMIN(*(__local const float8*)(bins + i), negated);
  box.lo = negated.lo;
  box.hi = -negated.hi;
#else
  for (i = from; i < to; ++i) {
    box.lo = GN_VMIN(vload4(0, bins[i].lo), box.lo);
    box.hi = GN_VMAX(vload4(0, bins[i].hi), box.hi);
  }
#endif
  return box;
}

#endif
