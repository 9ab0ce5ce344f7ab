// From a wide node to a compact one, for both compilers: which slot a child gets, and planes that are conservative by
// construction: a step is taken only if the float that traversal will make of it is not inside the box. Nothing is
// denormal on the way, and floats are compared by their bits, so that devices which flush agree. Boxes within 2^48, as
// builders demand. Not for corners (quantise.cl, compact.cpp).
// Source: Ylitie, Karras, Laine 2017 (slots by octant; they assign by auction, we take the best pair each time).
#ifndef GNOMON_SHARED_COMPACT_MATH_H
#define GNOMON_SHARED_COMPACT_MATH_H

#include "compact_layout.h"
#include "wide_layout.h"

#ifdef __OPENCL_VERSION__
#define GN_WIDE_SPACE __global
#else
#define GN_WIDE_SPACE
#endif

// Scales are at least 2^-100 and origins are 0 or at least 2^-102: sums of an origin and steps are then 0 or normal.
#define GN_LEAST_SCALE 27u
#define GN_MOST_SCALE 247u
#define GN_LEAST_ORIGIN 1.9721523e-31f

// An integer that is less where the float is; both zeros are 0. Infinities count, NaN does not.
GN_INLINE gn_i32 gn_order_of(gn_f32 x) {
  const gn_u32 bits = gn_bits_of(x);
  return (bits & 0x80000000u) != 0u ? -(gn_i32)(bits & 0x7fffffffu) : (gn_i32)bits;
}
GN_INLINE int gn_is_below(gn_f32 a, gn_f32 b) { return gn_order_of(a) < gn_order_of(b); }

// The origin of an axis whose lowest plane is lo.
GN_INLINE gn_f32 gn_quantised_origin(gn_f32 lo) {
  if (gn_order_of(gn_abs(lo)) >= gn_order_of(GN_LEAST_ORIGIN)) return lo;
  return gn_is_below(lo, 0.0f) ? -GN_LEAST_ORIGIN : 0.0f;
}

// The least scale with which 255 steps reach hi, as the biased exponent.
GN_INLINE gn_u32 gn_quantised_scale(gn_f32 origin, gn_f32 hi) {
  const gn_u32 exponent = (gn_bits_of(hi - origin) >> 23) & 255u;
  gn_u32 scale = exponent < GN_LEAST_SCALE + 8u ? GN_LEAST_SCALE : exponent - 8u;
  while (scale < GN_MOST_SCALE && gn_is_below(gn_plane_at(origin, gn_float_of(scale << 23), 255u), hi)) scale += 1u;
  return scale;
}

// The whole steps in x - origin, about; at most 255.
GN_INLINE gn_u32 gn_steps_in(gn_f32 origin, gn_u32 scale, gn_f32 x) {
  const gn_f32 steps = (x - origin) * gn_float_of((254u - scale) << 23);
  return steps < 255.0f ? (gn_u32)steps : 255u;
}

GN_INLINE gn_u32 gn_step_below(gn_f32 origin, gn_u32 scale, gn_f32 lo) {
  gn_u32 step = gn_steps_in(origin, scale, lo);
  while (step > 0u && gn_is_below(lo, gn_plane_at(origin, gn_float_of(scale << 23), step))) step -= 1u;
  return step;
}

GN_INLINE gn_u32 gn_step_above(gn_f32 origin, gn_u32 scale, gn_f32 hi) {
  gn_u32 step = gn_steps_in(origin, scale, hi);
  while (step < 255u && gn_is_below(gn_plane_at(origin, gn_float_of(scale << 23), step), hi)) step += 1u;
  return step;
}

// The box of all children.
GN_INLINE void gn_wide_bounds(GN_WIDE_SPACE const GnWideNode* node, gn_f32* lo, gn_f32* hi) {
  gn_u32 slot;
  int k;
  for (k = 0; k < 3; ++k) {
    lo[k] = node->planes[2 * k][0];
    hi[k] = node->planes[2 * k + 1][0];
    for (slot = 1u; slot < GN_WIDTH && node->links[slot] != GN_NONE; ++slot) {
      if (gn_is_below(node->planes[2 * k][slot], lo[k])) lo[k] = node->planes[2 * k][slot];
      if (gn_is_below(hi[k], node->planes[2 * k + 1][slot])) hi[k] = node->planes[2 * k + 1][slot];
    }
  }
}

