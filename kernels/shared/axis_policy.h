// Which axis a node is divided along: the cheapest of all three, or the one or two that a policy lets through (the
// thesis' EvaluateSplittingOrientation, as published and with its faults repaired). Compiled by both compilers.
// SPFH prefers the axis that rays cross least (their children do not hide behind one another), LSPH the longest.
// Source: Falcone, "Ray Distribution Aware Heuristics for BVH Construction" (PoliMi); host/notes/heuristics.md says what
// was wrong. Feeds choose_split in bin.h and the reference builder.
#ifndef GNOMON_SHARED_AXIS_POLICY_H
#define GNOMON_SHARED_AXIS_POLICY_H

#include "cost_math.h"

// A node as a policy sees it.
typedef struct GnNodeView {
  gn_f32 lo[3];
  gn_f32 hi[3];
  gn_f32 probability;  // as its parent's split rated it; GN_FLOAT_MAX at the root
  gn_u32 count;
  gn_u32 depth;
  gn_u32 usable;       // bit k: axis k can be divided
  gn_u32 how;          // its parent's parts, it among them, were measured
} GnNodeView;

// How a policy came to its split, for whoever measures it.
typedef struct GnPolicyEffort {
  gn_u32 axes;           // whose planes were tried, the fallback's among them: the thesis' attempted planes
  gn_u32 fallback_axis;  // the one that the fallback tried, or GN_NONE
} GnPolicyEffort;

// How good each axis is, from 0 to 1. SPFH: (1 - |v_k| / (|v_x| + |v_y| + |v_z|))^2 of the rays' direction v at the node.
GN_INLINE void gn_axis_qualities(const GnHeuristic* h, gn_u32 policy, const GnNodeView* node, gn_f32* quality) {
  gn_f32 v[3], sum;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) {
    const int facing = policy == GN_AXES_SPFH;
    const gn_f32 towards = h->rules.from_point ? 0.5f * (node->lo[k] + node->hi[k]) - h->measure.origin[k]
                                                : h->measure.forward[k];
    v[k] = facing ? gn_abs(towards) : node->hi[k] - node->lo[k];
  }
  sum = policy == GN_AXES_SPFH ? v[0] + v[1] + v[2] : gn_max(gn_max(v[0], v[1]), v[2]);
  for (k = 0u; k < 3u; ++k) {
    const gn_f32 share = sum > 1e-30f ? v[k] * gn_reciprocal(sum) : 1.0f;
    quality[k] = policy == GN_AXES_SPFH ? (1.0f - share) * (1.0f - share) : share;
  }
}

// The longest axis of the node other than `except`.
GN_INLINE gn_u32 gn_longest_axis(const GnNodeView* node, gn_u32 except) {
  gn_u32 k, best = GN_NONE;
  for (k = 0u; k < 3u; ++k) {
    if (k == except) continue;
    if (best == GN_NONE || node->hi[k] - node->lo[k] > node->hi[best] - node->lo[best]) best = k;
  }
  return best;
}

// The best of `quality` not yet in `tried`, a set of bits; of equals the lower axis.
GN_INLINE gn_u32 gn_next_axis(const gn_f32* quality, gn_u32 tried) {
  gn_u32 k, best = GN_NONE;
  for (k = 0u; k < 3u; ++k) {
    if ((tried >> k & 1u) != 0u) continue;
    if (best == GN_NONE || quality[k] > quality[best]) best = k;
  }
  return best;
}

// What surface area rates as the best plane of an axis. Published: with probabilities by surface area, whatever the
// metric. Repaired: rated by the metric.
GN_INLINE GnSplit gn_fallback_split(const GnHeuristic* h, int how, GN_BINS_SPACE const GnBin* bins,
                                    GN_BINS_SPACE const gn_u32* counts, gn_u32 plane_count, gn_u32 bin_count,
                                    gn_u32 axis, gn_u32 count) {
  GnSplit split = gn_sweep_axis(&h->surface, 0, bins, counts, plane_count, bin_count, axis, count);
  if (split.axis != GN_NONE && h->rules.repaired) gn_rate_split(&h->measure, how, bins, counts, bin_count, count, &split);
  return split;
}

