// Nodes too large for one work-group, a level at a time: bin every chunk, choose each node's split, partition every
// chunk. The host starts the three kernels per level and makes the next level's list (build_device.cpp).
#include "partition.h"

// One work-group per chunk. Writes the chunk's bins and counts (3 * GN_BINS each).
__kernel void bin_chunks(__global const float8* primitives0, __global const float8* primitives1,
                         __global const float* triangles, __global const GnTask* tasks,
                         __global const GnChunk* chunks, __global GnBin* chunk_bins, __global uint* chunk_counts) {
  __local GnBin bins[GN_BIN_SETS * 3 * GN_BINS] __attribute__((aligned(32)));
  __local uint counts[GN_BIN_SETS * 3 * GN_BINS];
  const uint group = (uint)get_group_id(0);
  const GnChunk chunk = chunks[group];
  const GnTask task = tasks[chunk.task];
  uint i;
  bin_range(task.buffer == 0u ? primitives0 : primitives1, chunk.begin, chunk.end, binning_of(&task, triangles), bins, counts);
  turn_bins(bins);
  for (i = GN_LOCAL_ID; i < 3u * GN_BINS; i += GN_WGS) {
    chunk_bins[(size_t)group * (3u * GN_BINS) + i] = bins[i];
    chunk_counts[(size_t)group * (3u * GN_BINS) + i] = counts[i];
  }
}

// Unites the bins of chunks [from, to) in local memory.
static inline void merge_chunks(__global const GnBin* chunk_bins, __global const uint* chunk_counts, uint from,
                                uint to, __local GnBin* bins, __local uint* counts) {
  uint i, chunk;
  for (i = GN_LOCAL_ID; i < 3u * GN_BINS; i += GN_WGS) {
    GnBoxPair box = empty_pair();
    uint count = 0u;
    for (chunk = from; chunk < to; ++chunk) {
      const size_t place = (size_t)chunk * (3u * GN_BINS) + i;
      box.lo = GN_VMIN(vload4(0, chunk_bins[place].lo), box.lo);
      box.hi = GN_VMAX(vload4(0, chunk_bins[place].hi), box.hi);
      count += chunk_counts[place];
    }
    vstore4(box.lo, 0, bins[i].lo);
    vstore4(box.hi, 0, bins[i].hi);
    counts[i] = count;
  }
  GN_GROUP_BARRIER();
}

// How many of a chunk's primitives go left under the task's split.
static inline uint lefts_in_chunk(const GnTask* task, const GnChunk* chunk, __global const uint* counts) {
  uint i, lefts = 0u;
  if (task->axis == GN_NONE) {
    const uint middle = task->begin + task->left_count;
    return min(max(middle, chunk->begin), chunk->end) - chunk->begin;
  }
  for (i = 0u; i <= task->plane; ++i) lefts += counts[task->axis * GN_BINS + i];
  return lefts;
}

// One work-group per task: merges its chunks' bins, writes the split into the task, the children's boxes (valid only
// when an axis was found) and where each chunk's parts go. first_chunk[task] .. first_chunk[task + 1] are its chunks.
// Large nodes never become leaves: they hold more triangles than any leaf may.
__kernel void split_tasks(__global GnTask* tasks, __global GnChunk* chunks, __global const uint* first_chunk,
                          __global const GnBin* chunk_bins, __global const uint* chunk_counts,
                          __global GnChildren* children, __global const GnHeuristic* heuristic_in,
                          __global const float* triangles) {
  __local GnBin bins[GN_BIN_SETS * 3 * GN_BINS] __attribute__((aligned(32)));
  __local uint counts[GN_BIN_SETS * 3 * GN_BINS];
  __local GnSplit best_of_axis[3];
  const uint group = (uint)get_group_id(0);
  const uint from = first_chunk[group], to = first_chunk[group + 1u];
  GnTask task = tasks[group];
  const uint count = task.end - task.begin;
  const GnHeuristic heuristic = *heuristic_in;
  const GnNodeView node = view_of(&task, binning_of(&task, triangles));
  const int how = gn_measure_how_below(&heuristic.measure, (int)task.how, task.lo, task.hi);
  GnSplit split;
  merge_chunks(chunk_bins, chunk_counts, from, to, bins, counts);
  turn_bins(bins);
  split = choose_split(&heuristic, how, &node, bins, counts, GN_BINS, best_of_axis);
  if (GN_LOCAL_ID == 0u) {
    const int halve = split.axis == GN_NONE || task.depth >= heuristic.rules.median_depth;
    uint chunk, left_at, right_at;
    task.axis = halve ? GN_NONE : split.axis;
    task.plane = split.plane;
    task.left_count = halve ? count / 2u : split.left_count;
    task.left_measure = split.left_measure;
    task.right_measure = split.right_measure;
    task.how = (uint)how;
    if (!halve) {
      __local const GnBin* axis_bins = bins + split.axis * GN_BINS;
      store_bounds(&children[group].left_box, box_of_bins(axis_bins, 0u, split.plane + 1u));
      store_bounds(&children[group].right_box, box_of_bins(axis_bins, split.plane + 1u, GN_BINS));
    }
    left_at = task.begin;
    right_at = task.begin + task.left_count;
    for (chunk = from; chunk < to; ++chunk) {
      const GnChunk piece = chunks[chunk];
      const uint lefts = lefts_in_chunk(&task, &piece, chunk_counts + (size_t)chunk * (3u * GN_BINS));
      chunks[chunk].left_begin = left_at;
      chunks[chunk].right_begin = right_at;
      left_at += lefts;
      right_at += piece.end - piece.begin - lefts;
    }
    tasks[group] = task;
  }
}

// One work-group per chunk: moves its primitives to the other buffer and writes four bounds per chunk: doubled
// centroids left and right, boxes left and right (the boxes only where the task is halved).
__kernel void partition_chunks(__global float8* primitives0, __global float8* primitives1,
                               __global const float* triangles, __global const GnTask* tasks, __global const GnChunk* chunks,
                               __global GnBounds* bounds) {
  __local uint scan[GN_WGS];
  __local int keys[6];
  const uint group = (uint)get_group_id(0);
  const GnChunk chunk = chunks[group];
  const GnTask task = tasks[chunk.task];
  const GnSide side = side_of(&task, binning_of(&task, triangles));
  __global const float8* from = task.buffer == 0u ? primitives0 : primitives1;
  __global float8* to = task.buffer == 0u ? primitives1 : primitives0;
  const GnTwoBounds sides =
      partition_range(from, to, chunk.begin, chunk.end, chunk.left_begin, chunk.right_begin, side, scan, keys);
  // Empty ranges unless halved: the barriers inside are met by every work-item either way.
  const uint middle = min(max(side.middle, chunk.begin), chunk.end);
  const uint halved = task.axis == GN_NONE ? 1u : 0u;
  const GnBoxPair left = box_of_range(from, chunk.begin, halved ? middle : chunk.begin, keys);
  const GnBoxPair right = box_of_range(from, middle, halved ? chunk.end : middle, keys);
  if (GN_LOCAL_ID == 0u) {
    store_bounds(bounds + 4u * group, sides.left);
    store_bounds(bounds + 4u * group + 1u, sides.right);
    store_bounds(bounds + 4u * group + 2u, left);
    store_bounds(bounds + 4u * group + 3u, right);
  }
}
