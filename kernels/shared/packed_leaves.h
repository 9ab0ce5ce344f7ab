// The triangles of a compact node's leaves, packed without loss: near each other, they differ in their lower bits alone.
// Corners, as bits of floats in the floats' order, and numbers are stored less the least of the node, in as many bits as
// the largest difference takes; corners that are equal are stored once where that is smaller. Made by quantise.cl and
// compact.cpp, read by trace_compact.cl. Same rules as layout.h; corners are never floats here, so that devices which
// flush denormals keep them.
#ifndef GNOMON_SHARED_PACKED_LEAVES_H
#define GNOMON_SHARED_PACKED_LEAVES_H

#include "scalar.h"

// Columns: x, y and z of corners, the triangles' numbers, and the corners' places among the node's vertices.
#define GN_NUMBER_COLUMN 3u
#define GN_PLACE_COLUMN 4u

// Before the fields of a node. widths: six bits for each column, how wide its fields are; places have none where no
// corner is shared, the vertices then being the corners in order. least: what is taken off the first four columns. After
// it, bit by bit from the lowest of each word and with none left out: for each triangle three places and its number; for
// each vertex x, y, z. Filled up with 0 to whole words.
typedef struct GnPackHead {
  gn_u32 widths;
  gn_u32 least[4];
} GnPackHead;
GN_SIZE_IS(GnPackHead, 20);
#define GN_PACK_HEAD_WORDS 5u

// A triangle before it is packed: the bits of its nine coordinates and its number.
typedef struct GnPlainTriangle {
  gn_u32 corners[9];
  gn_u32 number;
} GnPlainTriangle;
GN_SIZE_IS(GnPlainTriangle, 40);

// Nodes of more triangles than this share no corners: looking for them grows with the square.
#define GN_MOST_SHARING 85u

// For the bits of a float an integer that, signed, is greater where the float is, -0 below 0; for that integer the bits.
GN_INLINE gn_u32 gn_pack_key(gn_u32 bits) { return bits ^ ((gn_u32)((gn_i32)bits >> 31) & 0x7fffffffu); }

GN_INLINE gn_u32 gn_pack_width(gn_u32 widths, gn_u32 column) { return (widths >> (6u * column)) & 63u; }

GN_INLINE gn_u32 gn_triangle_bits(gn_u32 widths) {
  return 3u * gn_pack_width(widths, GN_PLACE_COLUMN) + gn_pack_width(widths, GN_NUMBER_COLUMN);
}
GN_INLINE gn_u32 gn_vertex_bits(gn_u32 widths) {
  return gn_pack_width(widths, 0u) + gn_pack_width(widths, 1u) + gn_pack_width(widths, 2u);
}

// The lowest `width` bits, at most 32.
GN_INLINE gn_u32 gn_field_mask(gn_u32 width) { return ((1u << (width & 31u)) - 1u) | (0u - (width >> 5)); }

// A field of a mask's width that begins at this bit. Reads the word after it too. On x86 one load of 64 bits.
GN_INLINE gn_u32 gn_field_at(GN_GLOBAL const gn_u32* fields, gn_u32 bit, gn_u32 mask) {
#ifdef __OPENCL_VERSION__
  const uint2 words = vload2(0, fields + (bit >> 5));
  return (gn_u32)((((ulong)words.y << 32) | words.x) >> (bit & 31u)) & mask;
#else
  const std::uint64_t low = fields[bit >> 5], high = fields[(bit >> 5) + 1u];
  return static_cast<gn_u32>((high << 32 | low) >> (bit & 31u)) & mask;
#endif
}

// A node's leaves, ready to be read: bits that a triangle and a vertex take, the bit where vertices begin, and of each
// column what gn_field_at needs.
typedef struct GnPackedLeaves {
  GN_GLOBAL const gn_u32* fields;
  gn_u32 triangle_bits;
  gn_u32 vertex_bits;
  gn_u32 vertices;
  gn_u32 place_width;
  gn_u32 y;  // bits from a vertex to its y
  gn_u32 z;
  gn_u32 masks[5];
  gn_u32 least[4];
} GnPackedLeaves;

