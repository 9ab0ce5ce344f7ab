// Every struct that crosses between host and device, in the C subset both compilers lay out alike: 32-bit
// scalars and arrays of them, no padding, sizes asserted here and probed on the device by probe.cl.
// Feeds the builders, the tracers, the file format and the tests.
#ifndef GNOMON_SHARED_LAYOUT_H
#define GNOMON_SHARED_LAYOUT_H

#include "scalar.h"

// Marks "no primitive" in a hit and "no node" in a link.
#define GN_NONE 0xffffffffu

// One triangle as the caller gives it: three corners, any unit of length, counter-clockwise seen from its front.
typedef struct GnTriangle {
  gn_f32 v0[3];
  gn_f32 v1[3];
  gn_f32 v2[3];
} GnTriangle;
GN_SIZE_IS(GnTriangle, 36);

// One triangle in leaf order, as traversal reads it. primitive is its index in the caller's array.
typedef struct GnLeafTriangle {
  gn_f32 v0[3];
  gn_u32 primitive;
  gn_f32 v1[3];
  gn_u32 pad0;
  gn_f32 v2[3];
  gn_u32 pad1;
} GnLeafTriangle;
GN_SIZE_IS(GnLeafTriangle, 48);

// What the builder sorts: a primitive's box and its index. The centroid is never stored: lo + hi is twice it.
typedef struct GnPrimitive {
  gn_f32 lo[3];
  gn_u32 index;
  gn_f32 hi[3];
  gn_u32 pad;
} GnPrimitive;
GN_SIZE_IS(GnPrimitive, 32);

// One node of the binary tree. count == 0: inner, children at [first] and [first + 1].
// count > 0: leaf, its triangles are [first, first + count) in leaf order. The root is node 0.
typedef struct GnNode {
  gn_f32 lo[3];
  gn_u32 first;
  gn_f32 hi[3];
  gn_u32 count;
} GnNode;
GN_SIZE_IS(GnNode, 32);

// The longest component of a direction must have a magnitude between these: 2^-100 and 2^100, about 8e-31 and 1.2e30.
// In between its reciprocal is a normal float on every device, and what a device flushes to zero of the shorter components
// is below 2^-26 of it, which the bounds of hit_math.h cover. Rays outside miss and are counted as invalid.
#define GN_SHORTEST_DIRECTION 7.8886091e-31f
#define GN_LONGEST_DIRECTION 1.2676506e+30f

// One ray: points origin + t * direction with tmin <= t <= tmax. The direction need not have unit length, but see above.
// t is a finite float: what lies beyond the largest is not met, however wide the range.
typedef struct GnRay {
  gn_f32 origin[3];
  gn_f32 tmin;
  gn_f32 direction[3];
  gn_f32 tmax;
} GnRay;
GN_SIZE_IS(GnRay, 32);

// One closest hit: the point origin + t * direction = (1-u-v) v0 + u v1 + v v2 of triangle `primitive`.
// A miss has primitive == GN_NONE, t == +inf, u == v == 0.
typedef struct GnHit {
  gn_f32 t;
  gn_f32 u;
  gn_f32 v;
  gn_u32 primitive;
} GnHit;
GN_SIZE_IS(GnHit, 16);

// Work one ray caused, when counters are compiled in: boxes and triangles tested.
typedef struct GnRayCounters {
  gn_u32 boxes;
  gn_u32 triangles;
} GnRayCounters;
GN_SIZE_IS(GnRayCounters, 8);

// Where a ray's traversal stands between two passes of a tracer that works in passes (trace.cl).
typedef struct GnWalk {
  GnHit best;
  gn_f32 limit;      // of box entries still of interest
  gn_u32 found;
  gn_u32 boxes;
  gn_u32 triangles;
  gn_u32 current;    // the node to visit next; GN_NONE: not begun
  gn_u32 height;     // of the stack of waiting nodes
  gn_u32 steps;      // nodes visited and triangles tested in this pass
  gn_u32 done;
} GnWalk;
GN_SIZE_IS(GnWalk, 48);

#endif
