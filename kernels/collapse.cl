// From the binary tree to the wide one (shared/wide_layout.h): cuts the tree into subtrees, works out from the leaves up
// what collapsing them costs, then writes wide nodes and triangle blocks from the root down. A wide node's children
// that are nodes lie side by side, what is below them follows child by child: numbers depend on the tree alone, not
// on the cuts. One work-item a subtree throughout. Options: GN_COLLAPSE_DEPTH, above the binary tree's depth.
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

static inline void join_children(__global const GnNode* nodes, __global GnForest* forests, uint node,
                                 GnCollapseCosts costs) {
  const uint first = nodes[node].first;
  const GnForest left = gn_forest_of(nodes, forests, first, costs.block);
  const GnForest right = gn_forest_of(nodes, forests, first + 1u, costs.block);
  forests[(first - 1u) / 2u] = gn_inner_forest(gn_half_area(nodes + node), &left, &right, costs);
}

// Forests of the inner nodes of one subtree per work-item, children before parents.
__kernel void weigh_subtrees(__global const GnNode* nodes, __global GnForest* forests, __global const uint* tasks,
                             uint task_count, float node_cost, float block_cost) {
  const uint task = (uint)get_global_id(0);
  const GnCollapseCosts costs = {node_cost, block_cost};
  uint waiting[2 * GN_COLLAPSE_DEPTH];
  uint height = 1u;
  if (task >= task_count) return;
  waiting[0] = tasks[task];
  while (height > 0u) {
    const uint entry = waiting[height - 1u];
    if (entry & 0x80000000u) {  // its children are done
      join_children(nodes, forests, entry & 0x7fffffffu, costs);
      height -= 1u;
    } else {
      const uint first = nodes[entry].first;
      waiting[height - 1u] = entry | 0x80000000u;
      if (nodes[first + 1u].count == 0u) {
        waiting[height] = first + 1u;
        height += 1u;
      }
      if (nodes[first].count == 0u) {
        waiting[height] = first;
        height += 1u;
      }
    }
  }
}

// One work-item: forests of the nodes above the subtrees, from the last found to the root.
__kernel void weigh_top(__global const GnNode* nodes, __global GnForest* forests, __global const uint* top,
                        uint top_count, float node_cost, float block_cost) {
  const GnCollapseCosts costs = {node_cost, block_cost};
  uint i;
  for (i = top_count; i > 0u; --i) join_children(nodes, forests, top[i - 1u], costs);
}

