// From the wide tree to the compact one (shared/compact_layout.h): nodes one by one, children in the order of their
// parent's slots, then triangles, then their corners merged. Corners are sorted by a key of their bits; of those with
// equal bits the first in leaf order stands for all, so the bytes depend neither on the key nor on how the work was
// cut. Every work-item's loops are short.
#include "shared/compact_math.h"

// One work-item per wide node: where the compact nodes of its children go. largest_leaf: of all, in triangles. is_count:
// receives 1 for the places that hold no triangle but how many a long leaf has; filled with 0 before.
__kernel void place_nodes(__global const GnWideNode* wide_nodes, __global const uint* leaves, __global uint* places,
                          volatile __global uint* largest_leaf, __global uint* is_count, uint node_count) {
  const uint index = (uint)get_global_id(0);
  __global const GnWideNode* node = wide_nodes + index;
  uint child_of[GN_WIDTH], slot, first = GN_NONE, nodes = 0u, most = 0u;
  if (index >= node_count) return;
  if (index == 0u) places[0] = 0u;
  gn_assign_slots(node, child_of);
  for (slot = 0u; slot < GN_WIDTH && node->links[slot] != GN_NONE; ++slot) {
    const uint link = node->links[slot];
    if (gn_is_leaf_link(link)) {
      const GnLeaf leaf = gn_leaf_at(leaves, link);
      most = max(most, leaf.count);
      if (leaf.first != gn_link_place(link)) is_count[gn_link_place(link)] = 1u;
    } else {
      first = min(first, link);
    }
  }
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const uint link = child_of[slot] == GN_NONE ? GN_NONE : node->links[child_of[slot]];
    if (link == GN_NONE || gn_is_leaf_link(link)) continue;
    places[link] = first + nodes;
    nodes += 1u;
  }
  if (most > 0u) atomic_max(largest_leaf, most);
}

// One work-item per wide node: writes the compact one, and for each place of its leaves the seat of the triangle there and
// where that goes. counts_before: how many places before each hold no triangle.
__kernel void write_nodes(__global const GnWideNode* wide_nodes, __global const uint* leaves, __global const uint* places,
                          __global const uint* counts_before, __global GnCompactNode* nodes, __global uint2* moves,
                          uint node_count) {
  const uint index = (uint)get_global_id(0);
  __global const GnWideNode* node = wide_nodes + index;
  uint child_of[GN_WIDTH], slot, place, next;
  GnCompactNode out;
  if (index >= node_count) return;
  gn_assign_slots(node, child_of);
  gn_fill_compact_node(node, leaves, child_of, &out);
  place = gn_first_place(node);
  if (place != GN_NONE) out.first_triangle = place - counts_before[place];
  next = out.first_triangle;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const uint link = child_of[slot] == GN_NONE ? GN_NONE : node->links[child_of[slot]];
    uint i;
    if (link == GN_NONE || !gn_is_leaf_link(link)) continue;
    {
      const GnLeaf leaf = gn_leaf_at(leaves, link);
      for (i = 0u; i < leaf.count; ++i) moves[leaf.first + i] = (uint2)(gn_seat_in(leaf, i), next + i);
      next += leaf.count;
    }
  }
  nodes[places[index]] = out;
}

// One work-item per place: writes its triangle, GnPlainTriangle as bits.
__kernel void write_triangles(__global const uint* leaves, __global const uint2* moves,
                              __global const uint* counts_before, __global uint* plain, uint place_count) {
  const uint place = (uint)get_global_id(0);
  uint2 move;
  __global const uint* corners;
  __global uint* out;
  uint k;
  if (place >= place_count || counts_before[place + 1u] != counts_before[place]) return;
  move = moves[place];
  corners = leaves + gn_seat_word(move.x);
  out = plain + GN_TRIANGLE_WORDS * (size_t)move.y;
  for (k = 0u; k < 9u; ++k) out[k] = corners[k * gn_seat_stride(move.x)];
  out[9] = gn_number_at(leaves, move.x);
}

static inline uint3 corner_bits(__global const uint* plain, uint corner) {
  return vload3(0, plain + 10u * (size_t)(corner / 3u) + 3u * (corner % 3u));
}

static inline int has_bits(__global const uint* plain, uint corner, uint3 bits) {
  const uint3 own = corner_bits(plain, corner);
  return own.x == bits.x && own.y == bits.y && own.z == bits.z;
}

// One work-item per corner: a pair of its key and itself.
__kernel void find_corner_keys(__global const uint* plain, __global uint2* pairs, uint key_mask, uint corner_count) {
  const uint corner = (uint)get_global_id(0);
  uint3 bits;
  uint key;
  if (corner >= corner_count) return;
  bits = corner_bits(plain, corner);
  key = bits.x * 0x9e3779b1u;
  key = ((key ^ (key >> 15)) + bits.y) * 0x85ebca77u;
  key = ((key ^ (key >> 13)) + bits.z) * 0xc2b2ae3du;
  key ^= key >> 16;
  pairs[corner] = (uint2)(key & key_mask, corner);
}

// One work-item per pair, sorted by key: the first corner in leaf order with the same bits, and 1 for one that is
// itself.
__kernel void find_first_corners(__global const uint2* pairs, __global const uint* plain, __global uint* first_of,
                                 __global uint* is_first, uint corner_count) {
  const uint index = (uint)get_global_id(0);
  uint low = 0u, high = index, corner, first;
  uint3 bits;
  if (index >= corner_count) return;
  corner = pairs[index].y;
  bits = corner_bits(plain, corner);
  while (low < high) {
    const uint middle = low + (high - low) / 2u;
    if (pairs[middle].x < pairs[index].x) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  first = pairs[low].y;
  while (low < index && !has_bits(plain, first, bits)) {
    low += 1u;
    first = pairs[low].y;
  }
  first_of[corner] = first;
  is_first[corner] = first == corner ? 1u : 0u;
}

// One work-item per corner: the triangle's index of it, and the vertex if it is the first there. ranks: how many
// corners before each are firsts.
__kernel void write_corners(__global const uint* plain, __global const uint* first_of, __global const uint* ranks,
                            __global uint* triangles, __global uint* vertices, uint corner_count) {
  const uint corner = (uint)get_global_id(0);
  const uint triangle = corner / 3u, place = corner % 3u;
  uint rank;
  if (corner >= corner_count) return;
  rank = ranks[first_of[corner]];
  triangles[4u * (size_t)triangle + place] = rank;
  if (place == 0u) triangles[4u * (size_t)triangle + 3u] = plain[10u * (size_t)triangle + 9u];
  if (first_of[corner] == corner) vstore3(corner_bits(plain, corner), rank, vertices);
}
