// What decides the fast builder's tree: Morton codes, which clusters merge, which of them become leaves. For both
// compilers, without division. Sources: Morton codes of cubic cells (Lauterbach and others 2009); merging mutual nearest
// neighbours along the curve (PLOC: Meister, Bittner 2018). Feeds morton.cl, ploc.cl and build_fast_reference.cpp.
#ifndef GNOMON_SHARED_FAST_MATH_H
#define GNOMON_SHARED_FAST_MATH_H

#include "cost_math.h"
#include "fast_layout.h"

GN_INLINE GnMortonFrame gn_morton_frame(const gn_f32* lo, const gn_f32* hi) {
  GnMortonFrame frame;
  const gn_f32 extent = gn_max(hi[0] - lo[0], gn_max(hi[1] - lo[1], hi[2] - lo[2]));
  int k;
  for (k = 0; k < 3; ++k) frame.lo[k] = lo[k];
  frame.scale = gn_bin_scale(0.0f, extent, 1u << GN_CELL_BITS);
  return frame;
}

// Ten bits, two zeros above each.
GN_INLINE gn_u32 gn_spread_bits(gn_u32 x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

// fine: the lower ten bits of each axis' cell number instead of the upper ten.
GN_INLINE gn_u32 gn_morton_code(GnMortonFrame frame, gn_f32 x, gn_f32 y, gn_f32 z, int fine) {
  const gn_u32 i = gn_bin_of(x, frame.lo[0], frame.scale, 1u << GN_CELL_BITS);
  const gn_u32 j = gn_bin_of(y, frame.lo[1], frame.scale, 1u << GN_CELL_BITS);
  const gn_u32 k = gn_bin_of(z, frame.lo[2], frame.scale, 1u << GN_CELL_BITS);
  const gn_u32 shift = fine ? 0u : 10u;
  return gn_spread_bits((i >> shift) & 1023u) << 2 | gn_spread_bits((j >> shift) & 1023u) << 1 |
         gn_spread_bits((k >> shift) & 1023u);
}

// How far apart two clusters are, as an integer: the surface of the box around both, its lowest bits replaced by four
// that tell a cluster's candidates apart. distance of places >= 1; lower: the lower of the two places. The pair's key is
// the same seen from both ends, so the least of all keys always merges two; among equals every other cluster pairs with
// the next.
GN_INLINE gn_u32 gn_pair_key(gn_f32 half_area, gn_u32 distance, gn_u32 lower) {
  const gn_u32 lowest = distance & 1u ? 0u : distance & 2u ? 1u : 2u;  // place of the lowest bit that is set
  return (gn_bits_of(half_area) & ~15u) | ((distance - 1u) << 1) | ((lower >> lowest) & 1u);
}

// The place of the partner a key stands for, as seen from `place`.
GN_INLINE gn_u32 gn_pair_partner(gn_u32 key, gn_u32 place) {
  const gn_u32 distance = ((key & 15u) >> 1) + 1u;
  const gn_u32 lowest = distance & 1u ? 0u : distance & 2u ? 1u : 2u;
  return ((place >> lowest) & 1u) == (key & 1u) ? place + distance : place - distance;
}

// When a leaf is better than two children (the surface area heuristic).
typedef struct GnLeafRule {
  gn_f32 cost_traversal;
  gn_f32 cost_triangle;
  gn_u32 max_leaf_size;
} GnLeafRule;

GN_INLINE gn_f32 gn_triangle_cost(GnLeafRule rule, gn_f32 half_area) { return rule.cost_triangle * half_area; }

// The counts of a merge, whose expected cost goes to *cost. counts: triangles, and in the upper half inner nodes.
GN_INLINE gn_u32 gn_merge_counts(GnLeafRule rule, gn_f32 half_area, gn_f32 children_cost, gn_u32 left_counts,
                                 gn_u32 right_counts, gn_f32* cost) {
  const gn_u32 counts = left_counts + right_counts;
  const gn_u32 triangles = counts & 0xffffu;
  const gn_f32 divided = rule.cost_traversal * half_area + children_cost;
  const gn_f32 whole = rule.cost_triangle * ((gn_f32)triangles * half_area);
  const int leaf = triangles <= rule.max_leaf_size && whole <= divided;
  *cost = leaf ? whole : divided;
  return leaf ? triangles : counts + 0x10000u;
}

#endif
