// From the wide tree to the compact one (shared/compact_layout.h): nodes one by one, children in the order of their
// parent's slots, then triangles side by side, then each node's triangles packed. The bytes do not depend on how the work
// was cut.
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
// where that goes. spans: of each compact node, its first triangle and how many there are; first_of: of each triangle, the
// first of its node, or GN_NONE if corners are not to be shared there. counts_before: how many places before each hold no
// triangle.
__kernel void write_nodes(__global const GnWideNode* wide_nodes, __global const uint* leaves, __global const uint* places,
                          __global const uint* counts_before, __global GnCompactNode* nodes, __global uint2* spans,
                          __global uint2* moves, __global uint* first_of, uint node_count) {
  const uint index = (uint)get_global_id(0);
  __global const GnWideNode* node = wide_nodes + index;
  uint child_of[GN_WIDTH], slot, place, first, next, count;
  GnCompactNode out;
  if (index >= node_count) return;
  gn_assign_slots(node, child_of);
  gn_fill_compact_node(node, leaves, child_of, &out);
  place = gn_first_place(node);
  first = place == GN_NONE ? 0u : place - counts_before[place];
  count = gn_leaf_triangles(out.counts);
  next = first;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const uint link = child_of[slot] == GN_NONE ? GN_NONE : node->links[child_of[slot]];
    uint i;
    if (link == GN_NONE || !gn_is_leaf_link(link)) continue;
    {
      const GnLeaf leaf = gn_leaf_at(leaves, link);
      for (i = 0u; i < leaf.count; ++i) {
        moves[leaf.first + i] = (uint2)(gn_seat_in(leaf, i), next + i);
        first_of[next + i] = count > GN_MOST_SHARING ? GN_NONE : first;
      }
      next += leaf.count;
    }
  }
  nodes[places[index]] = out;
  spans[places[index]] = (uint2)(first, count);
}

// One work-item per place: the triangle there goes to its node's.
__kernel void gather_plain(__global const uint* leaves, __global const uint2* moves, __global const uint* counts_before,
                           __global GnPlainTriangle* triangles, uint place_count) {
  const uint place = (uint)get_global_id(0);
  GnPlainTriangle out;
  uint2 move;
  __global const uint* corners;
  uint k;
  if (place >= place_count || counts_before[place + 1u] != counts_before[place]) return;
  move = moves[place];
  corners = leaves + gn_seat_word(move.x);
  for (k = 0u; k < 9u; ++k) out.corners[k] = corners[k * gn_seat_stride(move.x)];
  out.number = gn_number_at(leaves, move.x);
  triangles[move.y] = out;
}

// One work-item per corner: the first in its node that equals it, counted from the node's first; nothing where corners
// are not to be shared.
__kernel void find_equal_corners(__global const GnPlainTriangle* triangles, __global const uint* first_of,
                                 __global uint* places, uint corner_count) {
  const uint corner = (uint)get_global_id(0);
  uint first;
  if (corner >= corner_count) return;
  first = first_of[corner / 3u];
  if (first != GN_NONE) places[corner] = gn_first_equal(triangles + first, corner - 3u * first);
}

// One work-item per compact node: its head, and the words that it takes. places: see gn_measure_leaves.
__kernel void measure_leaves(__global const GnPlainTriangle* triangles, __global const uint2* spans,
                             __global uint* places, __global GnPackHead* heads, __global uint* words, uint node_count) {
  const uint index = (uint)get_global_id(0);
  if (index >= node_count) return;
  {
    const uint2 span = spans[index];
    words[index] = span.y == 0u ? 0u
                                : gn_measure_leaves(triangles + span.x, places + 3u * (size_t)span.x, span.y,
                                                    heads + index);
  }
}

// One work-item per compact node: packs its triangles where the sum of all words before says. The first also writes the
// word behind them all: readers take two at a time.
__kernel void write_leaves(__global const GnPlainTriangle* triangles, __global const uint2* spans,
                           __global const uint* places, __global const GnPackHead* heads,
                           __global const uint* words_before, __global GnCompactNode* nodes, __global uint* leaves,
                           uint node_count) {
  const uint index = (uint)get_global_id(0);
  if (index >= node_count) return;
  {
    const uint2 span = spans[index];
    if (index == 0u) leaves[words_before[node_count]] = 0u;
    if (span.y == 0u) return;
    nodes[index].leaves = words_before[index];
    gn_write_leaves(triangles + span.x, places + 3u * (size_t)span.x, span.y, heads + index,
                    leaves + words_before[index]);
  }
}
