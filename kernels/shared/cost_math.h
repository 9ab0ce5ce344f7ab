// What decides a tree: binning and the split sweep. Compiled by both compilers and free of division,
// so that every device and the reference builder take bitwise the same decisions (needs -ffp-contract=off on the
// host; kernels switch contraction off in scalar.h). Not for intersection tests (hit_math.h).
// Feeds axis_policy.h, bin.h and the reference builder.
#ifndef GNOMON_SHARED_COST_MATH_H
#define GNOMON_SHARED_COST_MATH_H

#include "measure_math.h"

// Where bins live when a sweep reads them: local memory on a device.
#ifdef __OPENCL_VERSION__
#define GN_BINS_SPACE __local
#else
#define GN_BINS_SPACE
#endif

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

// Whether candidate a beats b: lower cost, then lower cost by surface area, then the more even division. Callers offer
// candidates by rising axis and plane, so the first of equals stays: a total order, the same on every device.
GN_INLINE int gn_split_is_better(const GnSplit* a, const GnSplit* b, gn_u32 count) {
  if (a->cost < b->cost) return 1;
  if (!(a->cost == b->cost)) return 0;
  if (a->tie < b->tie) return 1;
  if (!(a->tie == b->tie)) return 0;
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

GN_INLINE GnSplit gn_no_split(void) {
  GnSplit none = {GN_INFINITY, GN_NONE, 0u, 0u, 0.0f, GN_FLOAT_MAX, GN_FLOAT_MAX, 0u};
  return none;
}

// gn_sweep_axis where `how` is a literal (GN_SEEN_NOTHING: the weights w measure all), so that compilers make a loop for
// each way of weighing, and those that most nodes need have no choice and no call in them.
GN_INLINE GnSplit gn_sweep_boxes(const GnMeasure* measure, const int how, const gn_f32* w,
                                 GN_BINS_SPACE const GnBin* bins, GN_BINS_SPACE const gn_u32* counts,
                                 gn_u32 plane_count, gn_u32 bin_count, gn_u32 axis, gn_u32 count) {
  gn_f32 right_cost[GN_MAX_BINS], right_measure[GN_MAX_BINS], right_tie[GN_MAX_BINS];
  gn_f32 lo[3], hi[3], area = 0.0f, cost = 0.0f, tie = 0.0f;
  gn_u32 i, seen = 0u;
  GnSplit best = gn_no_split();
  gn_empty_box(lo, hi);
  for (i = bin_count - 1u; i > 0u; --i) {
    if (counts[i] > 0u) {
      gn_grow_box(lo, hi, &bins[i]);
      seen += counts[i];
      area = how == GN_SEEN_NOTHING ? gn_linear_measure(w, lo, hi) : gn_curved_measure(measure, how, lo, hi);
      cost = area * (gn_f32)seen;
      if (measure->breaks_ties) tie = gn_surface_measure(lo, hi) * (gn_f32)seen;
    }
    right_measure[i] = area;
    right_cost[i] = cost;
    right_tie[i] = tie;
  }
  gn_empty_box(lo, hi);
  seen = 0u;
  for (i = 0u; i < plane_count; ++i) {
    if (counts[i] == 0u) continue;  // the plane before this bin divides alike
    gn_grow_box(lo, hi, &bins[i]);
    seen += counts[i];
    if (seen < count) {
      GnSplit candidate = {0.0f, axis, i, seen, 0.0f, 0.0f, right_measure[i + 1u], 0u};
      candidate.left_measure =
          how == GN_SEEN_NOTHING ? gn_linear_measure(w, lo, hi) : gn_curved_measure(measure, how, lo, hi);
      candidate.cost = candidate.left_measure * (gn_f32)seen + right_cost[i + 1u];
      if (measure->breaks_ties) candidate.tie = gn_surface_measure(lo, hi) * (gn_f32)seen + right_tie[i + 1u];
      if (best.axis == GN_NONE || gn_split_is_better(&candidate, &best, count)) best = candidate;
    }
  }
  return best;
}

// Best plane of one axis: bins [0, plane] go left, plane < plane_count. cost is measure(L) n_L + measure(R) n_R, without
// constants. axis == GN_NONE when all centroids share a side of every plane. bins and counts are the axis' own.
GN_INLINE GnSplit gn_sweep_axis(const GnMeasure* measure, int how, GN_BINS_SPACE const GnBin* bins,
                                GN_BINS_SPACE const gn_u32* counts, gn_u32 plane_count, gn_u32 bin_count,
                                gn_u32 axis, gn_u32 count) {
  gn_f32 w[3];
  if (gn_linear_part(measure, how, w)) {
    return gn_sweep_boxes(measure, GN_SEEN_NOTHING, w, bins, counts, plane_count, bin_count, axis, count);
  }
  if (how == GN_SEEN_ONE_STEP) {
    return gn_sweep_boxes(measure, GN_SEEN_ONE_STEP, w, bins, counts, plane_count, bin_count, axis, count);
  }
  if (how == GN_SEEN_FEW_STEPS) {
    return gn_sweep_boxes(measure, GN_SEEN_FEW_STEPS, w, bins, counts, plane_count, bin_count, axis, count);
  }
  if (how == GN_SEEN_WHOLE) {
    return gn_sweep_boxes(measure, GN_SEEN_WHOLE, w, bins, counts, plane_count, bin_count, axis, count);
  }
  if (gn_kind_of(measure) == GN_MEASURE_WINDOW && how == GN_SEEN_CUT) {
    return gn_sweep_boxes(measure, GN_SEEN_CUT, w, bins, counts, plane_count, bin_count, axis, count);
  }
  return gn_sweep_boxes(measure, GN_SEEN_PRECISE, w, bins, counts, plane_count, bin_count, axis, count);
}

// Rates a split found by other means with this measure: its cost and its sides' measures.
GN_INLINE void gn_rate_split(const GnMeasure* measure, int how, GN_BINS_SPACE const GnBin* bins,
                             GN_BINS_SPACE const gn_u32* counts, gn_u32 bin_count, gn_u32 count, GnSplit* split) {
  gn_f32 lo[3], hi[3];
  gn_u32 i;
  gn_empty_box(lo, hi);
  for (i = 0u; i <= split->plane; ++i) {
    if (counts[i] > 0u) gn_grow_box(lo, hi, &bins[i]);
  }
  split->left_measure = gn_box_measure(measure, how, lo, hi);
  gn_empty_box(lo, hi);
  for (i = split->plane + 1u; i < bin_count; ++i) {
    if (counts[i] > 0u) gn_grow_box(lo, hi, &bins[i]);
  }
  split->right_measure = gn_box_measure(measure, how, lo, hi);
  split->cost = split->left_measure * (gn_f32)split->left_count +
                split->right_measure * (gn_f32)(count - split->left_count);
}

// Whether `count` triangles are cheaper tested here than divided by `split` (which may be none).
GN_INLINE int gn_leaf_is_better(const GnSplit* split, gn_f32 node_measure, gn_u32 count, gn_f32 cost_traversal,
                                gn_f32 cost_triangle) {
  if (split->axis == GN_NONE) return 1;
  return cost_triangle * ((gn_f32)count * node_measure) <=
         cost_traversal * node_measure + cost_triangle * split->cost;
}

// Completes a heuristic for the root's box: the scale of surface areas, and the weights of a mixture
// share A(K)/A(root) + (1 - share) S(K)/S(root).
GN_INLINE void gn_settle_heuristic(GnHeuristic* h, const gn_f32* lo, const gn_f32* hi) {
  const gn_f32 surface = gn_surface_measure(lo, hi);
  const gn_f32 scale = surface > 1e-30f ? gn_reciprocal(surface) : 1.0f;
  const gn_f32 share = h->measure.area_share;
  int k;
  h->surface = h->measure;
  h->surface.kind = GN_MEASURE_LINEAR;
  h->surface.breaks_ties = 0u;
  for (k = 0; k < 3; ++k) h->surface.weights[k] = scale;
  if (share < 1.0f) {
    const gn_f32 whole = gn_box_measure(&h->measure, gn_measure_how(&h->measure, lo, hi), lo, hi);
    const gn_f32 area_scale = whole > 1e-30f ? share * gn_reciprocal(whole) : 0.0f;
    for (k = 0; k < 3; ++k) h->measure.weights[k] = h->measure.weights[k] * area_scale + (1.0f - share) * scale;
    h->measure.area_scale *= area_scale;
  }
}

#endif
