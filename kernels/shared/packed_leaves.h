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

// An integer that is greater where the float of these bits is; -0 is below 0. And back.
GN_INLINE gn_u32 gn_pack_key(gn_u32 bits) {
  return bits ^ ((bits & 0x80000000u) != 0u ? 0xffffffffu : 0x80000000u);
}
GN_INLINE gn_u32 gn_unpack_key(gn_u32 key) { return key ^ ((key & 0x80000000u) != 0u ? 0x80000000u : 0xffffffffu); }

GN_INLINE gn_u32 gn_pack_width(gn_u32 widths, gn_u32 column) { return (widths >> (6u * column)) & 63u; }

// The field of `width` bits, at most 32, that begins at this bit. Reads the word after the field too.
GN_INLINE gn_u32 gn_field_at(GN_GLOBAL const gn_u32* fields, gn_u32 bit, gn_u32 width) {
  const gn_u32 low = fields[bit >> 5], high = fields[(bit >> 5) + 1u], shift = bit & 31u;
  const gn_u32 mask = ((1u << (width & 31u)) - 1u) | (0u - (width >> 5));
  return ((low >> shift) | ((high << 1) << (31u - shift))) & mask;
}

// A node's leaves, ready to be read: the bits that a triangle and a vertex take, and the bit where vertices begin.
typedef struct GnPackedLeaves {
  GN_GLOBAL const gn_u32* fields;
  GnPackHead head;
  gn_u32 triangle_bits;
  gn_u32 vertex_bits;
  gn_u32 vertices;
} GnPackedLeaves;

GN_INLINE gn_u32 gn_triangle_bits(gn_u32 widths) {
  return 3u * gn_pack_width(widths, GN_PLACE_COLUMN) + gn_pack_width(widths, GN_NUMBER_COLUMN);
}
GN_INLINE gn_u32 gn_vertex_bits(gn_u32 widths) {
  return gn_pack_width(widths, 0u) + gn_pack_width(widths, 1u) + gn_pack_width(widths, 2u);
}

// words: where the node's head is. count: triangles in all its leaves.
GN_INLINE GnPackedLeaves gn_open_leaves(GN_GLOBAL const gn_u32* words, gn_u32 count) {
  GnPackedLeaves leaves;
  int k;
  leaves.fields = words + GN_PACK_HEAD_WORDS;
  leaves.head.widths = words[0];
  for (k = 0; k < 4; ++k) leaves.head.least[k] = words[1 + k];
  leaves.triangle_bits = gn_triangle_bits(leaves.head.widths);
  leaves.vertex_bits = gn_vertex_bits(leaves.head.widths);
  leaves.vertices = count * leaves.triangle_bits;
  return leaves;
}

// The triangle that is the index-th of the node, in order of slots.
GN_INLINE GnPlainTriangle gn_packed_triangle(const GnPackedLeaves* leaves, gn_u32 index) {
  const gn_u32 widths = leaves->head.widths, places = gn_pack_width(widths, GN_PLACE_COLUMN);
  const gn_u32 record = index * leaves->triangle_bits;
  const gn_u32 all_places = gn_field_at(leaves->fields, record, 3u * places);
  GnPlainTriangle out;
  gn_u32 corner, axis;
  for (corner = 0u; corner < 3u; ++corner) {
    const gn_u32 place =
        places == 0u ? 3u * index + corner : (all_places >> (corner * places)) & ((1u << places) - 1u);
    gn_u32 bit = leaves->vertices + place * leaves->vertex_bits;
    for (axis = 0u; axis < 3u; ++axis) {
      const gn_u32 width = gn_pack_width(widths, axis);
      out.corners[3u * corner + axis] =
          gn_unpack_key(leaves->head.least[axis] + gn_field_at(leaves->fields, bit, width));
      bit += width;
    }
  }
  out.number = leaves->head.least[GN_NUMBER_COLUMN] +
               gn_field_at(leaves->fields, record + 3u * places, gn_pack_width(widths, GN_NUMBER_COLUMN));
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

// The head of a node of `count` triangles, and how many words it takes with its fields. places: for each corner the
// first that equals it, or anything in nodes of more than GN_MOST_SHARING; receives its place among the vertices.
GN_INLINE gn_u32 gn_measure_leaves(GN_GLOBAL const GnPlainTriangle* triangles, GN_GLOBAL gn_u32* places, gn_u32 count,
                                   GN_GLOBAL GnPackHead* head) {
  gn_u32 least[4] = {0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu}, most[4] = {0u, 0u, 0u, 0u};
  gn_u32 vertices = 0u, widths = 0u, shared, apart, place_width, corner, column;
  for (corner = 0u; corner < 3u * count; ++corner) {
    for (column = 0u; column < 4u; ++column) {
      const gn_u32 value = column == GN_NUMBER_COLUMN
                               ? triangles[corner / 3u].number
                               : gn_pack_key(triangles[corner / 3u].corners[3u * (corner % 3u) + column]);
      least[column] = value < least[column] ? value : least[column];
      most[column] = value > most[column] ? value : most[column];
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
