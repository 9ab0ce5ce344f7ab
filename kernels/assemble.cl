// The last passes of the fast builder: clusters are listed, and once a tree over them is known (by the balanced builder,
// one cluster a leaf) each of its leaves is replaced by its cluster. A cluster with i inner nodes has i splits; between
// two clusters stands one more, so that prefix sums over the clusters in leaf order tell every node's number: what lies
// ready in a segment (ploc_parts.h) is copied there, its numbers moved along. Not for merging (ploc.cl).
#include "group.h"
#include "shared/fast_math.h"

// One work-item per segment: its clusters go behind those of the segments before it, as `clusters` and as triangles that
// have their boxes. Moved as bits: whole numbers need not survive as floats.
__kernel void list_clusters(__global const GnCluster* remaining, __global const uint* first, __global GnCluster* clusters,
                            __global uint* stand_ins, uint segments) {
  const uint segment = (uint)get_global_id(0);
  uint i;
  if (segment >= segments) return;
  for (i = first[segment]; i < first[segment + 1u]; ++i) {
    __global const uint* from = (__global const uint*)(remaining + segment * GN_SEGMENT_CLUSTERS + i - first[segment]);
    const uint4 lo = vload4(0, from), hi = vload4(1, from);
    __global uint* out = stand_ins + 9u * (size_t)i;
    vstore4(lo, 2u * i, (__global uint*)clusters);
    vstore4(hi, 2u * i + 1u, (__global uint*)clusters);
    vstore3(lo.xyz, 0, out);
    vstore3(hi.xyz, 1, out);
    vstore3(lo.xyz, 2, out);
  }
}

// One work-item per cluster in leaf order: its triangles, its splits with the one behind it, and the cluster's leaf.
__kernel void measure_clusters(__global const GnCluster* clusters, __global const uint* order, __global uint* triangles,
                               __global uint* splits, __global uint* leaves, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const uint counts = clusters[order[i]].counts;
  triangles[i] = counts & 0xffffu;
  splits[i] = (counts >> 16) + 1u;
  leaves[order[i]] = i;
}

// Children of the k-th split between clusters, in the finished tree.
static inline uint children_of_split(__global const uint* first_split, uint k) { return 2u * first_split[k + 1u] - 1u; }

// A node of the tree over the clusters as the finished tree has it.
static inline void emit_top_node(__global const GnNode* top, __global const uint* order, __global const GnCluster* clusters,
                                 __global const uint* first_triangle, __global const uint* first_split,
                                 __global GnNode* out) {
  GnNode node = *top;
  if (node.count == 0u) {
    node.first = children_of_split(first_split, (node.first - 1u) / 2u);
  } else {
    const uint leaf = node.first;
    const GnCluster cluster = clusters[order[leaf]];
    if (cluster.counts >> 16) {
      node.first = 1u + 2u * (first_split[leaf] + (cluster.shape & 0xffffu));
      node.count = 0u;
    } else {
      node.first = first_triangle[leaf];
      node.count = cluster.counts;
    }
  }
  *out = node;
}

// Levels above a leaf of the tree over the clusters: splits are in leaf order, so the way down is known.
static inline uint depth_of_leaf(__global const GnNode* top, uint leaf) {
  uint depth = 0u, node = 0u;
  while (top[node].count == 0u) {
    const uint left = top[node].first;
    node = leaf <= (left - 1u) / 2u ? left : left + 1u;
    depth += 1u;
  }
  return depth;
}

// One work-item per cluster in leaf order: the root, or the children of the split before the cluster. deepest: of all leaves.
__kernel void emit_top(__global const GnNode* top, __global const uint* order, __global const GnCluster* clusters,
                       __global const uint* first_triangle, __global const uint* first_split, __global GnNode* nodes,
                       volatile __global uint* deepest, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  if (i == 0u) {
    emit_top_node(top, order, clusters, first_triangle, first_split, nodes);
  } else {
    __global GnNode* out = nodes + children_of_split(first_split, i - 1u);
    emit_top_node(top + 2u * i - 1u, order, clusters, first_triangle, first_split, out);
    emit_top_node(top + 2u * i, order, clusters, first_triangle, first_split, out + 1);
  }
  // Here, where neighbours have most of the way down in common.
  atomic_max(deepest, depth_of_leaf(top, i) + (clusters[order[i]].shape >> 16));
}

// Past the caches where the compiler has a way to: nothing that is written here is read before all is.
#if GN_WGS == 1 && defined(POCL_DEVICE_ADDRESS_BITS)
#define GN_PUT_AWAY(v, i, at) __builtin_nontemporal_store(v, (__global uint4*)(at) + (i))
#else
#define GN_PUT_AWAY(v, i, at) vstore4(v, i, at)
#endif

static inline void copy_triangles(__global const GnLeafTriangle* from, __global GnLeafTriangle* out, __global uint* order,
                                  uint count) {
  uint i;
  for (i = GN_LOCAL_ID; i < count; i += GN_WGS) {
    __global const uint* words = (__global const uint*)(from + i);
    const uint4 a = vload4(0, words), b = vload4(1, words), c = vload4(2, words);
    order[i] = a.w;
    GN_PUT_AWAY(a, 0, (__global uint*)(out + i));
    GN_PUT_AWAY(b, 1, (__global uint*)(out + i));
    GN_PUT_AWAY(c, 2, (__global uint*)(out + i));
  }
}

// children, triangles: what is added to an inner node's and to a leaf's first. By a product: compilers would make a branch of
// the choice, and which it is cannot be foreseen.
static inline void copy_nodes(__global const GnNode* from, __global GnNode* out, uint count, uint children,
                              uint triangles) {
  uint i;
  for (i = GN_LOCAL_ID; i < count; i += GN_WGS) {
    __global const uint* words = (__global const uint*)(from + i);
    const uint4 lo = vload4(0, words), hi = vload4(1, words);
    GN_PUT_AWAY((uint4)(lo.xyz, lo.w + children + min(hi.w, 1u) * (triangles - children)), 0, (__global uint*)(out + i));
    GN_PUT_AWAY(hi, 1, (__global uint*)(out + i));
  }
}

// One work-group per segment, whose clusters are those from first[segment] on. leaves: of the clusters, in the tree over
// them.
__kernel void emit_clusters(__global const GnLeafTriangle* sorted, __global const GnNode* parts,
                            __global const GnCluster* clusters, __global const uint* first, __global const uint* leaves,
                            __global const uint* first_triangle, __global const uint* first_split,
                            __global GnNode* nodes, __global uint* order, __global GnLeafTriangle* leaf_triangles) {
  const uint segment = (uint)get_group_id(0), begin = first[segment], end = first[segment + 1u];
  uint triangles_before = 0u, splits_before = 0u, i;
  sorted += (size_t)segment * GN_SEGMENT;
  parts += (size_t)segment * GN_SEGMENT_NODES;
  for (i = 0u; i < GN_SEGMENT_CLUSTERS; ++i) {
    if (i < end - begin) {
      const uint leaf = leaves[begin + i], counts = clusters[begin + i].counts, inner = counts >> 16;
      const uint triangle = first_triangle[leaf], split = first_split[leaf];
      copy_triangles(sorted + triangles_before, leaf_triangles + triangle, order + triangle, counts & 0xffffu);
      copy_nodes(parts + 2u * splits_before, nodes + 1u + 2u * split, 2u * inner, 1u + 2u * (split - splits_before),
                 triangle - triangles_before);
      triangles_before += counts & 0xffffu;
      splits_before += inner;
    }
  }
}
