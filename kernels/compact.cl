// The last pass of a build: the sparse node array (children of the split at leaf position m at 2m, 2m + 1) becomes
// the dense tree, numbered by the rank of m among all splits, and triangles are copied in leaf order.
#include "ahead.h"
#include "shared/build_layout.h"

// Triangles that are sent for before they are copied.
#define GN_AHEAD 16u

// Enters the nodes the level loop divided: large[i], all inner, belongs at slots[i] of the sparse array.
__kernel void enter_large_nodes(__global const GnNode* large, __global const uint* slots, __global GnNode* sparse,
                                __global uint* inner_rank, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  sparse[slots[i]] = large[i];
  inner_rank[large[i].first / 2u] = 1u;
}

// One work-item per chunk: how many splits it holds.
__kernel void count_inner(__global const uint* inner_rank, __global uint* chunk_sums, uint count, uint chunk_size) {
  const uint chunk = (uint)get_global_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = min(count, begin + chunk_size);
  uint i, sum = 0u;
  for (i = begin; i < end; ++i) sum += inner_rank[i];
  chunk_sums[chunk] = sum;
}

// One work-item: exclusive prefix sum of chunk_sums in place; the total goes to chunk_sums[chunk_count].
__kernel void scan_chunk_sums(__global uint* chunk_sums, uint chunk_count) {
  uint i, sum = 0u;
  for (i = 0u; i < chunk_count; ++i) {
    const uint value = chunk_sums[i];
    chunk_sums[i] = sum;
    sum += value;
  }
  chunk_sums[chunk_count] = sum;
}

// One work-item per chunk: replaces marks by ranks, and everything else by GN_NONE.
__kernel void rank_inner(__global uint* inner_rank, __global const uint* chunk_sums, uint count, uint chunk_size) {
  const uint chunk = (uint)get_global_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = min(count, begin + chunk_size);
  uint i, rank = chunk_sums[chunk];
  for (i = begin; i < end; ++i) {
    const uint marked = inner_rank[i];
    inner_rank[i] = marked ? rank : GN_NONE;
    rank += marked;
  }
}

static inline GnNode with_dense_link(__global const GnNode* sparse, __global const uint* inner_rank) {
  GnNode node = *sparse;
  if (node.count == 0u) node.first = 1u + 2u * inner_rank[node.first / 2u];
  return node;
}

// One work-item per leaf position: the pair of children that split there, if any; item 0 copies the root.
__kernel void emit_nodes(__global const GnNode* sparse, __global const uint* inner_rank, __global GnNode* nodes,
                         uint count) {
  const uint middle = (uint)get_global_id(0);
  if (middle >= count) return;
  if (middle == 0u) {
    nodes[0] = with_dense_link(sparse, inner_rank);
  } else if (inner_rank[middle] != GN_NONE) {
    const uint place = 1u + 2u * inner_rank[middle];
    nodes[place] = with_dense_link(sparse + 2u * (size_t)middle, inner_rank);
    nodes[place + 1u] = with_dense_link(sparse + 2u * (size_t)middle + 1u, inner_rank);
  }
}

// One work-item per leaf position: copies its triangle.
__kernel void gather_triangles(__global const float* triangles, __global const uint* order,
                               __global GnLeafTriangle* leaf_triangles, uint count) {
  const uint place = (uint)get_global_id(0);
  if (place >= count) return;
  const uint primitive = order[place];
  __global const float* corners = triangles + 9u * (size_t)primitive;
  GnLeafTriangle out;
  int k;
  GN_EXPECT(triangles + 9u * (size_t)order[min(place + GN_AHEAD, count - 1u)]);
  GN_EXPECT(triangles + 9u * (size_t)order[min(place + GN_AHEAD, count - 1u)] + 8);
  for (k = 0; k < 3; ++k) {
    out.v0[k] = corners[k];
    out.v1[k] = corners[3 + k];
    out.v2[k] = corners[6 + k];
  }
  out.primitive = primitive;
  out.pad0 = 0u;
  out.pad1 = 0u;
  leaf_triangles[place] = out;
}
