// Writing wide nodes and leaves (shared/wide_layout.h) from the root of a subtree of the binary tree down: what
// waits to be written, one node with its leaves, and where a subtree lies in memory. Not for what collapsing costs.
// Options: GN_COLLAPSE_DEPTH. Feeds collapse.cl.
#ifndef GNOMON_WIDE_EMIT_H
#define GNOMON_WIDE_EMIT_H

#include "ahead.h"
#include "shared/collapse_math.h"

// Each level of wide nodes leaves at most seven waiting.
#define GN_EMIT_STACK (7 * GN_COLLAPSE_DEPTH + 8)

typedef struct GnTree {
  __global const GnNode* nodes;
  __global const GnForest* forests;
  __global const GnLeafTriangle* triangles;
  __global GnWideNode* wide_nodes;
  __global uint* leaves;
  GnCollapseCosts costs;
  GnNodeValues weights;
  __global const float* keys;
} GnTree;

// Wide nodes not yet written, their numbers, and the next free numbers below them.
typedef struct GnEmission {
  uint roots[GN_EMIT_STACK];
  uint places[GN_EMIT_STACK];
  uint depths[GN_EMIT_STACK];
  uint height;
  uint next_node;
  uint next_place;
  uint deepest;
  uint largest_leaf;  // triangles
} GnEmission;

static inline void write_leaf(const GnTree* tree, uint node, uint triangles, uint place) {
  __global const GnLeafTriangle* from = tree->triangles + gn_first_triangle(tree->nodes, node);
  __global uint* out = tree->leaves + GN_TRIANGLE_WORDS * place;
  uint begin, i, k;
  if (triangles >= GN_LONG_LEAF) {
    out[0] = triangles;
    for (k = 1u; k < GN_TRIANGLE_WORDS; ++k) out[k] = 0u;
    out += GN_TRIANGLE_WORDS;
  }
  for (begin = 0u; begin < triangles; begin += GN_WIDTH) {
    const uint count = min(triangles - begin, GN_WIDTH);
    for (i = 0u; i < count; ++i) {
      __global const uint* row = (__global const uint*)(from + begin + i);
      const uint4 a = vload4(0, row), b = vload4(1, row), c = vload4(2, row);
      __global uint* at = out + GN_TRIANGLE_WORDS * begin + i;
      at[0] = a.x;
      at[count] = a.y;
      at[2u * count] = a.z;
      at[3u * count] = b.x;
      at[4u * count] = b.y;
      at[5u * count] = b.z;
      at[6u * count] = c.x;
      at[7u * count] = c.y;
      at[8u * count] = c.z;
      at[9u * count] = a.w + GN_NUMBER;  // behind the first corner stands the triangle's number
    }
  }
}

static inline void write_box(__global GnWideNode* out, uint slot, __global const GnNode* node) {
  __global float* planes = &out->planes[0][slot];
  const float4 lo = vload4(0, (__global const float*)node), hi = vload4(1, (__global const float*)node);
  planes[0] = lo.x;
  planes[GN_WIDTH] = hi.x;
  planes[2u * GN_WIDTH] = lo.y;
  planes[3u * GN_WIDTH] = hi.y;
  planes[4u * GN_WIDTH] = lo.z;
  planes[5u * GN_WIDTH] = hi.z;
}

static inline void write_empty_node(__global GnWideNode* out) {
  __global float* planes = &out->planes[0][0];
  uint k;
  for (k = 0u; k < 6u; k += 2u) {
    vstore8((float8)(INFINITY), k, planes);
    vstore8((float8)(-INFINITY), k + 1u, planes);
  }
  vstore8((uint8)(GN_NONE), 0, out->links);
}

