// Where a node of a binary tree would stand better, and which of many such moves can be made at once. For both compilers.
// A move takes a node from its parent, which vanishes, and puts it beside another one, under a new parent: the sum of all
// inner nodes' measures falls by its gain. Source: Meister, Bittner 2018, "Parallel Reinsertion for Bounding Volume
// Hierarchy Optimization"; the rule for moves that would put two subtrees into one another is ours. Not for what the
// kernels and the reference do with moves: reinsert.cl, optimise.cpp.
#ifndef GNOMON_SHARED_REINSERT_MATH_H
#define GNOMON_SHARED_REINSERT_MATH_H

#include "box_costs.h"
#include "collapse_math.h"
#include "reinsert_layout.h"

// Axes are written out here and below: a loop over them has compilers keep the box in memory and read it back
// in other pieces than it was written in, for which the search waited as long as for all else.
GN_INLINE void gn_load_box(GN_GLOBAL const GnNode* node, GnBox* box) {
  box->lo[0] = node->lo[0];
  box->lo[1] = node->lo[1];
  box->lo[2] = node->lo[2];
  box->hi[0] = node->hi[0];
  box->hi[1] = node->hi[1];
  box->hi[2] = node->hi[2];
}

// Makes a box reach around a node.
GN_INLINE void gn_grow_box(GnBox* box, GN_GLOBAL const GnNode* node) {
  box->lo[0] = gn_min(box->lo[0], node->lo[0]);
  box->lo[1] = gn_min(box->lo[1], node->lo[1]);
  box->lo[2] = gn_min(box->lo[2], node->lo[2]);
  box->hi[0] = gn_max(box->hi[0], node->hi[0]);
  box->hi[1] = gn_max(box->hi[1], node->hi[1]);
  box->hi[2] = gn_max(box->hi[2], node->hi[2]);
}

GN_INLINE int gn_is_box_of(const GnBox* box, GN_GLOBAL const GnNode* node) {
  return (box->lo[0] == node->lo[0]) & (box->lo[1] == node->lo[1]) & (box->lo[2] == node->lo[2]) &
         (box->hi[0] == node->hi[0]) & (box->hi[1] == node->hi[1]) & (box->hi[2] == node->hi[2]);
}

GN_INLINE gn_f32 gn_slot_cost(const GnBoxCosts* costs, GN_GLOBAL const GnNode* node) {
  const gn_f32 faces =
      gn_linear_extents(costs->w, node->hi[0] - node->lo[0], node->hi[1] - node->lo[1], node->hi[2] - node->lo[2]);
#if GN_RAY_COSTS
  if (gn_has_ray_costs(costs)) {
    GnBox box;
    gn_load_box(node, &box);
    return faces + gn_ray_costs(costs, &box);
  }
#endif
  return faces;
}

// The cost of the box around a node and another box.
GN_INLINE gn_f32 gn_joint_cost(const GnBoxCosts* costs, const GnBox* box, GN_GLOBAL const GnNode* node) {
#if GN_RAY_COSTS
  if (gn_has_ray_costs(costs)) {
    GnBox joint = *box;
    gn_grow_box(&joint, node);
    return gn_box_cost(costs, &joint);
  }
#endif
  return gn_linear_extents(costs->w, gn_max(box->hi[0], node->hi[0]) - gn_min(box->lo[0], node->lo[0]),
                           gn_max(box->hi[1], node->hi[1]) - gn_min(box->lo[1], node->lo[1]),
                           gn_max(box->hi[2], node->hi[2]) - gn_min(box->lo[2], node->lo[2]));
}

GN_INLINE gn_u32 gn_cost_bin(gn_f32 cost) { return gn_bits_of(cost) >> GN_MEASURE_BIN_SHIFT; }

// Integer shares of the root's cost.
GN_INLINE gn_u32 gn_cost_units(gn_f32 cost, gn_f32 units) { return (gn_u32)(cost * units); }

// A pair of nodes whose parent may take the node in. saved: what all levels above these two save, less what their parent
// and its parents grow.
typedef struct GnSearch {
  gn_u32 pairs[GN_SEARCH_STACK];
  gn_f32 saved[GN_SEARCH_STACK];
  gn_u32 height;
  gn_u32 left;  // pairs this search may still look at
} GnSearch;

GN_INLINE void gn_push_pair(GnSearch* search, gn_u32 first, gn_f32 saved) {
  search->pairs[search->height] = first;
  search->saved[search->height] = saved;
  search->height += 1u;
}

// What is saved below `node` if the box passes through it, or not enough when it is a leaf.
GN_INLINE gn_f32 gn_saved_below(const GnBoxCosts* costs, GN_GLOBAL const GnNode* node, gn_f32 gain) {
  return node->count > 0u ? -GN_INFINITY : gain + gn_slot_cost(costs, node);
}

