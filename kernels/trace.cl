// Batched ray tracing over the binary tree, one ray per work-item, nearest child first.
// Options: GN_STACK_SIZE (at least the tree's depth + 1; each level leaves at most one node waiting, so it cannot
// overflow), GN_COUNTERS (1: write what each ray cost).
#include "shared/hit_math.h"

#ifndef GN_STACK_SIZE
#define GN_STACK_SIZE 96
#endif
#ifndef GN_COUNTERS
#define GN_COUNTERS 0
#endif

// Where a traversal stands, and what it has found.
typedef struct GnWalk {
  GnHit best;
  gn_f32 limit;       // of box entries still of interest
  uint found;
  uint boxes;
  uint triangles;
} GnWalk;

static inline float entry_of(const GnRayFrame* frame, __global const GnNode* node, float tmin, float limit) {
  const float lo[3] = {node->lo[0], node->lo[1], node->lo[2]};
  const float hi[3] = {node->hi[0], node->hi[1], node->hi[2]};
  return gn_box_entry(frame, lo, hi, tmin, limit);
}

// Tests a leaf's triangles; with any_hit stops at the first.
static inline void test_leaf(GnWalk* walk, const GnRayFrame* frame, const GnRay* ray,
                             __global const GnLeafTriangle* triangles, uint first, uint count, int any_hit) {
  uint i;
  for (i = first; i < first + count; ++i) {
    const GnLeafTriangle triangle = triangles[i];
    GnHit hit;
    walk->triangles += 1u;
    if (!gn_triangle_hit(frame, triangle.v0, triangle.v1, triangle.v2, &hit)) continue;
    if (!(hit.t >= ray->tmin && hit.t <= ray->tmax)) continue;
    hit.primitive = triangle.primitive;
    if (!walk->found || gn_hit_is_nearer(&hit, &walk->best)) {
      walk->best = hit;
      walk->found = 1u;
      walk->limit = gn_slab_limit(hit.t);
      if (any_hit) return;
    }
  }
}

static inline void traverse(GnWalk* walk, const GnRay* ray, __global const GnNode* nodes,
                            __global const GnLeafTriangle* triangles, int any_hit) {
  uint waiting[GN_STACK_SIZE];
  float waiting_entry[GN_STACK_SIZE];
  const GnRayFrame frame = gn_ray_frame(ray);
  uint height = 0u, current = 0u;
  walk->boxes += 1u;
  if (entry_of(&frame, nodes, ray->tmin, walk->limit) == INFINITY) return;
  while (1) {
    const uint first = nodes[current].first, count = nodes[current].count;
    int descend = 0;
    if (count > 0u) {
      test_leaf(walk, &frame, ray, triangles, first, count, any_hit);
      if (any_hit && walk->found) return;
    } else {
      const float left = entry_of(&frame, nodes + first, ray->tmin, walk->limit);
      const float right = entry_of(&frame, nodes + first + 1u, ray->tmin, walk->limit);
      const int left_first = left <= right;
      const float far_entry = left_first ? right : left;
      walk->boxes += 2u;
      if (far_entry < INFINITY) {
        waiting[height] = left_first ? first + 1u : first;
        waiting_entry[height] = far_entry;
        height += 1u;
      }
      current = left_first ? first : first + 1u;
      descend = (left_first ? left : right) < INFINITY;
    }
    if (!descend) {
      // The next waiting node that is not beyond the best hit found since it was pushed.
      do {
        if (height == 0u) return;
        height -= 1u;
      } while (waiting_entry[height] > walk->limit);
      current = waiting[height];
    }
  }
}

static inline GnRay load_ray(__global const float8* rays, uint index) {
  const float8 r = rays[index];
  GnRay ray;
  ray.origin[0] = r.s0;
  ray.origin[1] = r.s1;
  ray.origin[2] = r.s2;
  ray.tmin = r.s3;
  ray.direction[0] = r.s4;
  ray.direction[1] = r.s5;
  ray.direction[2] = r.s6;
  ray.tmax = r.s7;
  return ray;
}

static inline GnWalk start_walk(const GnRay* ray) {
  GnWalk walk;
  walk.best.t = INFINITY;
  walk.best.u = 0.0f;
  walk.best.v = 0.0f;
  walk.best.primitive = GN_NONE;
  walk.limit = gn_slab_limit(ray->tmax);
  walk.found = 0u;
  walk.boxes = 0u;
  walk.triangles = 0u;
  return walk;
}

static inline GnWalk walk_ray(const GnRay* ray, __global const GnNode* nodes,
                              __global const GnLeafTriangle* triangles, volatile __global uint* invalid_rays,
                              int any_hit) {
  GnWalk walk = start_walk(ray);
  if (gn_ray_is_valid(ray)) {
    traverse(&walk, ray, nodes, triangles, any_hit);
  } else {
    atomic_inc(invalid_rays);
  }
  return walk;
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
                            __global GnRayCounters* counters, uint count) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    const GnWalk walk = walk_ray(&ray, nodes, triangles, invalid_rays, 0);
    hits[index] = (float4)(walk.best.t, walk.best.u, walk.best.v, as_float(walk.best.primitive));
    store_counters(counters, index, &walk);
  }
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_any(__global const GnNode* nodes, __global const GnLeafTriangle* triangles,
                        __global const float8* rays, __global uint* occluded, volatile __global uint* invalid_rays,
                        __global GnRayCounters* counters, uint count) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    const GnWalk walk = walk_ray(&ray, nodes, triangles, invalid_rays, 1);
    occluded[index] = walk.found;
    store_counters(counters, index, &walk);
  }
}