// Numbers the wide node on top of the stack, whose children are `slots`, and writes it (write != 0). Puts the children that
// are nodes in its place, the first of them on top.
static inline void enter_node(const GnTree* tree, GnEmission* work, const GnSlots* slots, int write) {
  const uint top = work->height - 1u;
  const uint depth = work->depths[top] + 1u;
  __global GnWideNode* out = tree->wide_nodes + work->places[top];
  uint slot, inner = 0u, entered = 0u;
  for (slot = 0u; slot < slots->count; ++slot) inner += slots->triangles[slot] == 0u;
  if (write) write_empty_node(out);
  for (slot = 0u; slot < slots->count; ++slot) {
    const uint triangles = slots->triangles[slot];
    uint link;
    if (triangles == 0u) {
      const uint place = top + inner - 1u - entered;
      link = work->next_node + entered;
      work->roots[place] = slots->node[slot];
      work->places[place] = link;
      work->depths[place] = depth;
      entered += 1u;
    } else {
      link = gn_leaf_link(work->next_place, triangles);
      if (write) write_leaf(tree, slots->node[slot], triangles, work->next_place);
      work->next_place += gn_leaf_places(triangles);
      work->largest_leaf = max(work->largest_leaf, triangles);
    }
    if (write) {
      write_box(out, slot, tree->nodes + slots->node[slot]);
      out->links[slot] = link;
    }
  }
  work->next_node += inner;
  work->height = top + inner;
  work->deepest = max(work->deepest, depth);
}

static inline void open_top(const GnTree* tree, const GnEmission* work, GnSlots* slots) {
  gn_open_wide_node(tree->nodes, tree->forests, work->roots[work->height - 1u], tree->costs, &tree->weights, tree->keys,
                    slots);
}

static inline void store_opened(__global GnOpened* out, const GnSlots* slots) {
  uint slot;
  for (slot = 0u; slot < GN_WIDTH; ++slot) out->node[slot] = slot < slots->count ? slots->node[slot] : GN_NONE;
  for (slot = 0u; slot < GN_WIDTH; slot += 2u) {
    const uint even = slot < slots->count ? slots->triangles[slot] : 0u;
    const uint odd = slot + 1u < slots->count ? slots->triangles[slot + 1u] : 0u;
    out->triangles[slot / 2u] = even | odd << 16;
  }
}

static inline void load_opened(__global const GnOpened* from, GnSlots* slots) {
  uint slot;
  slots->count = 0u;
  for (slot = 0u; slot < GN_WIDTH; ++slot) {
    slots->node[slot] = from->node[slot];
    slots->triangles[slot] = from->triangles[slot / 2u] >> (slot % 2u * 16u) & 0xffffu;
    slots->count += slots->node[slot] != GN_NONE;
  }
}

static inline void start_emission(GnEmission* work, uint root, uint place, uint depth, uint next_node,
                                  uint next_place) {
  work->roots[0] = root;
  work->places[0] = place;
  work->depths[0] = depth;
  work->height = 1u;
  work->next_node = next_node;
  work->next_place = next_place;
  work->deepest = 0u;
  work->largest_leaf = 0u;
}

static inline uint triangles_below(const GnTree* tree, uint node) {
  return gn_forest_of(tree->nodes, tree->forests, node, &tree->weights, tree->costs.block).triangles;
}

// Ranks of a subtree's splits, which are neighbours: the first of them, and the last one's successor.
static inline uint2 ranks_of(const GnTree* tree, uint root) {
  uint left = root, right = root, first = 1u, last = 0u;
  while (tree->nodes[left].count == 0u) {
    first = tree->nodes[left].first;
    left = first;
  }
  while (tree->nodes[right].count == 0u) {
    last = tree->nodes[right].first;
    right = last + 1u;
  }
  return (uint2)((first - 1u) / 2u, (last + 1u) / 2u);
}

static inline void expect_triangles(const GnTree* tree, uint root) {
  uint last = root;
  const uint begin = gn_first_triangle(tree->nodes, root);
  while (tree->nodes[last].count == 0u) last = tree->nodes[last].first + 1u;
  expect_range(tree->triangles + begin,
               (tree->nodes[last].first + tree->nodes[last].count - begin) * sizeof(GnLeafTriangle));
}

#define GN_TREE_PARAMETERS                                                                                         \
  __global const GnNode *nodes, __global const GnForest *forests, __global const GnLeafTriangle *triangles,         \
      __global GnWideNode *wide_nodes, __global uint *leaves, float node_cost, float block_cost,                            \
      __global const float *node_weights, uint weights_given, __global const float *slot_keys
#define GN_TREE \
  {nodes, forests, triangles, wide_nodes, leaves, {node_cost, block_cost}, {node_weights, weights_given}, slot_keys}

#endif
