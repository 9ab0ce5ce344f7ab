// The last passes of the fast builder: clusters are listed, and once a tree over them is known (by the balanced builder,
// one cluster a leaf) each of its leaves is replaced by its cluster. A cluster with i inner nodes has i splits; between
// two clusters stands one more, so that prefix sums over the clusters in leaf order tell every node's number. Not for
// merging (ploc.cl).
#include "ahead.h"
#include "shared/fast_math.h"
#include "triangle_box.h"

// Place of the lower of the cluster's bits in GnCluster::place.
#define GN_NUMBER_MASK (2u * GN_SEGMENT - 1u)

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

// Merges of all segments, told apart by a cluster's place.
static inline __global const GnMerge* merge_of(__global const GnMerge* merges, uint place) {
  return merges + (size_t)(place / (2u * GN_SEGMENT)) * GN_SEGMENT + ((place & GN_NUMBER_MASK) - GN_SEGMENT);
}

static inline uint is_triangle(uint place) { return (place & GN_NUMBER_MASK) < GN_SEGMENT; }

// The place of a merge's child; right: 0 or 1.
static inline uint child_place(uint place, uint children, uint right) {
  return (place & ~GN_NUMBER_MASK) | ((children >> (16u * right)) & 0xffffu);
}

static inline uint inner_below(__global const GnMerge* merges, uint place) {
  return is_triangle(place) ? 0u : merge_of(merges, place)->counts >> 16;
}

// lo, hi: a box's bits, lanes w anything.
static inline void write_fast_node(__global GnNode* node, uint4 lo, uint4 hi, uint first, uint count) {
  vstore4((uint4)(lo.xyz, first), 0, (__global uint*)node);
  vstore4((uint4)(hi.xyz, count), 1, (__global uint*)node);
}

// Children of the k-th split between clusters, in the finished tree.
static inline uint children_of_split(__global const uint* first_split, uint k) { return 2u * first_split[k + 1u] - 1u; }

// A node of the tree over the clusters as the finished tree has it.
static inline void emit_top_node(__global const GnNode* top, __global const uint* order, __global const GnCluster* clusters,
                                 __global const GnMerge* merges, __global const uint* first_triangle,
                                 __global const uint* first_split, __global GnNode* out) {
  GnNode node = *top;
  if (node.count == 0u) {
    node.first = children_of_split(first_split, (node.first - 1u) / 2u);
  } else {
    const uint leaf = node.first;
    const GnCluster cluster = clusters[order[leaf]];
    if (cluster.counts >> 16) {
      const uint left = child_place(cluster.place, merge_of(merges, cluster.place)->children, 0u);
      node.first = 1u + 2u * (first_split[leaf] + inner_below(merges, left));
      node.count = 0u;
    } else {
      node.first = first_triangle[leaf];
      node.count = cluster.counts;
    }
  }
  *out = node;
}

