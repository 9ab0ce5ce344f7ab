// Batched ray tracing over the binary tree, one ray per work-item, nearest child first. Options: see walk.h.
#include "shared/hit_math.h"

typedef struct GnLeaves {
  __global const GnLeafTriangle* triangles;
} GnLeaves;

static inline GnLeafTriangle leaf_triangle(const GnLeaves* leaves, uint place) { return leaves->triangles[place]; }

#define GN_STATE GnWalk
#define GN_WALK_OF(state) (state)
#include "walk.h"

static inline void walk_ray(GnWalk* walk, GnStack* stack, const GnRay* ray, __global const GnNode* nodes,
                            __global const GnLeafTriangle* triangles, volatile __global uint* invalid_rays,
                            int any_hit) {
  if (gn_ray_is_valid(ray)) {
    GnLeaves leaves;
    leaves.triangles = triangles;
    traverse(walk, stack, ray, nodes, 0u, &leaves, any_hit);
  } else {
    walk->done = 1u;
    atomic_inc(invalid_rays);
  }
}

static inline void store_counters(__global GnRayCounters* counters, uint index, const GnWalk* walk) {
#if GN_COUNTERS
  counters[index].boxes = walk->boxes;
  counters[index].triangles = walk->triangles;
#endif
}

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_closest(__global const GnNode* nodes, __global const GnLeafTriangle* triangles,
                            __global const float8* rays, __global float4* hits, volatile __global uint* invalid_rays,
                            __global GnRayCounters* counters, uint count GN_PASS_PARAMETERS) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    GnWalk walk = start_walk(&ray);
    GnStack stack;
    if (!GN_RESUME(&walk, &stack)) return;
    walk_ray(&walk, &stack, &ray, nodes, triangles, invalid_rays, 0);
    GN_PAUSE(&walk)
    hits[index] = (float4)(walk.best.t, walk.best.u, walk.best.v, as_float(walk.best.primitive));
    store_counters(counters, index, &walk);
  }
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_any(__global const GnNode* nodes, __global const GnLeafTriangle* triangles,
                        __global const float8* rays, __global uint* occluded, volatile __global uint* invalid_rays,
                        __global GnRayCounters* counters, uint count GN_PASS_PARAMETERS) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    GnWalk walk = start_walk(&ray);
    GnStack stack;
    if (!GN_RESUME(&walk, &stack)) return;
    walk_ray(&walk, &stack, &ray, nodes, triangles, invalid_rays, 1);
    GN_PAUSE(&walk)
    occluded[index] = walk.found;
    store_counters(counters, index, &walk);
  }
}
