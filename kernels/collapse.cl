// From the binary tree to the wide one (shared/wide_layout.h): cuts the tree into subtrees, works out from the leaves up
// what collapsing them costs, then writes wide nodes and leaves from the root down. A wide node's children
// that are nodes lie side by side, what is below them follows child by child: numbers depend on the tree alone, not
// on the cuts. One work-item a subtree throughout. weights: one a node of the binary tree, where they are given.
// slot_keys: one a node; the caller's, or worked out as costs are (write_keys != 0).
// Options: GN_COLLAPSE_DEPTH, above the binary tree's depth.
#include "children_first.h"

#ifndef GN_COLLAPSE_DEPTH
#define GN_COLLAPSE_DEPTH 96
#endif
#include "wide_emit.h"

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

// One work-item, twice. Goes through the wide nodes above subtrees of at most `limit` triangles. First (write == 0) it
// lists those subtrees; then, knowing what each holds, it writes the nodes above and tells each where to write.
// numbers: subtrees, wide nodes and leaves' places above them (when writing: all), largest leaf above, depth of the nodes
// above.
__kernel void emit_top(GN_TREE_PARAMETERS, __global GnCollapseTask* tasks, uint limit, __global uint* numbers, int write) {
  const GnTree tree = GN_TREE;
  GnEmission work;
  uint task_count = 0u, word;
  start_emission(&work, 0u, 0u, 0u, 1u, 0u);
  while (work.height > 0u) {
    const uint top = work.height - 1u;
    if (triangles_below(&tree, work.roots[top]) <= limit) {
      __global GnCollapseTask* task = tasks + task_count;
      if (write) {
        const uint nodes_below = task->nodes_below, places_below = task->places_below;
        task->node = work.places[top];
        task->nodes_below = work.next_node;
        task->places_below = work.next_place;
        work.next_node += nodes_below;
        work.next_place += places_below;
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
  if (write) {
    for (word = 0u; word < GN_LEAF_SLACK; ++word) leaves[GN_TRIANGLE_WORDS * work.next_place + word] = 0u;
  }
  numbers[0] = task_count;
  numbers[1] = work.next_node;
  numbers[2] = work.next_place;
  numbers[3] = work.largest_leaf;
  numbers[4] = work.deepest;
}

// One work-item a subtree: how many wide nodes and leaves' places are below its root, and what each wide node's children
// are, from the place of its first split in `opened` on: it has no more wide nodes than splits.
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
  tasks[index].places_below = work.next_place;
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
                 tasks[index].places_below);
  for (opened += ranks.x; work.height > 0u; ++opened) {
    GnSlots slots;
    load_opened(opened, &slots);
    enter_node(&tree, &work, &slots, 1);
  }
  atomic_max(depth, work.deepest);
}
