// One work-group builds one small subtree, depth first, going back and forth between the two primitive buffers.
// Every statement between barriers is met by all work-items: steps that do not apply run over empty ranges.
#include "few.h"
#include "partition.h"

// The smaller child is built first and the larger waits, so the stack holds at most log2(2^20) + 1 tasks.
#define GN_SUBTREE_STACK 24

static inline void set_task_bounds(__local GnTask* task, GnBoxPair box, GnBoxPair centroids) {
  task->lo[0] = box.lo.x;
  task->lo[1] = box.lo.y;
  task->lo[2] = box.lo.z;
  task->hi[0] = box.hi.x;
  task->hi[1] = box.hi.y;
  task->hi[2] = box.hi.z;
  task->centroid_lo[0] = centroids.lo.x;
  task->centroid_lo[1] = centroids.lo.y;
  task->centroid_lo[2] = centroids.lo.z;
  task->centroid_hi[0] = centroids.hi.x;
  task->centroid_hi[1] = centroids.hi.y;
  task->centroid_hi[2] = centroids.hi.z;
}

// A node of the sparse array: children of a split at leaf position m stand at 2m and 2m + 1.
static inline void write_node(__global GnNode* node, const GnTask* task, uint first, uint count) {
  int k;
  for (k = 0; k < 3; ++k) {
    node->lo[k] = task->lo[k];
    node->hi[k] = task->hi[k];
  }
  node->first = first;
  node->count = count;
}

#if GN_FEW > 0
// A leaf of one primitive.
static inline void write_single(__global GnNode* node, float8 primitive, uint first) {
  const float4 lo = primitive.lo, hi = primitive.hi;
  vstore3(lo.xyz, 0, node->lo);
  vstore3(hi.xyz, 0, node->hi);
  node->first = first;
  node->count = 1u;
}

// Builds a node of two primitives, unless its halves can only be told by their position, and says whether it did.
// deepest: raised to the depth of its leaves.
static inline int build_pair(__global const float8* from, const GnTask* task, GnBinning binning,
                             const GnHeuristic* heuristic, int how, const GnNodeView* view, __global GnNode* nodes,
                             __global uint* inner_rank, __global uint* order, uint* deepest) {
  const uint begin = task->begin;
  uint swaps;
  const float8 first = from[begin], second = from[begin + 1u];
  const GnSplit split = split_of_two(&heuristic->measure, how, first, second, binning, &swaps);
  const int is_leaf = gn_becomes_leaf(heuristic, how, view, &split);
  if (!is_leaf && split.axis == GN_NONE) return 0;
  if (is_leaf) {
    write_node(nodes + task->slot, task, begin, 2u);
    order[begin] = index_in(first.s3);
    order[begin + 1u] = index_in(second.s3);
    *deepest = max(*deepest, task->depth);
  } else {
    const uint middle = begin + 1u;
    write_node(nodes + task->slot, task, 2u * middle, 0u);
    write_single(nodes + 2u * middle, swaps ? second : first, begin);
    write_single(nodes + 2u * middle + 1u, swaps ? first : second, middle);
    order[begin] = index_in((swaps ? second : first).s3);
    order[middle] = index_in((swaps ? first : second).s3);
    inner_rank[middle] = 1u;
    *deepest = max(*deepest, task->depth + 1u);
  }
  return 1;
}
#endif

// Enters the split into the task, or marks it a leaf by left_count == 0.
static inline void decide(GnTask* task, const GnHeuristic* heuristic, int how, const GnNodeView* node,
                          const GnSplit* split) {
  const int leaf = gn_becomes_leaf(heuristic, how, node, split);
  task->axis = split->axis;
  task->plane = split->plane;
  task->left_count = leaf ? 0u : split->axis == GN_NONE ? node->count / 2u : split->left_count;
  task->left_measure = split->left_measure;
  task->right_measure = split->right_measure;
}