typedef struct GnTree {
  __global const GnNode* nodes;
  __global const GnForest* forests;
  __global const GnLeafTriangle* triangles;
  __global GnWideNode* wide_nodes;
  __global GnTriangleBlock* blocks;
  GnCollapseCosts costs;
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

static inline void write_leaf(const GnTree* tree, uint node, uint triangles, uint block) {
  const uint first = gn_first_triangle(tree->nodes, node);
  uint i, k;
  for (i = 0u; i < gn_blocks_of(triangles) * GN_WIDTH; ++i) {
    __global GnTriangleBlock* out = tree->blocks + block + i / GN_WIDTH;
    const uint lane = i % GN_WIDTH;
    if (i < triangles) {
      const GnLeafTriangle triangle = tree->triangles[first + i];
      for (k = 0u; k < 3u; ++k) {
        out->corners[k][lane] = triangle.v0[k];
        out->corners[3u + k][lane] = triangle.v1[k];
        out->corners[6u + k][lane] = triangle.v2[k];
      }
      out->primitives[lane] = triangle.primitive;
    } else {
      for (k = 0u; k < 9u; ++k) out->corners[k][lane] = 0.0f;
      out->primitives[lane] = GN_NONE;
    }
  }
}

static inline void write_box(__global GnWideNode* out, uint slot, __global const GnNode* node) {
  uint k;
  for (k = 0u; k < 3u; ++k) {
    out->planes[2u * k][slot] = node->lo[k];
    out->planes[2u * k + 1u][slot] = node->hi[k];
  }
}

static inline void write_empty_slot(__global GnWideNode* out, uint slot) {
  uint k;
  for (k = 0u; k < 3u; ++k) {
    out->planes[2u * k][slot] = INFINITY;
    out->planes[2u * k + 1u][slot] = -INFINITY;
  }
  out->links[slot] = GN_NONE;
}

// Writes (or only numbers) the wide node on top of the stack and puts its children that are nodes in its place, the
// first of them on top.
static inline void emit_node(const GnTree* tree, GnEmission* work, int write) {
  GnSlots slots;
  const uint top = work->height - 1u;
  const uint depth = work->depths[top] + 1u;
  __global GnWideNode* out = tree->wide_nodes + work->places[top];
  uint slot, inner = 0u, entered = 0u;
  gn_open_wide_node(tree->nodes, tree->forests, work->roots[top], tree->costs, &slots);
  for (slot = 0u; slot < slots.count; ++slot) inner += slots.triangles[slot] == 0u;
  for (slot = 0u; slot < slots.count; ++slot) {
    const uint triangles = slots.triangles[slot];
    uint link;
    if (triangles == 0u) {
      const uint place = top + inner - 1u - entered;
      link = work->next_node + entered;
      work->roots[place] = slots.node[slot];
      work->places[place] = link;
      work->depths[place] = depth;
      entered += 1u;
    } else {
      link = gn_leaf_link(work->next_block, triangles);
      if (write) write_leaf(tree, slots.node[slot], triangles, work->next_block);
      work->next_block += gn_blocks_of(triangles);
      work->largest_leaf = max(work->largest_leaf, triangles);
    }
    if (write) {
      write_box(out, slot, tree->nodes + slots.node[slot]);
      out->links[slot] = link;
    }
  }
  if (write) {
    for (; slot < GN_WIDTH; ++slot) write_empty_slot(out, slot);
    for (slot = 0u; slot < GN_WIDTH; ++slot) out->pad[slot] = 0u;
  }
  work->next_node += inner;
  work->height = top + inner;
  work->deepest = max(work->deepest, depth);
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
  return gn_forest_of(tree->nodes, tree->forests, node, tree->costs.block).triangles;
}

#define GN_TREE_PARAMETERS                                                                                         \
  __global const GnNode *nodes, __global const GnForest *forests, __global const GnLeafTriangle *triangles,         \
      __global GnWideNode *wide_nodes, __global GnTriangleBlock *blocks, float node_cost, float block_cost
#define GN_TREE {nodes, forests, triangles, wide_nodes, blocks, {node_cost, block_cost}}

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
      emit_node(&tree, &work, write);
    }
  }
  numbers[0] = task_count;
  numbers[1] = work.next_node;
  numbers[2] = work.next_block;
  numbers[3] = work.largest_leaf;
  numbers[4] = work.deepest;
}

// One work-item a subtree: how many wide nodes and blocks are below its root.
__kernel void count_subtrees(GN_TREE_PARAMETERS, __global GnCollapseTask* tasks, uint task_count) {
  const uint index = (uint)get_global_id(0);
  const GnTree tree = GN_TREE;
  GnEmission work;
  if (index >= task_count) return;
  start_emission(&work, tasks[index].root, 0u, 0u, 0u, 0u);
  while (work.height > 0u) emit_node(&tree, &work, 0);
  tasks[index].nodes_below = work.next_node;
  tasks[index].blocks_below = work.next_block;
  tasks[index].largest_leaf = work.largest_leaf;
}

// One work-item a subtree: writes it. depth receives the depth of the deepest wide node, counted from 1.
__kernel void emit_subtrees(GN_TREE_PARAMETERS, __global const GnCollapseTask* tasks, uint task_count,
                            volatile __global uint* depth) {
  const uint index = (uint)get_global_id(0);
  const GnTree tree = GN_TREE;
  GnEmission work;
  if (index >= task_count) return;
  start_emission(&work, tasks[index].root, tasks[index].node, tasks[index].depth, tasks[index].nodes_below,
                 tasks[index].blocks_below);
  while (work.height > 0u) emit_node(&tree, &work, 1);
  atomic_max(depth, work.deepest);
}
