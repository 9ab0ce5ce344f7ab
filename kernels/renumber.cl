// The last step of optimising a tree: from slots (shared/reinsert_layout.h) to nodes as builders number them, leaf order
// and triangles left to right, each triangle once a leaf. One work-item a subtree.
#include "shared/reinsert_math.h"

typedef struct GnSource {
  __global const GnNode* slots;
  __global const GnBelow* below;
  __global const uint* order;
  __global const GnLeafTriangle* triangles;
} GnSource;

typedef struct GnTarget {
  __global GnNode* nodes;
  __global uint* order;
  __global GnLeafTriangle* triangles;
} GnTarget;

// Where a node goes: its number, how many splits and triangles are to the left of all that is below it.
typedef struct GnPlace {
  uint slot;
  uint number;
  uint splits;
  uint triangles;
} GnPlace;

static inline void copy_triangle(const GnSource* from, uint at, const GnTarget* to, uint place) {
  __global const uint* in = (__global const uint*)(from->triangles + at);
  __global uint* out = (__global uint*)(to->triangles + place);
  vstore4(vload4(0, in), 0, out);
  vstore4(vload4(1, in), 1, out);
  vstore4(vload4(2, in), 2, out);
  to->order[place] = from->order[at];
}

static inline void write_leaf(const GnSource* from, const GnTarget* to, const GnPlace* place) {
  const uint first = from->slots[place->slot].first, count = from->slots[place->slot].count;
  uint at = first, written = 0u, other;
  while (written < count) {
    uint seen = 0u;
    for (other = first; other < at; ++other) seen |= from->order[other] == from->order[at];
    if (!seen) {
      copy_triangle(from, at, to, place->triangles + written);
      written += 1u;
    }
    at += 1u;
  }
  to->nodes[place->number].first = place->triangles;
  to->nodes[place->number].count = count;
}

// Writes a node; of an inner one says where its children go and returns 1.
static inline uint write_place(const GnSource* from, const GnTarget* to, const GnPlace* place, GnPlace* left,
                               GnPlace* right) {
  __global const GnNode* slot = from->slots + place->slot;
  __global GnNode* node = to->nodes + place->number;
  uint k, inner = 0u, triangles;
  for (k = 0u; k < 3u; ++k) {
    node->lo[k] = slot->lo[k];
    node->hi[k] = slot->hi[k];
  }
  if (slot->count > 0u) {
    write_leaf(from, to, place);
    return 0u;
  }
  triangles = from->slots[slot->first].count;
  if (triangles == 0u) {
    const uint pair = from->slots[slot->first].first >> 1;
    inner = from->below[pair].inner;
    triangles = from->below[pair].triangles;
  }
  node->first = 1u + 2u * (place->splits + inner);
  node->count = 0u;
  left->slot = slot->first;
  left->number = node->first;
  left->splits = place->splits;
  left->triangles = place->triangles;
  right->slot = slot->first + 1u;
  right->number = node->first + 1u;
  right->splits = place->splits + inner + 1u;
  right->triangles = place->triangles + triangles;
  return 1u;
}

#define GN_RENUMBER_PARAMETERS                                                                                  \
  __global const GnNode *slots, __global const GnBelow *below, __global const uint *order,                      \
      __global const GnLeafTriangle *triangles, __global GnNode *nodes, __global uint *order_out,                \
      __global GnLeafTriangle *triangles_out
#define GN_RENUMBER_ENDS                                   \
  const GnSource from = {slots, below, order, triangles};  \
  const GnTarget to = {nodes, order_out, triangles_out};

// One work-item: the nodes above the subtrees, and leaves there. places: by slot, receives those of the subtrees' roots.
__kernel void write_top(GN_RENUMBER_PARAMETERS, __global const uint* top, __global GnPlace* places, uint top_count) {
  GN_RENUMBER_ENDS
  GnPlace place = {GN_ROOT_SLOT, 0u, 0u, 0u}, children[2];
  uint i, side;
  places[GN_ROOT_SLOT] = place;
  if (top_count == 0u) write_place(&from, &to, &place, children, children + 1);
  for (i = 0u; i < top_count; ++i) {
    place = places[top[i]];
    write_place(&from, &to, &place, children, children + 1);
    for (side = 0u; side < 2u; ++side) {
      if (slots[children[side].slot].count > 0u) {
        GnPlace none[2];
        write_place(&from, &to, children + side, none, none + 1);
      } else {
        places[children[side].slot] = children[side];
      }
    }
  }
}

// One work-item per subtree.
__kernel void write_subtrees(GN_RENUMBER_PARAMETERS, __global const uint* tasks, __global const GnPlace* places,
                             uint task_count) {
  const uint task = (uint)get_global_id(0);
  GN_RENUMBER_ENDS
  GnPlace waiting[GN_SEARCH_STACK];
  uint height = 1u;
  if (task >= task_count) return;
  waiting[0] = places[tasks[task]];
  while (height > 0u) {
    const GnPlace place = waiting[height - 1u];
    GnPlace left, right;
    height -= 1u;
    if (write_place(&from, &to, &place, &left, &right)) {
      waiting[height] = right;
      waiting[height + 1u] = left;
      height += 2u;
    }
  }
}