// One work-group per task of roots. Writes nodes into the sparse array, marks split positions in inner_rank with 1
// and leaf order into order; raises outcome[0] to the deepest leaf's depth. outcome[1] counts subtrees that were left
// unfinished, which only a device that ends loops by itself does.
__kernel void build_subtrees(__global float8* primitives0, __global float8* primitives1,
                             __global const GnTask* roots, __global GnNode* nodes, __global uint* inner_rank,
                             __global uint* order, volatile __global uint* outcome,
                             __global const GnHeuristic* heuristic_in, __global const float* triangles) {
  __local GnBin bins[GN_BIN_SETS * 3 * GN_BINS] __attribute__((aligned(32)));
  __local uint counts[GN_BIN_SETS * 3 * GN_BINS];
  __local GnSplit best_of_axis[3];
  __local GnTask stack[GN_SUBTREE_STACK];
  __local uint scan[GN_WGS];
  __local int keys[6];
  __local uint top;
  const GnHeuristic heuristic = *heuristic_in;
  uint deepest = 0u;
  if (GN_LOCAL_ID == 0u) {
    stack[0] = roots[get_group_id(0)];
    top = 1u;
  }
  GN_GROUP_BARRIER();
  while (1) {
    const uint height = top;
    GN_GROUP_BARRIER();
    if (height == 0u) break;
    GnTask task = stack[height - 1u];
    const uint count = task.end - task.begin;
    __global float8* from = task.buffer == 0u ? primitives0 : primitives1;
    __global float8* to = task.buffer == 0u ? primitives1 : primitives0;
    const GnBinning binning = binning_of(&task, triangles);
    const GnNodeView node = view_of(&task, binning);
    // Single triangles are leaves.
    const int how = count > 1u ? gn_measure_how_below(&heuristic.measure, (int)task.how, task.lo, task.hi) : 0;
    GnSplit split = gn_no_split();
    GN_GROUP_BARRIER();

    // Bin and choose; sure leaves and nodes past median_depth need no bins.
    const uint is_binned = task.depth < heuristic.rules.median_depth && !gn_is_surely_leaf(&heuristic, how, &node) ? 1u : 0u;
    const uint binned_end = is_binned ? task.end : task.begin;
    uint bin_count = GN_BINS;
#if GN_FEW > 0
    if (count == 2u && is_binned &&
        build_pair(from, &task, binning, &heuristic, how, &node, nodes, inner_rank, order, &deepest)) {
      top = height - 1u;
      continue;
    }
#endif
#if GN_FEW > 0
    uint bin_at[3 * GN_FEW];
    if (count <= GN_FEW && binned_end > task.begin) {
      bin_few(from + task.begin, count, binning, bins, counts, bin_at);
      bin_count = count;
      split = choose_split(&heuristic, how, &node, bins, counts, bin_count, best_of_axis);
    } else
#endif
#if GN_WGS == 1
    if (binned_end > task.begin) {
      bin_range(from, task.begin, binned_end, binning, bins, counts);
      split = choose_split(&heuristic, how, &node, bins, counts, bin_count, best_of_axis);
    }
#else
    bin_range(from, task.begin, binned_end, binning, bins, counts);
    split = choose_split(&heuristic, how, &node, bins, counts, bin_count, best_of_axis);
    if (binned_end == task.begin) split = gn_no_split();
#endif
    decide(&task, &heuristic, how, &node, &split);
#if GN_FEW > 0
    if (bin_count != GN_BINS && split.axis != GN_NONE) task.plane = bin_at[split.axis * GN_FEW + split.plane];
#endif
    const uint is_leaf = task.left_count == 0u ? 1u : 0u;
    const uint middle = task.begin + task.left_count;
    const uint halved = !is_leaf && task.axis == GN_NONE ? 1u : 0u;

    // Leaf: give out the order. Inner: partition.
    uint i;
    for (i = task.begin + GN_LOCAL_ID; i < (is_leaf ? task.end : task.begin); i += GN_WGS) {
      order[i] = index_in(from[i].s3);
    }
    const GnTwoBounds sides = partition_range(from, to, task.begin, is_leaf ? task.begin : task.end, task.begin,
                                              middle, side_of(&task, binning), scan, keys);
    GnBoxPair left = box_of_range(from, task.begin, halved ? middle : task.begin, keys);
    GnBoxPair right = box_of_range(from, middle, halved ? task.end : middle, keys);

    if (GN_LOCAL_ID == 0u) {
      write_node(nodes + task.slot, &task, is_leaf ? task.begin : 2u * middle, is_leaf ? count : 0u);
      if (is_leaf) {
        deepest = max(deepest, task.depth);
        top = height - 1u;
      } else {
        const uint left_waits = task.left_count > count - task.left_count ? 1u : 0u;
        __local GnTask* left_task = stack + (left_waits ? height - 1u : height);
        __local GnTask* right_task = stack + (left_waits ? height : height - 1u);
        if (!halved) {
          __local const GnBin* axis_bins = bins + task.axis * GN_BINS;
          left = box_of_bins(axis_bins, 0u, split.plane + 1u);
          right = box_of_bins(axis_bins, split.plane + 1u, bin_count);
        }
        set_task_bounds(left_task, left, sides.left);
        left_task->begin = task.begin;
        left_task->end = middle;
        left_task->slot = 2u * middle;
        left_task->depth = task.depth + 1u;
        left_task->buffer = task.buffer ^ 1u;
        left_task->probability = task.left_measure;
        left_task->how = (uint)how;
        set_task_bounds(right_task, right, sides.right);
        right_task->begin = middle;
        right_task->end = task.end;
        right_task->slot = 2u * middle + 1u;
        right_task->depth = task.depth + 1u;
        right_task->buffer = task.buffer ^ 1u;
        right_task->probability = task.right_measure;
        right_task->how = (uint)how;
        inner_rank[middle] = 1u;
        top = height + 1u;
      }
    }
    GN_GROUP_BARRIER();
  }
  if (GN_LOCAL_ID == 0u) {
    atomic_max(outcome, deepest);
    if (top != 0u) atomic_inc(outcome + 1);
  }
}
