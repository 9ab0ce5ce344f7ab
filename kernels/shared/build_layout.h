// Structs the builder's kernels pass among themselves and to the host's level loop. Same rules as layout.h.
#ifndef GNOMON_SHARED_BUILD_LAYOUT_H
#define GNOMON_SHARED_BUILD_LAYOUT_H

#include "layout.h"

#define GN_MAX_BINS 64u

#ifdef __OPENCL_VERSION__
#define GN_INFINITY INFINITY
#else
#define GN_INFINITY HUGE_VALF
#endif

// One bin's box; its count lives in an array of its own so that a box is two aligned vectors.
typedef struct GnBin {
  gn_f32 lo[3];
  gn_f32 pad0;
  gn_f32 hi[3];
  gn_f32 pad1;
} GnBin;
GN_SIZE_IS(GnBin, 32);

// A way to divide a node. axis == GN_NONE: none found. Bins [0, plane] go left; left_count triangles are in them.
typedef struct GnSplit {
  gn_f32 cost;
  gn_u32 axis;
  gn_u32 plane;
  gn_u32 left_count;
} GnSplit;
GN_SIZE_IS(GnSplit, 16);

// A node still to be built: triangles [begin, end) of one of the two primitive buffers.
// Centroid bounds are doubled (lo + hi of boxes). slot is its place in the sparse node array.
typedef struct GnTask {
  gn_f32 centroid_lo[3];
  gn_u32 begin;
  gn_f32 centroid_hi[3];
  gn_u32 end;
  gn_f32 lo[3];
  gn_u32 slot;
  gn_f32 hi[3];
  gn_u32 depth;
  gn_u32 buffer;      // 0 or 1: which primitive buffer holds it
  gn_u32 axis;        // chosen split; GN_NONE: halve by count
  gn_u32 plane;
  gn_u32 left_count;
} GnTask;
GN_SIZE_IS(GnTask, 80);

// A piece of a large node, binned and partitioned by one work-group.
typedef struct GnChunk {
  gn_u32 task;
  gn_u32 begin;
  gn_u32 end;
  gn_u32 left_begin;   // where this chunk's left part goes in the other buffer,
  gn_u32 right_begin;  // and its right part: written by split_tasks
  gn_u32 pad[3];
} GnChunk;
GN_SIZE_IS(GnChunk, 32);

// Bounds a chunk contributes: of boxes or doubled centroids, whoever writes it says which.
typedef struct GnBounds {
  gn_f32 lo[3];
  gn_f32 pad0;
  gn_f32 hi[3];
  gn_f32 pad1;
} GnBounds;
GN_SIZE_IS(GnBounds, 32);

// What a large node's two children look like after split_tasks and partition_chunks.
typedef struct GnChildren {
  GnBounds left_box;
  GnBounds right_box;
} GnChildren;
GN_SIZE_IS(GnChildren, 64);

#endif