// Which child of the wide node each slot of the compact one gets, GN_NONE for none. Bit k of a slot says that it is for
// a child on the upper side of axis k: rays meet slots about in the order of slot ^ (bits of axes they go down).
GN_INLINE void gn_assign_slots(GN_WIDE_SPACE const GnWideNode* node, gn_u32* child_of) {
  gn_f32 lo[3], hi[3];
  gn_u32 placed = 0u, slot, child;
  gn_wide_bounds(node, lo, hi);
  for (slot = 0u; slot < GN_WIDTH; ++slot) child_of[slot] = GN_NONE;
  for (;;) {
    gn_u32 best_child = GN_NONE, best_slot = 0u;
    gn_f32 best = 0.0f;
    for (child = 0u; child < GN_WIDTH && node->links[child] != GN_NONE; ++child) {
      gn_f32 d[3];
      int k;
      if ((placed >> child) & 1u) continue;
      for (k = 0; k < 3; ++k)
        d[k] = (node->planes[2 * k][child] + node->planes[2 * k + 1][child]) - (lo[k] + hi[k]);
      for (slot = 0u; slot < GN_WIDTH; ++slot) {
        const gn_f32 gain =
            ((slot & 1u) ? d[0] : -d[0]) + ((slot & 2u) ? d[1] : -d[1]) + ((slot & 4u) ? d[2] : -d[2]);
        if (child_of[slot] != GN_NONE || !(best_child == GN_NONE || gain > best)) continue;
        best = gain;
        best_child = child;
        best_slot = slot;
      }
    }
    if (best_child == GN_NONE) return;
    child_of[best_slot] = best_child;
    placed |= 1u << best_child;
  }
}

GN_INLINE int gn_is_leaf_link(gn_u32 link) { return (link & GN_LEAF_LINK) != 0u; }

// Everything of the compact node but where its triangles are packed. Children of a wide node that are nodes have
// neighbouring numbers; the least is where their compact nodes go, in order of slots.
GN_INLINE void gn_fill_compact_node(GN_WIDE_SPACE const GnWideNode* node, GN_GLOBAL const gn_u32* leaves,
                                    const gn_u32* child_of, GnCompactNode* out) {
  gn_f32 lo[3], hi[3];
  gn_u32 slot, scale[3];
  int k;
  out->scales = 0u;
  out->first_node = GN_NONE;
  out->leaves = 0u;
  for (k = 0; k < 2; ++k) out->counts[k] = 0u;
  for (k = 0; k < 12; ++k) out->planes[k / 2][k % 2] = 0u;
  gn_wide_bounds(node, lo, hi);
  for (k = 0; k < 3; ++k) {
    out->origin[k] = node->links[0] == GN_NONE ? 0.0f : gn_quantised_origin(lo[k]);
    scale[k] = node->links[0] == GN_NONE ? GN_LEAST_SCALE : gn_quantised_scale(out->origin[k], hi[k]);
    out->scales |= scale[k] << (8 * k);
  }
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const gn_u32 child = child_of[slot], word = slot / 4u, shift = 8u * (slot % 4u);
    gn_u32 link;
    if (child == GN_NONE) continue;
    link = node->links[child];
    for (k = 0; k < 3; ++k) {
      out->planes[2 * k][word] |= gn_step_below(out->origin[k], scale[k], node->planes[2 * k][child]) << shift;
      out->planes[2 * k + 1][word] |= gn_step_above(out->origin[k], scale[k], node->planes[2 * k + 1][child]) << shift;
    }
    if (gn_is_leaf_link(link)) {
      out->counts[word] |= (gn_leaf_at(leaves, link).count & 255u) << shift;
    } else {
      out->scales |= 1u << (24u + slot);
      if (link < out->first_node) out->first_node = link;
    }
  }
  if (out->first_node == GN_NONE) out->first_node = 0u;
}

// The first place of a wide node's leaves: they have neighbouring places. GN_NONE for a node without leaves.
GN_INLINE gn_u32 gn_first_place(GN_WIDE_SPACE const GnWideNode* node) {
  gn_u32 slot, first = GN_NONE;
  for (slot = 0u; slot < GN_WIDTH && node->links[slot] != GN_NONE; ++slot) {
    const gn_u32 link = node->links[slot];
    if (gn_is_leaf_link(link) && gn_link_place(link) < first) first = gn_link_place(link);
  }
  return first;
}

#endif
