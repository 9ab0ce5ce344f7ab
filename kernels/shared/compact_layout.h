// The compact tree, for devices where memory traffic decides: nodes of 80 bytes whose eight boxes are quantised, and
// triangles that share their corners. Made by quantise.cl from the wide tree, read by trace_compact.cl and by their
// references. Same rules as layout.h. Source: Ylitie, Karras, Laine 2017 (the node; ours counts triangles by bytes).
#ifndef GNOMON_SHARED_COMPACT_LAYOUT_H
#define GNOMON_SHARED_COMPACT_LAYOUT_H

#include "layout.h"

// One node of eight slots. Step q of axis k lies at origin[k] + q * 2^(scale - 127), added in float. scales: byte k is
// the scale of axis k; byte 3 has a bit for each slot that holds a node. Those nodes lie side by side from first_node
// on, in order of slots. counts: a byte for each slot, the triangles of one that holds a leaf, else 0; they lie side by
// side from first_triangle on, in order of slots. planes: a byte for each slot, lower x, upper x, lower y, upper y,
// lower z, upper z; bytes of empty slots are 0.
typedef struct GnCompactNode {
  gn_f32 origin[3];
  gn_u32 scales;
  gn_u32 first_node;
  gn_u32 first_triangle;
  gn_u32 counts[2];
  gn_u32 planes[6][2];
} GnCompactNode;
GN_SIZE_IS(GnCompactNode, 80);

#define GN_MAX_COMPACT_LEAF 255u

// A triangle where corners are shared: places of its corners among the vertices, and its number in the caller's array.
typedef struct GnIndexedTriangle {
  gn_u32 corners[3];
  gn_u32 primitive;
} GnIndexedTriangle;
GN_SIZE_IS(GnIndexedTriangle, 16);

// One of the distinct positions of corners: no two have the same bits.
typedef struct GnVertex {
  gn_f32 position[3];
} GnVertex;
GN_SIZE_IS(GnVertex, 12);

// A triangle where corners are hardly shared.
typedef struct GnPlainTriangle {
  gn_f32 corners[9];
  gn_u32 primitive;
} GnPlainTriangle;
GN_SIZE_IS(GnPlainTriangle, 40);

// Whether sharing corners takes less memory, or as much: 16 bytes a triangle and 12 a vertex against 40 a triangle.
GN_INLINE int gn_sharing_pays(gn_u32 triangles, gn_u32 vertices) {
  return vertices / 2u + (vertices & 1u) <= triangles;
}

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

// Where a step of an axis lies, as traversal knows it. The product is exact, so a fused sum is the same.
GN_INLINE gn_f32 gn_plane_at(gn_f32 origin, gn_f32 scale, gn_u32 step) { return origin + (gn_f32)step * scale; }
GN_INLINE gn_f32 gn_axis_scale(gn_u32 scales, gn_u32 axis) {
  return gn_float_of(((scales >> (8u * axis)) & 255u) << 23);
}

#endif
