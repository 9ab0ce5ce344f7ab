// The stable partition of a range: left parts keep their order, right parts keep theirs, so leaf order depends on
// neither chunks nor work-group size. Device only. Feeds partition.cl and subtree.cl.
#ifndef GNOMON_PARTITION_H
#define GNOMON_PARTITION_H

#include "bin.h"

// Which side of a task's split a primitive is on.
typedef struct GnSide {
  GnBinning binning;
  uint axis;   // GN_NONE: halve by position
  uint plane;
  uint middle; // first index of the right half when halving
} GnSide;

static inline GnSide side_of(const GnTask* task, GnBinning binning) {
  GnSide side;
  side.binning = binning;
  side.axis = task->axis;
  side.plane = task->plane;
  side.middle = task->begin + task->left_count;
  return side;
}

static inline uint goes_left(float8 primitive, uint index, GnSide side) {
  if (side.axis == GN_NONE) return index < side.middle;
  return in_first_bins(primitive, side.binning, side.axis, side.plane);
}

#if GN_WGS == 1
// The same as a comparison, less or not, of numbers that a whole vector can have: a mask made of a scalar's comparison costs
// more than all the rest.
typedef struct GnComparison {
  float base;
  float scale;
  float bound;
  uint axis;
} GnComparison;

static inline GnComparison comparison_of(GnSide side) {
  const float base[3] = {side.binning.base.x, side.binning.base.y, side.binning.base.z};
  const float scale[3] = {side.binning.scale.x, side.binning.scale.y, side.binning.scale.z};
  GnComparison out;
  out.axis = side.axis == GN_NONE ? 0u : side.axis;
  out.base = base[out.axis];
  out.scale = scale[out.axis];
  out.bound = side.axis == GN_NONE ? 0.0f : (float)(side.plane + 1u);
  return out;
}

// Below comparison.bound where the primitive goes left.
static inline float compared_place(__global const float8* primitive, uint index, GnSide side, GnComparison comparison) {
#if GN_PUBLISHED_BINS
  return goes_left(*primitive, index, side) ? comparison.bound - 1.0f : comparison.bound;
#else
  __global const float* row = (__global const float*)primitive + comparison.axis;
  if (side.axis == GN_NONE) return index < side.middle ? -1.0f : 1.0f;
  return ((row[0] + row[4]) - comparison.base) * comparison.scale;
#endif
}
#endif

// Bounds of doubled centroids of the two sides.
typedef struct GnTwoBounds {
  GnBoxPair left;
  GnBoxPair right;
} GnTwoBounds;

static inline void grow_side(GnTwoBounds* bounds, float8 primitive, uint left) {
  const float4 c = primitive.lo + primitive.hi;
  const int4 is_left = (int4)(left ? -1 : 0);
  bounds->left.lo = select(bounds->left.lo, GN_VMIN(c, bounds->left.lo), is_left);
  bounds->left.hi = select(bounds->left.hi, GN_VMAX(c, bounds->left.hi), is_left);
  bounds->right.lo = select(GN_VMIN(c, bounds->right.lo), bounds->right.lo, is_left);
  bounds->right.hi = select(GN_VMAX(c, bounds->right.hi), bounds->right.hi, is_left);
}

#if GN_WGS != 1
// Inclusive prefix sum over the work-group (Hillis & Steele 1986); scan: GN_WGS local words.
static inline uint group_prefix_sum(uint value, __local uint* scan) {
  uint step;
  scan[GN_LOCAL_ID] = value;
  GN_GROUP_BARRIER();
  for (step = 1u; step < GN_WGS; step <<= 1) {
    const uint add = GN_LOCAL_ID >= step ? scan[GN_LOCAL_ID - step] : 0u;
    GN_GROUP_BARRIER();
    scan[GN_LOCAL_ID] += add;
    GN_GROUP_BARRIER();
  }
  return scan[GN_LOCAL_ID];
}
#endif

// Moves [begin, end) of `from` to left_at... and right_at... of `to`; returns the sides' centroid bounds on every
// work-item. scan: GN_WGS local words, keys: 6 local ints.
static inline GnTwoBounds partition_range(__global const float8* from, __global float8* to, uint begin, uint end,
                                          uint left_at, uint right_at, GnSide side, __local uint* scan,
                                          __local int* keys) {
  GnTwoBounds bounds;
  uint i;
  bounds.left = empty_pair();
  bounds.right = empty_pair();
#if GN_WGS == 1
  // Doubled centroids and their negatives side by side: one minimum grows a side's bounds.
  float8 left_bounds = (float8)(INFINITY), right_bounds = (float8)(INFINITY);
  const GnComparison comparison = comparison_of(side);
  // Other numbers in the lanes that are nobody's: where all are the same, compilers compare one and spread the answer.
  const float bound = comparison.bound;
  const float8 bounds_of_lanes = (float8)(bound, bound, bound, 0.0f, bound, bound, bound, 0.0f);
  for (i = begin; i < end; ++i) {
    const float8 primitive = from[i];
    const float place = compared_place(from + i, i, side, comparison);
    const uint left = place < comparison.bound ? 1u : 0u;
    const int8 is_left = (float8)(place) < bounds_of_lanes;
    const float8 both = with_upper_negated(primitive + primitive.s45670123);
    to[left ? left_at : right_at] = primitive;
    left_at += left;
    right_at += 1u - left;
    left_bounds = GN_VMIN(select((float8)(INFINITY), both, is_left), left_bounds);
    right_bounds = GN_VMIN(select(both, (float8)(INFINITY), is_left), right_bounds);
  }
  bounds.left.lo = left_bounds.lo;
  bounds.left.hi = -left_bounds.hi;
  bounds.right.lo = right_bounds.lo;
  bounds.right.hi = -right_bounds.hi;
#else
  for (i = begin; i < end; i += GN_WGS) {  // the same trips for every work-item: barriers stand inside
    const uint index = i + GN_LOCAL_ID;
    const uint inside = index < end ? 1u : 0u;
    const float8 primitive = from[inside ? index : begin];
    const uint left = inside ? goes_left(primitive, index, side) : 0u;
    const uint lefts = group_prefix_sum(left, scan);
    const uint all_lefts = scan[GN_WGS - 1u];
    if (inside) {
      to[left ? left_at + lefts - 1u : right_at + GN_LOCAL_ID - lefts] = primitive;
      grow_side(&bounds, primitive, left);
    }
    left_at += all_lefts;
    right_at += min((uint)GN_WGS, end - i) - all_lefts;
    GN_GROUP_BARRIER();
  }
  bounds.left = group_union(bounds.left, keys);
  bounds.right = group_union(bounds.right, keys);
#endif
  return bounds;
}

// Union of the boxes of [begin, end), on every work-item: what bins tell for free, for nodes halved without bins.
static inline GnBoxPair box_of_range(__global const float8* primitives, uint begin, uint end, __local int* keys) {
  GnBoxPair box = empty_pair();
  uint i;
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const float8 primitive = primitives[i];
    box.lo = GN_VMIN(primitive.lo, box.lo);
    box.hi = GN_VMAX(primitive.hi, box.hi);
  }
  return group_union(box, keys);
}

#endif
