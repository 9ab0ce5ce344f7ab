// Collapsing a binary tree into a wide one with the least expected cost, by dynamic programming over the number of
// wide children that a subtree may be given (Ylitie, Karras, Laine 2017, section 3). For both compilers. Not for the
// order in which subtrees are worked on: collapse.cl and wide.cpp.
#ifndef GNOMON_SHARED_COLLAPSE_MATH_H
#define GNOMON_SHARED_COLLAPSE_MATH_H

#include "build_layout.h"
#include "shown_area.h"
#include "wide_layout.h"

// Cost of one node step and of testing one block, in any unit.
typedef struct GnCollapseCosts {
  gn_f32 node;
  gn_f32 block;
} GnCollapseCosts;

GN_INLINE gn_f32 gn_half_area(GN_GLOBAL const GnNode* node) {
  const gn_f32 dx = node->hi[0] - node->lo[0];
  const gn_f32 dy = node->hi[1] - node->lo[1];
  const gn_f32 dz = node->hi[2] - node->lo[2];
  return dx * (dy + dz) + dy * dz;
}

// Where a node's slot is to be: any hit looks at those of greater keys first. A ray that meets the box is stopped the more
// likely the more of its area triangles show, shown / (area + shown), and large boxes stop more rays: the key is this
// share's logarithm and a quarter of the area's. As bits of floats, which rise as their logarithms do: a quotient's last
// bit is not every device's (Ogaki, Derouet-Jourdan 2016 go by the shown area; host/notes/wide-flavour.md).
GN_INLINE gn_f32 gn_slot_key(gn_f32 area, gn_f32 shown) {
  const gn_i32 share = (gn_i32)gn_bits_of(shown) - (gn_i32)gn_bits_of(area + shown);
  return (gn_f32)(share + (gn_i32)(gn_bits_of(area) >> 2));
}

// What a caller says of each node of the binary tree instead of its area: how likely rays meet its box.
typedef struct GnNodeValues {
  GN_GLOBAL const gn_f32* of_nodes;
  gn_u32 given;  // 0: areas
} GnNodeValues;

GN_INLINE gn_f32 gn_node_value(GN_GLOBAL const GnNode* nodes, gn_u32 node, const GnNodeValues* values) {
  return values->given != 0u ? values->of_nodes[node] : gn_half_area(nodes + node);
}

// area: or the node's weight.
GN_INLINE gn_f32 gn_wide_leaf_cost(gn_f32 area, gn_u32 triangles, gn_f32 block_cost) {
  return area * (block_cost * (gn_f32)gn_blocks_of(triangles));
}

// A leaf of the binary tree is a leaf whatever it may be replaced by.
GN_INLINE GnForest gn_leaf_forest(gn_f32 area, gn_u32 triangles, gn_f32 block_cost) {
  GnForest forest;
  int i;
  const gn_f32 cost = gn_wide_leaf_cost(area, triangles, block_cost);
  for (i = 0; i < 7; ++i) forest.cost[i] = cost;
  forest.triangles = triangles;
  return forest;
}

// How many of `budget` subtrees (2..8) the left child is best given; of equally good shares the least.
GN_INLINE gn_u32 gn_left_share(const GnForest* left, const GnForest* right, gn_u32 budget, gn_f32* cost) {
  gn_u32 share, best = 1u;
  *cost = left->cost[0] + right->cost[budget - 2u];
  for (share = 2u; share < budget; ++share) {
    const gn_f32 sum = left->cost[share - 1u] + right->cost[budget - share - 1u];
    if (sum < *cost) {
      *cost = sum;
      best = share;
    }
  }
  return best;
}

GN_INLINE GnForest gn_inner_forest(gn_f32 area, const GnForest* left, const GnForest* right, GnCollapseCosts costs) {
  GnForest forest;
  gn_f32 cost;
  gn_u32 i;
  forest.triangles = left->triangles + right->triangles;
  gn_left_share(left, right, 8u, &cost);
  forest.cost[0] = cost + area * costs.node;
  if (forest.triangles <= GN_WIDTH)
    forest.cost[0] = gn_min(forest.cost[0], gn_wide_leaf_cost(area, forest.triangles, costs.block));
  for (i = 2u; i < 8u; ++i) {
    gn_left_share(left, right, i, &cost);
    forest.cost[i - 1u] = gn_min(cost, forest.cost[i - 2u]);
  }
  return forest;
}

