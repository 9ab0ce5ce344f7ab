// From the binary tree to the wide one (shared/wide_layout.h): cuts the tree into subtrees, works out from the leaves up
// what collapsing them costs, then writes wide nodes and triangle blocks from the root down. A wide node's children
// that are nodes lie side by side, what is below them follows child by child: numbers depend on the tree alone, not
// on the cuts. One work-item a subtree throughout. weights: one a node of the binary tree, where they are given.
// slot_keys: one a node; the caller's, or worked out as costs are (write_keys != 0).
// Options: GN_COLLAPSE_DEPTH, above the binary tree's depth.
#include "ahead.h"
#include "children_first.h"
#include "shared/collapse_math.h"

#ifndef GN_COLLAPSE_DEPTH
#define GN_COLLAPSE_DEPTH 96
#endif
// Each level of wide nodes leaves at most seven waiting.
#define GN_EMIT_STACK (7 * GN_COLLAPSE_DEPTH + 8)

// One work-item. Cuts the binary tree into subtrees of at most `limit` inner nodes: their roots go to tasks, the inner
// nodes above them to top, parents first. numbers: how many of each. An inner node's subtree has the splits of a
// range of ranks, which tells its size.
__kernel void cut_binary(__global const GnNode* nodes, uint inner_count, uint limit, __global uint* tasks,
                         __global uint* top, __global uint* numbers) {
  uint node[GN_COLLAPSE_DEPTH], begin[GN_COLLAPSE_DEPTH], end[GN_COLLAPSE_DEPTH];
  uint height = 0u, task_count = 0u, top_count = 0u;
  if (inner_count > 0u) {
    node[0] = 0u;
    begin[0] = 0u;
    end[0] = inner_count;
    height = 1u;
  }
  while (height > 0u) {
    const uint current = node[height - 1u], from = begin[height - 1u], to = end[height - 1u];
    height -= 1u;
    if (to - from <= limit) {
      tasks[task_count] = current;
      task_count += 1u;
    } else {
      const uint first = nodes[current].first, rank = (first - 1u) / 2u;
      top[top_count] = current;
      top_count += 1u;
      if (to > rank + 1u) {
        node[height] = first + 1u;
        begin[height] = rank + 1u;
        end[height] = to;
        height += 1u;
      }
      if (rank > from) {
        node[height] = first;
        begin[height] = from;
        end[height] = rank;
        height += 1u;
      }
    }
  }
  numbers[0] = task_count;
  numbers[1] = top_count;
}

#define GN_LEAST8(a, b) ((a) < (b) ? (a) : (b))

// gn_forest_of's costs as a vector, the last lane anything; its triangles are added to *triangles.
static inline float8 forest_vector(__global const GnNode* nodes, __global const GnForest* forests, uint node,
                                   const GnNodeValues* weights, float block_cost, uint* triangles) {
  const uint count = nodes[node].count;
  if (count > 0u) {
    *triangles += count;
    return (float8)(gn_wide_leaf_cost(gn_node_value(nodes, node, weights), count, block_cost));
  }
  *triangles += forests[(nodes[node].first - 1u) / 2u].triangles;
  return vload8((nodes[node].first - 1u) / 2u, (__global const float*)forests);
}

// gn_shown_area, with vectors.
static inline float shown_by_leaf(__global const GnLeafTriangle* triangles, uint first, uint count) {
  float shown = 0.0f;
  uint i;
  for (i = first; i < first + count; ++i) {
    __global const float* corners = (__global const float*)(triangles + i);
    // Behind the first corner stands the triangle's number: as a float it is denormal, which is slow.
    const float4 v0 = as_float4(vload4(0, (__global const uint*)corners) & (uint4)(~0u, ~0u, ~0u, 0u));
    const float4 a = vload4(1, corners) - v0, b = vload4(2, corners) - v0;
    const float4 normal = fabs(a.yzxw * b.zxyw - a.zxyw * b.yzxw);
    shown += 0.5f * (normal.x + normal.y + normal.z);
  }
  return shown;
}