// words: where the node's head is. count: triangles in all its leaves.
GN_INLINE void gn_open_leaves(GN_GLOBAL const gn_u32* words, gn_u32 count, GnPackedLeaves* leaves) {
  const gn_u32 widths = words[0];
  int k;
  leaves->fields = words + GN_PACK_HEAD_WORDS;
  leaves->triangle_bits = gn_triangle_bits(widths);
  leaves->vertex_bits = gn_vertex_bits(widths);
  leaves->vertices = count * leaves->triangle_bits;
  leaves->place_width = gn_pack_width(widths, GN_PLACE_COLUMN);
  leaves->y = gn_pack_width(widths, 0u);
  leaves->z = leaves->y + gn_pack_width(widths, 1u);
  for (k = 0; k < 5; ++k) leaves->masks[k] = gn_field_mask(gn_pack_width(widths, (gn_u32)k));
  for (k = 0; k < 4; ++k) leaves->least[k] = words[1 + k];
}

GN_INLINE gn_u32 gn_packed_value(const GnPackedLeaves* leaves, gn_u32 column, gn_u32 bit) {
  return leaves->least[column] + gn_field_at(leaves->fields, bit, leaves->masks[column]);
}

// Without a loop: compilers keep it, and the three fields wait for each other.
GN_INLINE void gn_packed_vertex(const GnPackedLeaves* leaves, gn_u32 place, gn_u32* out) {
  const gn_u32 x = leaves->vertices + place * leaves->vertex_bits;
  out[0] = gn_pack_key(gn_packed_value(leaves, 0u, x));
  out[1] = gn_pack_key(gn_packed_value(leaves, 1u, x + leaves->y));
  out[2] = gn_pack_key(gn_packed_value(leaves, 2u, x + leaves->z));
}

// The triangle that is the index-th of the node, in order of slots.
GN_INLINE GnPlainTriangle gn_packed_triangle(const GnPackedLeaves* leaves, gn_u32 index) {
  const gn_u32 record = index * leaves->triangle_bits, width = leaves->place_width;
  const gn_u32 mask = leaves->masks[GN_PLACE_COLUMN];
  const gn_u32 places = gn_field_at(leaves->fields, record, 0xffffffffu);
  GnPlainTriangle out;
  gn_packed_vertex(leaves, width == 0u ? 3u * index : places & mask, out.corners);
  gn_packed_vertex(leaves, width == 0u ? 3u * index + 1u : (places >> width) & mask, out.corners + 3);
  gn_packed_vertex(leaves, width == 0u ? 3u * index + 2u : (places >> (2u * width)) & mask, out.corners + 6);
  out.number = gn_packed_value(leaves, GN_NUMBER_COLUMN, record + 3u * width);
  return out;
}

GN_INLINE gn_u32 gn_bits_needed(gn_u32 value) {
  gn_u32 width = 0u;
  for (; value != 0u; value >>= 1) width += 1u;
  return width;
}

// The first of the corners [0, corner) of a node with the same bits as `corner`, or itself.
GN_INLINE gn_u32 gn_first_equal(GN_GLOBAL const GnPlainTriangle* triangles, gn_u32 corner) {
  GN_GLOBAL const gn_u32* own = triangles[corner / 3u].corners + 3u * (corner % 3u);
  gn_u32 other;
  for (other = 0u; other < corner; ++other) {
    GN_GLOBAL const gn_u32* bits = triangles[other / 3u].corners + 3u * (other % 3u);
    if (bits[0] == own[0] && bits[1] == own[1] && bits[2] == own[2]) break;
  }
  return other;
}

// Numbers are compared without sign, keys with it.
GN_INLINE int gn_is_before(gn_u32 a, gn_u32 b, gn_u32 column) {
  return column == GN_NUMBER_COLUMN ? a < b : (gn_i32)a < (gn_i32)b;
}

