// Structs the builder's kernels pass among themselves and to the host's level loop. Same rules as layout.h.
#ifndef GNOMON_SHARED_BUILD_LAYOUT_H
#define GNOMON_SHARED_BUILD_LAYOUT_H

#include "layout.h"

#define GN_MAX_BINS 64u
#define GN_FLOAT_MAX 3.402823466e38f

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

// How a box's hit probability is measured (measure_math.h): the frame of an influence area and what its rays are.
#define GN_MEASURE_LINEAR 0u       // weights alone: SAH, PAH of parallel rays, cones of directions, mixtures
#define GN_MEASURE_WINDOW 1u       // parallel rays along forward from a rectangle about origin
#define GN_MEASURE_SOLID_ANGLE 2u  // rays from origin, uniform in steradians
#define GN_MEASURE_NEAR_PLANE 3u   // rays from origin, uniform over a plane across forward
#define GN_MEASURE_YAW_PITCH 4u    // rays from origin, uniform in yaw (about up) and pitch
#define GN_MEASURE_CUSTOM 5u       // your own (custom_measure.h)
typedef struct GnMeasure {
  gn_f32 weights[3];   // of the faces across x, y, z; added to the area's measure
  gn_u32 kind;
  gn_f32 origin[3];
  gn_u32 culled;       // 1: only rays through the window count
  gn_f32 right[3];     // orthonormal with up and forward
  gn_f32 half_width;   // of the window: a length (WINDOW), else of the window at distance 1
  gn_f32 up[3];
  gn_f32 half_height;
  gn_f32 forward[3];
  gn_f32 near_distance;  // where rays begin, along forward; 0: at origin
  gn_f32 area_scale;   // factor of the area's measure
  gn_f32 half_pitch;   // YAW_PITCH: radians
  gn_u32 breaks_ties;  // 1: of equally costly splits the one of smaller surface area wins
  gn_f32 area_share;   // 1: the area's measure alone; less: mixed with surface area, both relative to the root
} GnMeasure;
GN_SIZE_IS(GnMeasure, 96);

// The measure's kind. GN_KIND: compiled for this kind and the linear measures that settle ties and fallbacks, without the
// code of the others.
GN_INLINE gn_u32 gn_kind_of(const GnMeasure* m) {
#ifdef GN_KIND
  return GN_KIND == GN_MEASURE_LINEAR || m->kind == GN_MEASURE_LINEAR ? GN_MEASURE_LINEAR : GN_KIND;
#else
  return m->kind;
#endif
}

#define GN_AXES_ALL 0u   // the cheapest split of all three axes
#define GN_AXES_SPFH 1u  // axes that rays cross least first (splitting plane facing heuristic)
#define GN_AXES_LSPH 2u  // longest axes first (longest side plane heuristic)
#define GN_LEAF_BY_COST 0u
#define GN_LEAF_PUBLISHED 1u

// When nodes are divided, and along which axes (axis_policy.h).
typedef struct GnRules {
  gn_u32 axes;
  gn_u32 repaired;           // 0: the published rule with its faults
  gn_u32 from_point;         // SPFH: rays come from measure.origin; 0: along measure.forward
  gn_u32 max_metric_depth;   // from this depth on surface area and longest axes decide
  gn_f32 quality_threshold;  // axes below it are replaced by the fallback
  gn_f32 acceptable;         // children's over father's probability: no fallback is tried
  gn_f32 excellent;          // nor another axis
  gn_u32 leaf_rule;
  gn_u32 max_leaf_size;      // by cost: triangles a leaf may hold; published: fewer make a leaf
  gn_u32 median_depth;       // by cost: from this depth on nodes are halved by count
  gn_f32 cost_traversal;
  gn_f32 cost_triangle;
  gn_u32 max_depth;          // published: deeper nodes are leaves,
  gn_f32 max_leaf_cost;      // and cheaper ones,
  gn_f32 max_leaf_probability;  // less probable ones,
  gn_f32 max_leaf_area;      // ones of smaller surface area
} GnRules;
GN_SIZE_IS(GnRules, 64);

// Everything that decides a tree's shape. surface is what fallbacks measure with: the root's surface area is 1.
typedef struct GnHeuristic {
  GnMeasure measure;
  GnMeasure surface;
  GnRules rules;
} GnHeuristic;
GN_SIZE_IS(GnHeuristic, 256);

// A way to divide a node. axis == GN_NONE: none found. Bins [0, plane] go left; left_count triangles are in them.
typedef struct GnSplit {
  gn_f32 cost;
  gn_u32 axis;
  gn_u32 plane;
  gn_u32 left_count;
  gn_f32 tie;            // the same cost by surface area; 0 where it is not wanted
  gn_f32 left_measure;
  gn_f32 right_measure;
  gn_u32 pad;
} GnSplit;
GN_SIZE_IS(GnSplit, 32);

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
  gn_f32 probability;    // as the split that made it rated it; GN_FLOAT_MAX at the root
  gn_f32 left_measure;   // its children's
  gn_f32 right_measure;
  gn_u32 how;  // its parent's parts were measured (GN_SEEN_*, seen_measure.h); GN_SEEN_PRECISE at the root
} GnTask;
GN_SIZE_IS(GnTask, 96);

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
