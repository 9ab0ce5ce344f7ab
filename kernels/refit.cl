// New boxes for a tree whose triangles have moved: same nodes, same leaves, corners and boxes anew. The binary tree is
// worked on in subtrees (collapse.cl's cut_binary), the wide one level by level from the deepest up. Boxes are those that a
// builder would have given the same nodes. Not for changing a tree's shape. Options: GN_COLLAPSE_DEPTH as collapse.cl.
#include "children_first.h"
#include "shared/collapse_math.h"
#include "triangle_box.h"

#ifndef GN_COLLAPSE_DEPTH
#define GN_COLLAPSE_DEPTH 96
#endif

// One work-item per triangle. first_bad receives the lowest index of one with a coordinate that is not finite or out of
// range.
__kernel void check_triangles(__global const float* triangles, volatile __global uint* first_bad, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  {
    __global const float* corners = triangles + 9u * (size_t)i;
    if (!is_traceable(vload3(0, corners)) || !is_traceable(vload3(1, corners)) || !is_traceable(vload3(2, corners)))
      atomic_min(first_bad, i);
  }
}

static inline void set_node_box(__global GnNode* node, GnBoxPair box) {
  node->lo[0] = box.lo.x;
  node->lo[1] = box.lo.y;
  node->lo[2] = box.lo.z;
  node->hi[0] = box.hi.x;
  node->hi[1] = box.hi.y;
  node->hi[2] = box.hi.z;
}

static inline void refit_leaf(__global GnNode* node, __global const GnLeafTriangle* triangles) {
  GnBoxPair box = empty_pair();
  const uint first = node->first, count = node->count;
  uint i;
  for (i = first; i < first + count; ++i) {
    __global const float* corners = (__global const float*)(triangles + i);
    const GnBoxPair one =
        box_of_corners(vload4(0, corners).xyz, vload4(1, corners).xyz, vload4(2, corners).xyz);
    box.lo = GN_VMIN(one.lo, box.lo);
    box.hi = GN_VMAX(one.hi, box.hi);
  }
  set_node_box(node, box);
}

// A node's box from its children's, which are leaves not yet seen or inner nodes that are done.
static inline void refit_inner(__global GnNode* nodes, uint node, __global const GnLeafTriangle* triangles) {
  const uint first = nodes[node].first;
  uint side, k;
  for (side = 0u; side < 2u; ++side) {
    if (nodes[first + side].count > 0u) refit_leaf(nodes + first + side, triangles);
  }
  for (k = 0u; k < 3u; ++k) {
    nodes[node].lo[k] = gn_min(nodes[first].lo[k], nodes[first + 1u].lo[k]);
    nodes[node].hi[k] = gn_max(nodes[first].hi[k], nodes[first + 1u].hi[k]);
  }
}

// The inner nodes of one subtree per work-item and their leaves, children before parents.
__kernel void refit_subtrees(__global GnNode* nodes, __global const GnLeafTriangle* triangles,
                             __global const uint* tasks, uint task_count) {
  const uint task = (uint)get_global_id(0);
  if (task >= task_count || GN_IDLE_LANE) return;
  GN_CHILDREN_FIRST(nodes, tasks[task], refit_inner(nodes, node, triangles))
}

// One work-item: the nodes above the subtrees, from the last found to the root, which may be a leaf.
__kernel void refit_top(__global GnNode* nodes, __global const GnLeafTriangle* triangles, __global const uint* top,
                        uint top_count) {
  uint i;
  if (nodes[0].count > 0u) refit_leaf(nodes, triangles);
  for (i = top_count; i > 0u; --i) refit_inner(nodes, top[i - 1u], triangles);
}