// Keys of a node's children, whose places hold what shows below them if they are inner nodes; the node's place then does.
static inline void write_keys_below(__global const GnNode* nodes, __global const GnLeafTriangle* triangles,
                                    __global float* keys, uint node) {
  const uint first = nodes[node].first;
  float sum = 0.0f;
  uint child;
  for (child = first; child < first + 2u; ++child) {
    const uint count = nodes[child].count;
    const float shown = count > 0u ? shown_by_leaf(triangles, nodes[child].first, count) : keys[child];
    keys[child] = gn_slot_key(gn_half_area(nodes + child), shown);
    sum += shown;
  }
  keys[node] = sum;
}

// gn_inner_forest on vectors: the same sums and minima, those of all budgets at once. Compilers leave its loops loops.
static inline void join_children(__global const GnNode* nodes, __global GnForest* forests, uint node,
                                 const GnNodeValues* weights, GnCollapseCosts costs) {
  const uint first = nodes[node].first;
  uint triangles = 0u;
  const float8 l = forest_vector(nodes, forests, first, weights, costs.block, &triangles);
  const float8 r = forest_vector(nodes, forests, first + 1u, weights, costs.block, &triangles);
  const float none = INFINITY;
  const float area = gn_node_value(nodes, node, weights);
  float8 out;
  // Lane i: the least of all divisions of i + 2 children, of which the left one gets 1, 2, ...
  float8 least = l.s0 + r;
  least = GN_LEAST8(least, l.s1 + (float8)(none, r.s0, r.s1, r.s2, r.s3, r.s4, r.s5, none));
  least = GN_LEAST8(least, l.s2 + (float8)(none, none, r.s0, r.s1, r.s2, r.s3, r.s4, none));
  least = GN_LEAST8(least, l.s3 + (float8)(none, none, none, r.s0, r.s1, r.s2, r.s3, none));
  least = GN_LEAST8(least, l.s4 + (float8)(none, none, none, none, r.s0, r.s1, r.s2, none));
  least = GN_LEAST8(least, l.s5 + (float8)(none, none, none, none, none, r.s0, r.s1, none));
  least = GN_LEAST8(least, l.s6 + (float8)(none, none, none, none, none, none, r.s0, none));
  out.s0 = least.s6 + area * costs.node;
  if (triangles <= GN_WIDTH) out.s0 = gn_min(out.s0, gn_wide_leaf_cost(area, triangles, costs.block));
  out.s1 = gn_min(least.s0, out.s0);
  out.s2 = gn_min(least.s1, out.s1);
  out.s3 = gn_min(least.s2, out.s2);
  out.s4 = gn_min(least.s3, out.s3);
  out.s5 = gn_min(least.s4, out.s4);
  out.s6 = gn_min(least.s5, out.s5);
  out.s7 = 0.0f;
  vstore8(out, (first - 1u) / 2u, (__global float*)forests);
  forests[(first - 1u) / 2u].triangles = triangles;
}

// Forests of the inner nodes of one subtree per work-item, children before parents.
__kernel void weigh_subtrees(__global const GnNode* nodes, __global GnForest* forests, __global const uint* tasks,
                             uint task_count, float node_cost, float block_cost, __global const float* node_weights,
                             uint weights_given, __global const GnLeafTriangle* triangles, __global float* slot_keys,
                             uint write_keys) {
  const GnNodeValues weights = {node_weights, weights_given};
  const uint task = (uint)get_global_id(0);
  const GnCollapseCosts costs = {node_cost, block_cost};
  if (task >= task_count || GN_IDLE_LANE) return;
  GN_CHILDREN_FIRST(nodes, tasks[task], {
    join_children(nodes, forests, node, &weights, costs);
    if (write_keys != 0u) write_keys_below(nodes, triangles, slot_keys, node);
  })
}