// The forest of any node: inner ones' were worked out before, at the rank of their split.
GN_INLINE GnForest gn_forest_of(GN_GLOBAL const GnNode* nodes, GN_GLOBAL const GnForest* forests, gn_u32 node,
                                const GnNodeValues* weights, gn_f32 block_cost) {
  if (nodes[node].count > 0u)
    return gn_leaf_forest(gn_node_value(nodes, node, weights), nodes[node].count, block_cost);
  return forests[(nodes[node].first - 1u) / 2u];
}

// A wide node's children: nodes of the binary tree, which become wide nodes (triangles == 0) or leaves.
typedef struct GnSlots {
  gn_u32 node[8];
  gn_u32 triangles[8];
  gn_f32 key[8];
  gn_u32 count;
} GnSlots;

// Enters a child behind all whose key is no larger.
GN_INLINE void gn_enter_slot(GnSlots* slots, gn_u32 node, gn_u32 triangles, gn_f32 key) {
  gn_u32 place = slots->count;
  while (place > 0u && slots->key[place - 1u] > key) {
    slots->node[place] = slots->node[place - 1u];
    slots->triangles[place] = slots->triangles[place - 1u];
    slots->key[place] = slots->key[place - 1u];
    place -= 1u;
  }
  slots->node[place] = node;
  slots->triangles[place] = triangles;
  slots->key[place] = key;
  slots->count += 1u;
}

// Triangles of an inner node that becomes a leaf, 0 for one that becomes a wide node.
GN_INLINE gn_u32 gn_leaf_triangles(gn_f32 area, const GnForest* forest, gn_f32 block_cost) {
  if (forest->triangles > GN_WIDTH) return 0u;
  return forest->cost[0] == gn_wide_leaf_cost(area, forest->triangles, block_cost) ? forest->triangles : 0u;
}

// The children of the wide node that replaces `root`: at most eight, in order of their keys. A root that is a leaf
// is its own only child.
GN_INLINE void gn_open_wide_node(GN_GLOBAL const GnNode* nodes, GN_GLOBAL const GnForest* forests, gn_u32 root,
                                 GnCollapseCosts costs, const GnNodeValues* weights, GN_GLOBAL const gn_f32* keys,
                                 GnSlots* slots) {
  gn_u32 waiting[8], budgets[8], height = 1u;
  waiting[0] = root;
  budgets[0] = nodes[root].count > 0u ? 1u : 8u;
  slots->count = 0u;
  while (height > 0u) {
    const gn_u32 node = waiting[height - 1u];
    GnForest forest, left, right;
    gn_u32 budget = budgets[height - 1u], share, first;
    gn_f32 cost;
    height -= 1u;
    if (nodes[node].count > 0u) {
      gn_enter_slot(slots, node, nodes[node].count, keys[node]);
      continue;
    }
    if (budget < 8u) {
      forest = gn_forest_of(nodes, forests, node, weights, costs.block);
      while (budget > 1u && forest.cost[budget - 1u] == forest.cost[budget - 2u]) budget -= 1u;
      if (budget == 1u) {
        const gn_f32 weight = gn_node_value(nodes, node, weights);
        gn_enter_slot(slots, node, gn_leaf_triangles(weight, &forest, costs.block), keys[node]);
        continue;
      }
    }
    first = nodes[node].first;
    left = gn_forest_of(nodes, forests, first, weights, costs.block);
    right = gn_forest_of(nodes, forests, first + 1u, weights, costs.block);
    share = gn_left_share(&left, &right, budget, &cost);
    waiting[height] = first + 1u;
    budgets[height] = budget - share;
    waiting[height + 1u] = first;
    budgets[height + 1u] = share;
    height += 2u;
  }
}

// Where a subtree's triangles begin in leaf order.
GN_INLINE gn_u32 gn_first_triangle(GN_GLOBAL const GnNode* nodes, gn_u32 node) {
  while (nodes[node].count == 0u) node = nodes[node].first;
  return nodes[node].first;
}

#endif
