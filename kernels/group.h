// What a work-group does together, in two flavours chosen by GN_WGS, its size: 1 is the serial flavour for CPUs
// (explicit vectors, no barriers, no atomics), more is the cooperative one for GPUs. Both give the same bits: only
// minima, maxima and integer sums are combined across work-items. Device only. Feeds the build kernels.
#ifndef GNOMON_GROUP_H
#define GNOMON_GROUP_H

// Set by the host's program options; these defaults let a kernel file be compiled by hand.
#ifndef GN_WGS
#define GN_WGS 1
#endif
#ifndef GN_BINS
#define GN_BINS 16
#endif

#include "shared/cost_math.h"

#if GN_WGS == 1
#define GN_LOCAL_ID 0u
#define GN_GROUP_BARRIER()
#else
#define GN_LOCAL_ID ((uint)get_local_id(0))
#define GN_GROUP_BARRIER() barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#endif

// One instruction each on vectors, unlike fmin and fmax.
#define GN_VMIN(a, b) ((a) < (b) ? (a) : (b))
#define GN_VMAX(a, b) ((a) > (b) ? (a) : (b))

// A triangle's number in a float's place, behind a corner. With this bit turned it is a normal number: additions that
// meet it in a lane nobody reads would take several times as long over a denormal one, which small numbers are.
#define GN_INDEX_BIT 0x40000000u
static inline float float_with_index(uint index) { return as_float(index ^ GN_INDEX_BIT); }
static inline uint index_in(float lane) { return as_uint(lane) ^ GN_INDEX_BIT; }

// A box as two vectors; lane w carries nothing.
typedef struct GnBoxPair {
  float4 lo;
  float4 hi;
} GnBoxPair;

static inline GnBoxPair empty_pair(void) {
  GnBoxPair box;
  box.lo = (float4)(INFINITY);
  box.hi = (float4)(-INFINITY);
  return box;
}

// Integers that order like the floats they stand for, NaN aside: minima and maxima become integer atomics.
static inline int ordered_of(float x) {
  const int i = as_int(x);
  return i >= 0 ? i : i ^ 0x7fffffff;
}
static inline float float_of_ordered(int i) { return as_float(i >= 0 ? i : i ^ 0x7fffffff); }

// Unites every work-item's box; all receive the result. keys: 6 local ints, free to reuse after the call.
static inline GnBoxPair group_union(GnBoxPair box, volatile __local int* keys) {
#if GN_WGS == 1
  return box;
#else
  uint k;  // groups may have fewer than six items
  for (k = GN_LOCAL_ID; k < 6u; k += GN_WGS) keys[k] = ordered_of(k < 3u ? INFINITY : -INFINITY);
  GN_GROUP_BARRIER();
  atomic_min(keys + 0, ordered_of(box.lo.x));
  atomic_min(keys + 1, ordered_of(box.lo.y));
  atomic_min(keys + 2, ordered_of(box.lo.z));
  atomic_max(keys + 3, ordered_of(box.hi.x));
  atomic_max(keys + 4, ordered_of(box.hi.y));
  atomic_max(keys + 5, ordered_of(box.hi.z));
  GN_GROUP_BARRIER();
  GnBoxPair all;
  all.lo = (float4)(float_of_ordered(keys[0]), float_of_ordered(keys[1]), float_of_ordered(keys[2]), 0.0f);
  all.hi = (float4)(float_of_ordered(keys[3]), float_of_ordered(keys[4]), float_of_ordered(keys[5]), 0.0f);
  GN_GROUP_BARRIER();
  return all;
#endif
}

// Replaces one number of each work-item by the sum of those before it. sums: GN_WGS local numbers, free after the call.
static inline uint group_sum_before(uint value, __local uint* sums) {
#if GN_WGS == 1
  return 0u;
#else
  uint step, before = 0u;
  sums[GN_LOCAL_ID] = value;
  GN_GROUP_BARRIER();
  for (step = 1u; step < GN_WGS; step *= 2u) {
    const uint other = GN_LOCAL_ID >= step ? sums[GN_LOCAL_ID - step] : 0u;
    GN_GROUP_BARRIER();
    sums[GN_LOCAL_ID] += other;
    GN_GROUP_BARRIER();
  }
  before = sums[GN_LOCAL_ID] - value;
  GN_GROUP_BARRIER();
  return before;
#endif
}

static inline void store_bounds(__global GnBounds* out, GnBoxPair box) {
  out->lo[0] = box.lo.x;
  out->lo[1] = box.lo.y;
  out->lo[2] = box.lo.z;
  out->pad0 = 0.0f;
  out->hi[0] = box.hi.x;
  out->hi[1] = box.hi.y;
  out->hi[2] = box.hi.z;
  out->pad1 = 0.0f;
}

#endif