// The split that the policy of `h` chooses; bins and counts hold all three axes, bin_count of each. effort may be null.
GN_INLINE GnSplit gn_policy_split(const GnHeuristic* h, int how, const GnNodeView* node,
                                  GN_BINS_SPACE const GnBin* bins, GN_BINS_SPACE const gn_u32* counts,
                                  gn_u32 plane_count, gn_u32 bin_count, GnPolicyEffort* effort) {
  const GnRules* rules = &h->rules;
  const int only_surface = node->depth >= rules->max_metric_depth;
  const gn_u32 policy = only_surface ? GN_AXES_LSPH : rules->axes;
  const gn_f32 father = rules->repaired ? gn_box_measure(&h->measure, how, node->lo, node->hi) : node->probability;
  GnSplit best = gn_no_split();
  gn_f32 quality[3];
  gn_u32 tried = 0u, last = GN_NONE, turn;
  gn_axis_qualities(h, policy, node, quality);
  for (turn = 0u; turn < 3u; ++turn) {
    gn_u32 axis = gn_next_axis(quality, tried);
    const int none_yet = best.axis == GN_NONE;
    const gn_f32 children = best.left_measure + best.right_measure;
    const int poor = quality[axis] < rules->quality_threshold;
    GnSplit split;
    if (!none_yet && children <= rules->excellent * father) break;
    if (poor && !none_yet && children <= rules->acceptable * father) break;
    tried |= 1u << axis;
    if (poor) axis = gn_longest_axis(node, last);
    if (effort != 0) {
      effort->axes += 1u;
      if (poor) effort->fallback_axis = axis;
    }
    if ((node->usable >> axis & 1u) == 0u) {
      if (poor) break;
      last = axis;
      continue;
    }
    if (poor || only_surface) {
      split = gn_fallback_split(h, how, bins + axis * bin_count, counts + axis * bin_count, plane_count, bin_count,
                                axis, node->count);
    } else {
      split = gn_sweep_axis(&h->measure, how, bins + axis * bin_count, counts + axis * bin_count, plane_count,
                            bin_count, axis, node->count);
    }
    // Published: an earlier split, however good, is forgotten when the fallback is reached; one that was found remains
    // only where the fallback finds none, and then without its probabilities.
    if (poor && !rules->repaired && !none_yet) {
      best.cost = GN_INFINITY;
      best.left_measure = GN_FLOAT_MAX;
      best.right_measure = GN_FLOAT_MAX;
    }
    if (split.axis != GN_NONE && (best.axis == GN_NONE || split.cost < best.cost)) best = split;
    if (poor) break;
    last = axis;
  }
  return best;
}

// What a leaf's triangles are weighed by. Where all axes are tried, splits are rated by the measure, and the parent's has
// rated the node; a parent that was halved rates nothing.
GN_INLINE gn_f32 gn_node_measure(const GnHeuristic* h, int how, const GnNodeView* node) {
  const int rated = h->rules.axes == GN_AXES_ALL && node->how == (gn_u32)how && node->probability < GN_FLOAT_MAX;
  return rated ? node->probability : gn_box_measure(&h->measure, how, node->lo, node->hi);
}

// Whether a node is a leaf. split is what the policy found for it, probability and depth the node's own.
GN_INLINE int gn_becomes_leaf(const GnHeuristic* h, int how, const GnNodeView* node, const GnSplit* split) {
  const GnRules* rules = &h->rules;
  if (rules->leaf_rule == GN_LEAF_PUBLISHED) {
    const gn_f32 cost = node->probability * (gn_f32)node->count * rules->cost_triangle;
    if (split->axis == GN_NONE) return 1;
    if (node->depth == 0u) return 0;  // the published program asks this of children only
    return node->depth > rules->max_depth || node->count < rules->max_leaf_size || cost < rules->max_leaf_cost ||
           node->probability < rules->max_leaf_probability ||
           2.0f * gn_surface_measure(node->lo, node->hi) < rules->max_leaf_area;
  }
  if (node->count > rules->max_leaf_size) return 0;
  if (node->count == 1u || split->axis == GN_NONE) return 1;
  return gn_leaf_is_better(split, gn_node_measure(h, how, node), node->count, rules->cost_traversal, rules->cost_triangle);
}

// Whether a node is a leaf whatever split it may find: no split costs less than nothing.
GN_INLINE int gn_is_surely_leaf(const GnHeuristic* h, int how, const GnNodeView* node) {
  const GnRules* rules = &h->rules;
  gn_f32 measure;
  if (node->count == 1u) return 1;
  if (rules->leaf_rule == GN_LEAF_PUBLISHED || node->count > rules->max_leaf_size) return 0;
  measure = gn_node_measure(h, how, node);
  return rules->cost_triangle * ((gn_f32)node->count * measure) <= rules->cost_traversal * measure;
}

#endif
