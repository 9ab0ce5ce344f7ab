// The compact tree, for devices where memory traffic decides: nodes of 80 bytes whose eight boxes are quantised, and the
// triangles of each node's leaves packed (packed_leaves.h). Made by quantise.cl from the wide tree, read by
// trace_compact.cl and by their references. Same rules as layout.h.
// Source: Ylitie, Karras, Laine 2017 (the node; ours counts triangles by bytes).
#ifndef GNOMON_SHARED_COMPACT_LAYOUT_H
#define GNOMON_SHARED_COMPACT_LAYOUT_H

#include "layout.h"
#include "packed_leaves.h"

// One node of eight slots. Step q of axis k lies at origin[k] + q * 2^(scale - 127), added in float. scales: byte k is
// the scale of axis k; byte 3 has a bit for each slot that holds a node. Those nodes lie side by side from first_node
// on, in order of slots. counts: a byte for each slot, the triangles of one that holds a leaf, else 0. leaves: the word
// where all of them are packed, in order of slots; 0 where there are none. planes: a byte for each slot, lower x, upper
// x, lower y, upper y, lower z, upper z; bytes of empty slots are 0.
typedef struct GnCompactNode {
  gn_f32 origin[3];
  gn_u32 scales;
  gn_u32 first_node;
  gn_u32 leaves;
  gn_u32 counts[2];
  gn_u32 planes[6][2];
} GnCompactNode;
GN_SIZE_IS(GnCompactNode, 80);

#define GN_MAX_COMPACT_LEAF 255u

GN_INLINE gn_u32 gn_byte_of(const gn_u32* words, gn_u32 slot) {
  return (words[slot / 4u] >> (8u * (slot % 4u))) & 255u;
}

// The sum of the bytes of the slots before this one.
GN_INLINE gn_u32 gn_bytes_before(const gn_u32* words, gn_u32 slot) {
  const gn_u32 part = (1u << (8u * (slot % 4u))) - 1u;
  const gn_u32 low = slot < 4u ? words[0] & part : words[0];
  const gn_u32 high = slot < 4u ? 0u : words[1] & part;
  const gn_u32 pairs =
      (low & 0x00ff00ffu) + ((low >> 8) & 0x00ff00ffu) + (high & 0x00ff00ffu) + ((high >> 8) & 0x00ff00ffu);
  return (pairs & 0xffffu) + (pairs >> 16);
}

// Triangles in all leaves of a node.
GN_INLINE gn_u32 gn_leaf_triangles(const gn_u32* counts) { return gn_bytes_before(counts, 7u) + gn_byte_of(counts, 7u); }

// Where a step of an axis lies, as traversal knows it. The product is exact, so a fused sum is the same.
GN_INLINE gn_f32 gn_plane_at(gn_f32 origin, gn_f32 scale, gn_u32 step) { return origin + (gn_f32)step * scale; }
GN_INLINE gn_f32 gn_axis_scale(gn_u32 scales, gn_u32 axis) {
  return gn_float_of(((scales >> (8u * axis)) & 255u) << 23);
}

#endif