// One work-item: forests of the nodes above the subtrees, from the last found to the root.
__kernel void weigh_top(__global const GnNode* nodes, __global GnForest* forests, __global const uint* top,
                        uint top_count, float node_cost, float block_cost, __global const float* node_weights,
                        uint weights_given, __global const GnLeafTriangle* triangles, __global float* slot_keys,
                        uint write_keys) {
  const GnNodeValues weights = {node_weights, weights_given};
  const GnCollapseCosts costs = {node_cost, block_cost};
  uint i;
  for (i = top_count; i > 0u; --i) {
    join_children(nodes, forests, top[i - 1u], &weights, costs);
    if (write_keys != 0u) write_keys_below(nodes, triangles, slot_keys, top[i - 1u]);
  }
}

typedef struct GnTree {
  __global const GnNode* nodes;
  __global const GnForest* forests;
  __global const GnLeafTriangle* triangles;
  __global GnWideNode* wide_nodes;
  __global GnTriangleBlock* blocks;
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
  uint next_block;
  uint deepest;
  uint largest_leaf;  // triangles
} GnEmission;

// Four triangles' corners side by side, as bits: rows are one triangle's corner each.
static inline void store_columns(__global uint* out, uint plane, uint4 r0, uint4 r1, uint4 r2, uint4 r3) {
  vstore4((uint4)(r0.x, r1.x, r2.x, r3.x), 0, out + GN_WIDTH * plane);
  vstore4((uint4)(r0.y, r1.y, r2.y, r3.y), 0, out + GN_WIDTH * (plane + 1u));
  vstore4((uint4)(r0.z, r1.z, r2.z, r3.z), 0, out + GN_WIDTH * (plane + 2u));
}

// A corner with what stands behind it; zeros for a triangle past the end.
static inline uint4 corner_or_none(__global const GnLeafTriangle* triangles, uint i, uint count, uint corner) {
  const uint4 row = vload4(corner, (__global const uint*)(triangles + min(i, count - 1u)));
  return i < count ? row : (uint4)(0u, 0u, 0u, GN_NONE);
}