// The head of a node of `count` triangles, and how many words it takes with its fields. places: for each corner the
// first that equals it, or anything in nodes of more than GN_MOST_SHARING; receives its place among the vertices.
GN_INLINE gn_u32 gn_measure_leaves(GN_GLOBAL const GnPlainTriangle* triangles, GN_GLOBAL gn_u32* places, gn_u32 count,
                                   GN_GLOBAL GnPackHead* head) {
  gn_u32 least[4], most[4], vertices = 0u, widths = 0u, shared, apart, place_width, corner, column;
  for (corner = 0u; corner < 3u * count; ++corner) {
    for (column = 0u; column < 4u; ++column) {
      const gn_u32 value = column == GN_NUMBER_COLUMN
                               ? triangles[corner / 3u].number
                               : gn_pack_key(triangles[corner / 3u].corners[3u * (corner % 3u) + column]);
      if (corner == 0u || gn_is_before(value, least[column], column)) least[column] = value;
      if (corner == 0u || gn_is_before(most[column], value, column)) most[column] = value;
    }
    if (count > GN_MOST_SHARING || places[corner] == corner) {
      places[corner] = vertices;
      vertices += 1u;
    } else {
      places[corner] = places[places[corner]];
    }
  }
  for (column = 0u; column < 4u; ++column) {
    head->least[column] = least[column];
    widths |= gn_bits_needed(most[column] - least[column]) << (6u * column);
  }
  place_width = vertices > 2u ? gn_bits_needed(vertices - 1u) : 1u;
  shared = 3u * count * place_width + vertices * gn_vertex_bits(widths);
  apart = 3u * count * gn_vertex_bits(widths);
  if (shared < apart) widths |= place_width << (6u * GN_PLACE_COLUMN);
  head->widths = widths;
  return GN_PACK_HEAD_WORDS +
         ((shared < apart ? shared : apart) + count * gn_pack_width(widths, GN_NUMBER_COLUMN) + 31u) / 32u;
}

// Where fields are appended.
typedef struct GnFieldWriter {
  GN_GLOBAL gn_u32* next;
  gn_u32 word;
  gn_u32 used;
} GnFieldWriter;

GN_INLINE void gn_append(GnFieldWriter* to, gn_u32 value, gn_u32 width) {
  to->word |= value << to->used;
  to->used += width;
  if (to->used < 32u) return;
  *to->next = to->word;
  to->next += 1;
  to->used -= 32u;
  to->word = to->used == 0u ? 0u : value >> (width - to->used);
}

// Writes head and fields of a node to words, as many as gn_measure_leaves said.
GN_INLINE void gn_write_leaves(GN_GLOBAL const GnPlainTriangle* triangles, GN_GLOBAL const gn_u32* places, gn_u32 count,
                               GN_GLOBAL const GnPackHead* head, GN_GLOBAL gn_u32* words) {
  const gn_u32 widths = head->widths, place_width = gn_pack_width(widths, GN_PLACE_COLUMN);
  gn_u32 corner, axis, written = 0u;
  GnFieldWriter to;
  words[0] = widths;
  for (axis = 0u; axis < 4u; ++axis) words[1u + axis] = head->least[axis];
  to.next = words + GN_PACK_HEAD_WORDS;
  to.word = 0u;
  to.used = 0u;
  for (corner = 0u; corner < 3u * count; ++corner) {
    if (place_width != 0u) gn_append(&to, places[corner], place_width);
    if (corner % 3u == 2u)
      gn_append(&to, triangles[corner / 3u].number - head->least[GN_NUMBER_COLUMN],
                gn_pack_width(widths, GN_NUMBER_COLUMN));
  }
  for (corner = 0u; corner < 3u * count; ++corner) {
    if (place_width != 0u && places[corner] != written) continue;
    written += 1u;
    for (axis = 0u; axis < 3u; ++axis)
      gn_append(&to, gn_pack_key(triangles[corner / 3u].corners[3u * (corner % 3u) + axis]) - head->least[axis],
                gn_pack_width(widths, axis));
  }
  if (to.used != 0u) *to.next = to.word;
}

#endif
