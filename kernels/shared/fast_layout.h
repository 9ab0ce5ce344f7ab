// Structs and sizes of the fast builder (host/notes/fast-builder.md). All sizes here are part of the algorithm: they
// decide the tree, so no device may choose others. Same rules as layout.h. Feeds fast_math.h, the fast builder's kernels
// and reference.
#ifndef GNOMON_SHARED_FAST_LAYOUT_H
#define GNOMON_SHARED_FAST_LAYOUT_H

#include "layout.h"

// So many triangles, neighbours on the Morton curve, are merged by themselves; at most 2^16 / 2, so that counts fit.
#define GN_SEGMENT 512u
// Merging stops when a segment has no more than a cluster for each so many triangles.
#define GN_PER_CLUSTER 32u
#define GN_SEGMENT_CLUSTERS (GN_SEGMENT / GN_PER_CLUSTER)
// How far along the curve a cluster looks for a partner, each way.
#define GN_NEIGHBOURS 7
// After so many rounds neighbours merge whatever they cost: a cluster is then no deeper than these rounds and one for
// each halving, GN_MOST_ROUNDS.
#define GN_FREE_ROUNDS 24u
#define GN_MOST_ROUNDS (GN_FREE_ROUNDS + 9u)
// Nodes below a segment's clusters are fewer than these.
#define GN_SEGMENT_NODES (2u * GN_SEGMENT)
// Levels of the tree over the clusters that are divided by cost; below them counts are halved.
#define GN_CLUSTERS_BY_COST 30u

// Bits of a cell's number along each axis; a Morton code has the upper or the lower ten of all three.
#define GN_CELL_BITS 20u

// A triangle's place on the Morton curve.
typedef struct GnMortonKey {
  gn_u32 code;
  gn_u32 triangle;
} GnMortonKey;
GN_SIZE_IS(GnMortonKey, 8);

// The cube of doubled centroids that cells divide.
typedef struct GnMortonFrame {
  gn_f32 lo[3];
  gn_f32 scale;  // cells per unit; 0: all centroids are one
} GnMortonFrame;
GN_SIZE_IS(GnMortonFrame, 16);

// Two clusters made one. Clusters of a segment are numbered: its triangles in Morton order from 0 on, its merges from
// GN_SEGMENT on, children before parents. children: the left one's number, the right one's in the upper half. counts:
// triangles, and in the upper half inner nodes that stay (0: this is one leaf).
typedef struct GnMerge {
  gn_f32 lo[3];
  gn_u32 children;
  gn_f32 hi[3];
  gn_u32 counts;
} GnMerge;
GN_SIZE_IS(GnMerge, 32);

// A cluster that stays when its segment's merging ends: a leaf of the tree above. shape: inner nodes below its left child,
// and in the upper half the levels below its root. counts as a merge's. What is below its root lies ready in its segment:
// triangles in leaf order and pairs of nodes in the order of their splits, both behind those of the clusters before it.
typedef struct GnCluster {
  gn_f32 lo[3];
  gn_u32 shape;
  gn_f32 hi[3];
  gn_u32 counts;
} GnCluster;
GN_SIZE_IS(GnCluster, 32);

#endif
