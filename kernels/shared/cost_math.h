// What decides a tree: box measures, binning and the split sweep. Compiled by both compilers and free of division,
// so that every device and the reference builder take bitwise the same decisions (needs -ffp-contract=off on the
// host; kernels switch contraction off in scalar.h). Not for intersection tests (hit_math.h).
// Feeds split_reference.cpp, bin.cl, subtree.cl.
#ifndef GNOMON_SHARED_COST_MATH_H
#define GNOMON_SHARED_COST_MATH_H

#include "build_layout.h"

// Where bins live when a sweep reads them: local memory on a device.
#ifdef __OPENCL_VERSION__
#define GN_BINS_SPACE __local
#else
#define GN_BINS_SPACE
#endif

// The hit probability of a box up to a constant: half its surface area (Goldsmith & Salmon 1987).
// This is the heuristic seam: another ray distribution is another measure.
GN_INLINE gn_f32 gn_box_measure(const gn_f32* lo, const gn_f32* hi) {
  const gn_f32 dx = hi[0] - lo[0];
  const gn_f32 dy = hi[1] - lo[1];
  const gn_f32 dz = hi[2] - lo[2];
  return dx * (dy + dz) + dy * dz;
}

// 1 / x for normal x > 0 within 2 ulp, from integer and multiply-subtract steps only: the same bits on every device
// (OpenCL allows division to differ by 2.5 ulp). Scaling x by a power of two scales the result exactly.
GN_INLINE gn_f32 gn_reciprocal(gn_f32 x) {
  gn_f32 r = gn_float_of(0x7ef311c7u - gn_bits_of(x));
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  return r;
}

// Extents below this (2^-100) cannot be divided into bins; the axis then offers no split.
#define GN_SMALLEST_EXTENT 7.8886091e-31f

// Factor from a doubled centroid's distance to its lower bound to a bin number; 0 when the axis cannot be split.
GN_INLINE gn_f32 gn_bin_scale(gn_f32 centroid_lo, gn_f32 centroid_hi, gn_u32 bins) {
  const gn_f32 extent = centroid_hi - centroid_lo;
  return extent > GN_SMALLEST_EXTENT ? (gn_f32)bins * gn_reciprocal(extent) : 0.0f;
}

// Bin of a doubled centroid, in [0, bins).
GN_INLINE gn_u32 gn_bin_of(gn_f32 twice_centroid, gn_f32 centroid_lo, gn_f32 scale, gn_u32 bins) {
  const gn_u32 bin = (gn_u32)((twice_centroid - centroid_lo) * scale);
  return bin < bins ? bin : bins - 1u;
}

// Whether candidate a beats b: lower cost, then the more even division. Callers offer candidates by rising axis and
// plane, so the first of equals stays: a total order, the same on every device.
GN_INLINE int gn_split_is_better(const GnSplit* a, const GnSplit* b, gn_u32 count) {
  if (a->cost < b->cost) return 1;
  if (!(a->cost == b->cost)) return 0;
  {
    const gn_u32 even_a = a->left_count < count - a->left_count ? a->left_count : count - a->left_count;
    const gn_u32 even_b = b->left_count < count - b->left_count ? b->left_count : count - b->left_count;
    return even_a > even_b;
  }
}

GN_INLINE void gn_empty_box(gn_f32* lo, gn_f32* hi) {
  int k;
  for (k = 0; k < 3; ++k) {
    lo[k] = GN_INFINITY;
    hi[k] = -GN_INFINITY;
  }
}

GN_INLINE void gn_grow_box(gn_f32* lo, gn_f32* hi, GN_BINS_SPACE const GnBin* bin) {
  int k;
  for (k = 0; k < 3; ++k) {
    lo[k] = gn_min(lo[k], bin->lo[k]);
    hi[k] = gn_max(hi[k], bin->hi[k]);
  }
}

// Best plane of one axis: bins [0, plane] go left. cost is measure(L) n_L + measure(R) n_R, without constants.
// axis == GN_NONE when all centroids share a bin. bins and counts are the axis' own, bin_count of each.
GN_INLINE GnSplit gn_sweep_axis(GN_BINS_SPACE const GnBin* bins, GN_BINS_SPACE const gn_u32* counts, gn_u32 bin_count,
                                gn_u32 axis, gn_u32 count) {
  gn_f32 right_cost[GN_MAX_BINS];
  gn_f32 lo[3], hi[3], cost = 0.0f;
  gn_u32 i, seen = 0u;
  GnSplit best = {GN_INFINITY, GN_NONE, 0u, 0u};
  gn_empty_box(lo, hi);
  for (i = bin_count - 1u; i > 0u; --i) {
    if (counts[i] > 0u) {
      gn_grow_box(lo, hi, &bins[i]);
      seen += counts[i];
      cost = gn_box_measure(lo, hi) * (gn_f32)seen;
    }
    right_cost[i] = cost;
  }
  gn_empty_box(lo, hi);
  seen = 0u;
  for (i = 0u; i + 1u < bin_count; ++i) {
    if (counts[i] == 0u) continue;  // the plane before this bin divides alike
    gn_grow_box(lo, hi, &bins[i]);
    seen += counts[i];
    if (seen < count) {
      GnSplit candidate = {0.0f, axis, i, seen};
      candidate.cost = gn_box_measure(lo, hi) * (gn_f32)seen + right_cost[i + 1u];
      if (best.axis == GN_NONE || gn_split_is_better(&candidate, &best, count)) best = candidate;
    }
  }
  return best;
}

// Whether `count` triangles are cheaper tested here than divided by `split` (which may be none).
GN_INLINE int gn_leaf_is_better(const GnSplit* split, gn_f32 node_measure, gn_u32 count, gn_f32 cost_traversal,
                                gn_f32 cost_triangle) {
  if (split->axis == GN_NONE) return 1;
  return cost_triangle * ((gn_f32)count * node_measure) <=
         cost_traversal * node_measure + cost_triangle * split->cost;
}

#endif