// The best place among the nodes waiting and all below them. Branches that cannot beat the best so far are left out: a
// parent made for the node costs no less than the node.
GN_INLINE void gn_search_below(GN_GLOBAL const GnNode* slots, const GnBoxCosts* costs, const GnBox* box, gn_f32 own,
                               gn_u32 pivot, GnSearch* search, GnMove* move) {
  while (search->height > 0u && search->left > 0u) {
    const gn_u32 top = search->height - 1u;
    const gn_u32 first = search->pairs[top];
    const gn_f32 saved = search->saved[top];
    search->height = top;
    if (saved - own > move->gain) {
      const gn_f32 left_gain = saved - gn_joint_cost(costs, box, slots + first);
      const gn_f32 right_gain = saved - gn_joint_cost(costs, box, slots + first + 1u);
      const gn_f32 left = gn_saved_below(costs, slots + first, left_gain);
      const gn_f32 right = gn_saved_below(costs, slots + first + 1u, right_gain);
      const int right_first = right > left;
      const gn_f32 best = gn_max(left_gain, right_gain);
      search->left -= 1u;
      if (best > move->gain) {
        move->gain = best;
        move->target = right_gain > left_gain ? first + 1u : first;
        move->pivot = pivot;
      }
      // The more promising one is looked at first.
      if (gn_min(left, right) - own > move->gain)
        gn_push_pair(search, slots[right_first ? first : first + 1u].first, gn_min(left, right));
      if (gn_max(left, right) - own > move->gain)
        gn_push_pair(search, slots[right_first ? first + 1u : first].first, gn_max(left, right));
    }
  }
}

// Searches the whole tree for the best place of a node, from its sibling up to the root. above: for each pair its parent's
// slot. Gains up to GN_LEAST_GAIN of the node's own cost do not count.
GN_INLINE GnMove gn_find_move(GN_GLOBAL const GnNode* slots, GN_GLOBAL const gn_u32* above, const GnBoxCosts* costs,
                              gn_u32 node) {
  GnSearch search;
  GnMove move;
  GnBox box, shrunk;
  gn_u32 pivot = above[node >> 1], beside = node ^ 1u;
  gn_f32 own, saved;
  int going = 1, first = 1, shrinks = 1;
  gn_load_box(slots + node, &box);
  gn_load_box(slots + beside, &shrunk);  // of what will be left of the pivot
  own = gn_box_cost(costs, &box);
  saved = gn_slot_cost(costs, slots + pivot);
  move.node = node;
  move.target = GN_NONE;
  move.pivot = 0u;
  move.gain = GN_LEAST_GAIN * own;
  move.made = 0u;
  move.parent = pivot;
  move.pad[0] = move.pad[1] = 0u;
  search.height = 0u;
  search.left = GN_SEARCH_PAIRS;
  while (going) {
    const gn_f32 gain = saved - gn_joint_cost(costs, &box, slots + beside);
    const gn_f32 below = gn_saved_below(costs, slots + beside, gain);
    if (!first && gain > move.gain) {
      move.gain = gain;
      move.target = beside;
      move.pivot = pivot;
    }
    if (below - own > move.gain) gn_push_pair(&search, slots[beside].first, below);
    gn_search_below(slots, costs, &box, own, pivot, &search, &move);
    // Where the pivot does not shrink, nothing above it does.
    if (shrinks && !first) {
      gn_grow_box(&shrunk, slots + beside);
      saved += gn_slot_cost(costs, slots + pivot) - gn_box_cost(costs, &shrunk);
    }
    if (shrinks) shrinks = !gn_is_box_of(&shrunk, slots + pivot);
    if (pivot == GN_ROOT_SLOT || search.left == 0u || (!shrinks && saved - own <= move.gain)) going = 0;
    beside = pivot ^ 1u;
    pivot = above[pivot >> 1];
    first = 0;
  }
  return move;
}

// The pair around which a node was left where it is: changes outside of what is below its grandparent do not have it
// searched for again.
GN_INLINE gn_u32 gn_pair_near(GN_GLOBAL const gn_u32* above, gn_u32 node) {
  const gn_u32 parent = above[node >> 1];
  return parent == GN_ROOT_SLOT ? node >> 1 : parent >> 1;
}

// The slots a move changes or relies on: the node's own, its parent's, its sibling's, the target's.
GN_INLINE gn_u32 gn_claimed_slot(const GnMove* move, gn_u32 i) {
  return i == 0u ? move->node : i == 1u ? move->node ^ 1u : i == 2u ? move->parent : move->target;
}

// Whether another move's subtree, into which this one would go, may not move as well: of moves that would put subtrees
// into each other in a ring the one of least gain gives way, so that no ring closes. Equal gains: the lower slot.
GN_INLINE int gn_gives_way(const GnMove* move, gn_u32 other_node, gn_f32 other_gain) {
  if (other_gain > move->gain) return 1;
  return other_gain == move->gain && other_node > move->node;
}

#endif