// One work-item per wide node: the corners of its leaves' triangles.
__kernel void refit_leaves(__global const float* triangles, __global const GnWideNode* nodes, __global uint* leaves,
                           uint count) {
  const uint node = (uint)get_global_id(0);
  uint slot, i, k;
  if (node >= count) return;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const uint link = nodes[node].links[slot];
    if (link == GN_NONE || (link & GN_LEAF_LINK) == 0u) continue;
    {
      const GnLeaf leaf = gn_leaf_at(leaves, link);
      for (i = 0u; i < leaf.count; ++i) {
        const uint seat = gn_seat_in(leaf, i);
        __global float* corners = (__global float*)leaves + gn_seat_word(seat);
        const size_t from = 9u * (size_t)gn_number_at(leaves, seat);
        for (k = 0u; k < 9u; ++k) corners[k * gn_seat_stride(seat)] = triangles[from + k];
      }
    }
  }
}

static inline int is_wide_node(uint link) { return link != GN_NONE && (link & GN_LEAF_LINK) == 0u; }

// One work-item per wide node: enters it as its children's parent.
__kernel void find_parents(__global const GnWideNode* nodes, __global uint* parents, uint count) {
  const uint node = (uint)get_global_id(0);
  uint slot;
  if (node >= count) return;
  if (node == 0u) parents[0] = GN_NONE;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    if (is_wide_node(nodes[node].links[slot])) parents[nodes[node].links[slot]] = node;
  }
}

// One work-item per wide node: how many are above it.
__kernel void find_levels(__global const uint* parents, __global uint* levels, uint count) {
  const uint node = (uint)get_global_id(0);
  uint level = 0u, above;
  if (node >= count) return;
  above = parents[node];
  while (above != GN_NONE) {
    level += 1u;
    above = parents[above];
  }
  levels[node] = level;
}

typedef struct GnSlotBox {
  float lo[3];
  float hi[3];
} GnSlotBox;

static inline GnSlotBox empty_slot_box(void) {
  GnSlotBox box;
  gn_empty_box(box.lo, box.hi);
  return box;
}

static inline GnSlotBox box_of_leaf(__global const uint* leaves, uint link) {
  const GnLeaf leaf = gn_leaf_at(leaves, link);
  GnSlotBox box = empty_slot_box();
  uint i, k, corner;
  for (i = 0u; i < leaf.count; ++i) {
    const uint seat = gn_seat_in(leaf, i);
    __global const float* corners = (__global const float*)leaves + gn_seat_word(seat);
    for (corner = 0u; corner < 3u; ++corner) {
      for (k = 0u; k < 3u; ++k) {
        const float x = gn_without_negative_zero(corners[(3u * corner + k) * gn_seat_stride(seat)]);
        box.lo[k] = gn_min(x, box.lo[k]);
        box.hi[k] = gn_max(x, box.hi[k]);
      }
    }
  }
  return box;
}

static inline GnSlotBox box_of_slots(__global const GnWideNode* node) {
  GnSlotBox box = empty_slot_box();
  uint slot, k;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {  // empty slots are inverted and change nothing
    for (k = 0u; k < 3u; ++k) {
      box.lo[k] = gn_min(node->planes[2u * k][slot], box.lo[k]);
      box.hi[k] = gn_max(node->planes[2u * k + 1u][slot], box.hi[k]);
    }
  }
  return box;
}

// One work-item per wide node; those of one level work, all below it are done. Slots stay where they are: their order
// changes no answer, and whoever chose it knew more than the corners tell.
__kernel void refit_level(__global GnWideNode* nodes, __global const uint* leaves,
                          __global const uint* levels, uint level, uint count) {
  const uint node = (uint)get_global_id(0);
  uint slot, k;
  if (node >= count || levels[node] != level) return;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    const uint link = nodes[node].links[slot];
    GnSlotBox box;
    if (link == GN_NONE) continue;
    if (link & GN_LEAF_LINK) {
      box = box_of_leaf(leaves, link);
    } else {
      box = box_of_slots(nodes + link);
    }
    for (k = 0u; k < 3u; ++k) {
      nodes[node].planes[2u * k][slot] = box.lo[k];
      nodes[node].planes[2u * k + 1u][slot] = box.hi[k];
    }
  }
}