static inline void write_leaf(const GnTree* tree, uint node, uint triangles, uint block) {
  __global const GnLeafTriangle* from = tree->triangles + gn_first_triangle(tree->nodes, node);
  uint i, corner;
  for (i = 0u; i < gn_blocks_of(triangles) * GN_WIDTH; i += 4u) {
    __global GnTriangleBlock* out = tree->blocks + block + i / GN_WIDTH;
    __global uint* lanes = (__global uint*)out + i % GN_WIDTH;
    for (corner = 0u; corner < 3u; ++corner) {
      const uint4 r0 = corner_or_none(from, i, triangles, corner), r1 = corner_or_none(from, i + 1u, triangles, corner);
      const uint4 r2 = corner_or_none(from, i + 2u, triangles, corner),
                  r3 = corner_or_none(from, i + 3u, triangles, corner);
      store_columns(lanes, 3u * corner, r0, r1, r2, r3);
      if (corner == 0u)  // behind the first stands the triangle's number
        vstore4((uint4)(r0.w, r1.w, r2.w, r3.w), 0, out->primitives + i % GN_WIDTH);
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
  vstore8((uint8)(0u), 0, out->pad);
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
      link = gn_leaf_link(work->next_block, triangles);
      if (write) write_leaf(tree, slots->node[slot], triangles, work->next_block);
      work->next_block += gn_blocks_of(triangles);
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
                                  uint next_block) {
  work->roots[0] = root;
  work->places[0] = place;
  work->depths[0] = depth;
  work->height = 1u;
  work->next_node = next_node;
  work->next_block = next_block;
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
      __global GnWideNode *wide_nodes, __global GnTriangleBlock *blocks, float node_cost, float block_cost,                   \
      __global const float *node_weights, uint weights_given, __global const float *slot_keys
#define GN_TREE \
  {nodes, forests, triangles, wide_nodes, blocks, {node_cost, block_cost}, {node_weights, weights_given}, slot_keys}

// One work-item, twice. Goes through the wide nodes above subtrees of at most `limit` triangles. First (write == 0) it
// lists those subtrees; then, knowing what each holds, it writes the nodes above and tells each where to write.
// numbers: subtrees, wide nodes and blocks above them (when writing: all), largest leaf above, depth of the nodes above.
__kernel void emit_top(GN_TREE_PARAMETERS, __global GnCollapseTask* tasks, uint limit, __global uint* numbers, int write) {
  const GnTree tree = GN_TREE;
  GnEmission work;
  uint task_count = 0u;
  start_emission(&work, 0u, 0u, 0u, 1u, 0u);
  while (work.height > 0u) {
    const uint top = work.height - 1u;
    if (triangles_below(&tree, work.roots[top]) <= limit) {
      __global GnCollapseTask* task = tasks + task_count;
      if (write) {
        const uint nodes_below = task->nodes_below, blocks_below = task->blocks_below;
        task->node = work.places[top];
        task->nodes_below = work.next_node;
        task->blocks_below = work.next_block;
        work.next_node += nodes_below;
        work.next_block += blocks_below;
      } else {
        task->root = work.roots[top];
        task->depth = work.depths[top];
      }
      task_count += 1u;
      work.height = top;
    } else {
      GnSlots slots;
      open_top(&tree, &work, &slots);
      enter_node(&tree, &work, &slots, write);
    }
  }
  numbers[0] = task_count;
  numbers[1] = work.next_node;
  numbers[2] = work.next_block;
  numbers[3] = work.largest_leaf;
  numbers[4] = work.deepest;
}

// One work-item a subtree: how many wide nodes and blocks are below its root, and what each wide node's children are, from
// the place of its first split in `opened` on: it has no more wide nodes than splits.
__kernel void count_subtrees(GN_TREE_PARAMETERS, __global GnCollapseTask* tasks, uint task_count,
                             __global GnOpened* opened) {
  const uint index = (uint)get_global_id(0);
  const GnTree tree = GN_TREE;
  GnEmission work;
  uint2 ranks;
  if (index >= task_count || GN_IDLE_LANE) return;
  ranks = ranks_of(&tree, tasks[index].root);
  expect_range(nodes + 1u + 2u * ranks.x, (ranks.y - ranks.x) * 2u * sizeof(GnNode));
  expect_range(forests + ranks.x, (ranks.y - ranks.x) * sizeof(GnForest));
  start_emission(&work, tasks[index].root, 0u, 0u, 0u, 0u);
  for (opened += ranks.x; work.height > 0u; ++opened) {
    GnSlots slots;
    open_top(&tree, &work, &slots);
    store_opened(opened, &slots);
    enter_node(&tree, &work, &slots, 0);
  }
  tasks[index].nodes_below = work.next_node;
  tasks[index].blocks_below = work.next_block;
  tasks[index].largest_leaf = work.largest_leaf;
}

// One work-item a subtree: writes it. depth receives the depth of the deepest wide node, counted from 1.
__kernel void emit_subtrees(GN_TREE_PARAMETERS, __global const GnCollapseTask* tasks, uint task_count,
                            volatile __global uint* depth, __global const GnOpened* opened) {
  const uint index = (uint)get_global_id(0);
  const GnTree tree = GN_TREE;
  GnEmission work;
  uint2 ranks;
  if (index >= task_count || GN_IDLE_LANE) return;
  ranks = ranks_of(&tree, tasks[index].root);
  expect_range(nodes + 1u + 2u * ranks.x, (ranks.y - ranks.x) * 2u * sizeof(GnNode));
  expect_triangles(&tree, tasks[index].root);
  start_emission(&work, tasks[index].root, tasks[index].node, tasks[index].depth, tasks[index].nodes_below,
                 tasks[index].blocks_below);
  for (opened += ranks.x; work.height > 0u; ++opened) {
    GnSlots slots;
    load_opened(opened, &slots);
    enter_node(&tree, &work, &slots, 1);
  }
  atomic_max(depth, work.deepest);
}