// One work-item per cluster in leaf order: the root, or the children of the split before the cluster.
__kernel void emit_top(__global const GnNode* top, __global const uint* order, __global const GnCluster* clusters,
                       __global const GnMerge* merges, __global const uint* first_triangle,
                       __global const uint* first_split, __global GnNode* nodes, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  if (i == 0u) {
    emit_top_node(top, order, clusters, merges, first_triangle, first_split, nodes);
  } else {
    __global GnNode* out = nodes + children_of_split(first_split, i - 1u);
    emit_top_node(top + 2u * i - 1u, order, clusters, merges, first_triangle, first_split, out);
    emit_top_node(top + 2u * i, order, clusters, merges, first_triangle, first_split, out + 1);
  }
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

typedef struct GnAssembly {
  __global const GnLeafTriangle* triangles;  // in the curve's order
  __global const GnMerge* merges;
  __global GnNode* nodes;
  __global uint* order;
  __global GnLeafTriangle* leaf_triangles;
} GnAssembly;

// Instead of a node's number: it stands inside a leaf, or (the root) has been written by emit_top.
#define GN_IN_LEAF 0xfffffffeu
#define GN_IS_WRITTEN 0xffffffffu

// Copies a triangle to its place in leaf order and, where it is a leaf by itself, writes that node.
static inline void emit_triangle(const GnAssembly* tree, uint place, uint at, uint node) {
  __global const uint* from = (__global const uint*)(tree->triangles + (size_t)(place / (2u * GN_SEGMENT)) * GN_SEGMENT +
                                                       (place & GN_NUMBER_MASK));
  __global uint* out = (__global uint*)(tree->leaf_triangles + at);
  const uint4 a = vload4(0, from), b = vload4(1, from), c = vload4(2, from);
  tree->order[at] = a.w;
  vstore4(a, 0, out);
  vstore4(b, 1, out);
  vstore4(c, 2, out);
  if (node < GN_IN_LEAF) {
    const GnBoxPair box = box_of_corners(as_float4(a).xyz, as_float4(b).xyz, as_float4(c).xyz);
    write_fast_node(tree->nodes + node, as_uint4(box.lo), as_uint4(box.hi), at, 1u);
  }
}

// Writes what is below a cluster's root, left to right: its first triangle goes to `at` in leaf order, its first split is
// the one numbered `split`. The number of levels below the root.
static inline uint emit_cluster(const GnAssembly* tree, uint root, uint at, uint split) {
  uint places[GN_CLUSTER_DEPTH + 2u], nodes[GN_CLUSTER_DEPTH + 2u], depths[GN_CLUSTER_DEPTH + 2u];
  uint height = 1u, deepest = 0u;
  places[0] = root;
  nodes[0] = GN_IS_WRITTEN;
  depths[0] = 0u;
  while (height > 0u) {
    const uint place = places[height - 1u], node = nodes[height - 1u], depth = depths[height - 1u];
    deepest = max(deepest, depth);
    height -= 1u;
    if (is_triangle(place)) {
      emit_triangle(tree, place, at, node);
      split += node < GN_IN_LEAF;
      at += 1u;
    } else {
      __global const uint* merge = (__global const uint*)merge_of(tree->merges, place);
      const uint4 lo = vload4(0, merge), hi = vload4(1, merge);
      const uint left = child_place(place, lo.w, 0u);
      const uint inner = node == GN_IN_LEAF ? 0u : hi.w >> 16;
      const uint own = split + inner_below(tree->merges, left);
      const uint children = inner ? 1u + 2u * own : GN_IN_LEAF;
      if (node < GN_IN_LEAF)
        write_fast_node(tree->nodes + node, lo, hi, inner ? children : at, inner ? 0u : hi.w);
      split += !inner && node < GN_IN_LEAF;  // behind each leaf but the last stands a split
      places[height] = child_place(place, lo.w, 1u);
      nodes[height] = inner ? children + 1u : GN_IN_LEAF;
      depths[height] = depth + (inner ? 1u : 0u);
      places[height + 1u] = left;
      nodes[height + 1u] = children;
      depths[height + 1u] = depths[height];
      height += 2u;
    }
  }
  return deepest;
}

// What emit_cluster reads of a segment.
static inline void expect_segment(const GnAssembly* tree, uint segment, uint segments) {
  if (segment >= segments) return;
  expect_range(tree->merges + (size_t)segment * GN_SEGMENT, GN_SEGMENT * sizeof(GnMerge));
  expect_range(tree->triangles + (size_t)segment * GN_SEGMENT, GN_SEGMENT * sizeof(GnLeafTriangle));
}

// One work-item per `run` clusters, in the order of segments: a segment's are read together. leaves: of the clusters, in
// the tree over them. deepest: of all leaves.
__kernel void emit_clusters(__global const GnLeafTriangle* triangles, __global const GnMerge* merges,
                            __global const GnCluster* clusters, __global const GnNode* top, __global const uint* leaves,
                            __global const uint* first_triangle, __global const uint* first_split,
                            __global GnNode* nodes, __global uint* order, __global GnLeafTriangle* leaf_triangles,
                            volatile __global uint* deepest, uint count, uint segments, uint run) {
  const GnAssembly tree = {triangles, merges, nodes, order, leaf_triangles};
  const uint begin = min(count, (uint)get_global_id(0) * run);
  const uint end = begin + min(count - begin, run);
  uint i, depth = 0u, segment = GN_NONE;
  for (i = begin; i < end; ++i) {
    const uint place = clusters[i].place, leaf = leaves[i];
    uint below;
    if (run > 1u && place / (2u * GN_SEGMENT) != segment) {
      if (segment == GN_NONE) expect_segment(&tree, place / (2u * GN_SEGMENT), segments);
      segment = place / (2u * GN_SEGMENT);
      expect_segment(&tree, segment + 1u, segments);
    }
    below = emit_cluster(&tree, place, first_triangle[leaf], first_split[leaf]);
    depth = max(depth, below + depth_of_leaf(top, leaf));
  }
  if (begin < end) atomic_max(deepest, depth);
}
