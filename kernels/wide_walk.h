// One ray through the wide tree, eight boxes or eight triangles a step. Closest hit visits children by distance, any
// hit the largest first. Hits are those of trace.cl, bit for bit.
// Options: GN_WIDE_STACK (at least 7 * depth of the wide tree + 8), GN_COUNTERS, GN_PORTABLE (eight.h).
// Feeds trace_wide.cl and trace_packet.cl.
#ifndef GNOMON_WIDE_WALK_H
#define GNOMON_WIDE_WALK_H

#include "wide_leaf.h"

#ifndef GN_WIDE_STACK
#define GN_WIDE_STACK 256
#endif

#define GN_PLANES(node, offset) (*(__global const float8*)((__global const char*)(node) + (offset)))

// The slots whose boxes the ray may meet within [tmin, limit], and where it enters them.
static inline uint boxes_met(const GnWideRay* ray, __global const GnWideNode* node, float limit, float8* entries) {
  const uint x = ray->near_side[0], y = ray->near_side[1], z = ray->near_side[2];
  const float8 near_x = (GN_PLANES(node, x) - ray->origin[0]) * ray->inverse[0];
  const float8 near_y = (GN_PLANES(node, y) - ray->origin[1]) * ray->inverse[1];
  const float8 near_z = (GN_PLANES(node, z) - ray->origin[2]) * ray->inverse[2];
  const float8 far_x = fma(GN_PLANES(node, x ^ 32u) - ray->origin[0], ray->far_inverse[0], ray->far_margin);
  const float8 far_y = fma(GN_PLANES(node, y ^ 32u) - ray->origin[1], ray->far_inverse[1], ray->far_margin);
  const float8 far_z = fma(GN_PLANES(node, z ^ 32u) - ray->origin[2], ray->far_inverse[2], ray->far_margin);
  float8 near = GN_MAX8(near_x, (float8)ray->tmin);
  float8 far = GN_MIN8(far_x, (float8)limit);
  near = GN_MAX8(near_y, near);
  far = GN_MIN8(far_y, far);
  near = GN_MAX8(near_z, near);
  far = GN_MIN8(far_z, far);
  *entries = near;
  return lanes_not_above(near, far);
}

#if GN_COUNTERS
static inline uint filled_slots(__global const GnWideNode* node) {
  uint i, count = 0u;
  for (i = 0u; i < GN_WIDTH; ++i) count += node->links[i] != GN_NONE;
  return count;
}
#define GN_COUNT_BOXES(node) walk->boxes += filled_slots(node)
#else
#define GN_COUNT_BOXES(node)
#endif

static inline void walk_closest(GnWideWalk* walk, const GnWideRay* ray, __global const GnWideNode* nodes,
                                __global const GnTriangleBlock* blocks) {
  uint links[GN_WIDE_STACK], keys[GN_WIDE_STACK];
  uint height = 0u, current = 0u;
  for (;;) {
    uint met = 1u;
    while (!(current & GN_LEAF_LINK)) {
      __global const GnWideNode* node = nodes + current;
      float8 entries;
      GN_COUNT_BOXES(node);
      met = boxes_met(ray, node, walk->limit, &entries);
      if (met == 0u) break;
      if ((met & (met - 1u)) == 0u) {
        current = node->links[lowest_bit(met)];
      } else {
        const uint count = popcount(met);
        current = put_by_distance(GN_MAX8(entries, (float8)0.0f), met, node->links, count, keys + height,
                                  links + height);
        height += count - 1u;
      }
    }
    if (met != 0u) test_wide_leaf(walk, ray, blocks, current, 0);
    // The next waiting node that is not beyond the best hit found since it was pushed.
    do {
      if (height == 0u) return;
      height -= 1u;
    } while (as_float(keys[height] & ~7u) > fmax(walk->limit, 0.0f));
    current = links[height];
  }
}

static inline void walk_any(GnWideWalk* walk, const GnWideRay* ray, __global const GnWideNode* nodes,
                            __global const GnTriangleBlock* blocks) {
  uint links[GN_WIDE_STACK];
  uint height = 0u, current = 0u;
  for (;;) {
    uint met = 1u;
    while (!(current & GN_LEAF_LINK)) {
      __global const GnWideNode* node = nodes + current;
      float8 entries;
      uint largest;
      GN_COUNT_BOXES(node);
      met = boxes_met(ray, node, walk->limit, &entries);
      if (met == 0u) break;
      largest = highest_bit(met);
      current = node->links[largest];
      met ^= 1u << largest;
      if (met != 0u) {
        put_in_order(met, node->links, links + height);
        height += popcount(met);
      }
      met = 1u;
    }
    if (met != 0u && test_wide_leaf(walk, ray, blocks, current, 1)) return;
    if (height == 0u) return;
    height -= 1u;
    current = links[height];
  }
}

static inline GnWideWalk start_walk(const GnRay* ray) {
  GnWideWalk walk;
  walk.best.t = INFINITY;
  walk.best.u = 0.0f;
  walk.best.v = 0.0f;
  walk.best.primitive = GN_NONE;
  walk.nearest = INFINITY;
  walk.farthest = INFINITY;
  walk.limit = limit_for(ray->tmax);
  walk.found = 0u;
  walk.pending = 0u;
  walk.pending_lane = 0u;
  walk.pending_block = 0;
  walk.boxes = 0u;
  walk.triangles = 0u;
  return walk;
}

static inline void store_counters(__global GnRayCounters* counters, uint index, const GnWideWalk* walk) {
#if GN_COUNTERS
  counters[index].boxes = walk->boxes;
  counters[index].triangles = walk->triangles;
#endif
}

static inline void trace_one_closest(__global const GnWideNode* nodes, __global const GnTriangleBlock* blocks,
                                     __global const float8* rays, __global float4* hits,
                                     volatile __global uint* invalid_rays, __global GnRayCounters* counters,
                                     uint index) {
  const GnRay ray = load_ray(rays, index);
  GnWideWalk walk = start_walk(&ray);
  if (gn_ray_is_valid(&ray)) {
    const GnWideRay wide = wide_ray(&ray);
    walk_closest(&walk, &wide, nodes, blocks);
    settle(&walk, &wide);
  } else {
    atomic_inc(invalid_rays);
  }
  hits[index] = (float4)(walk.best.t, walk.best.u, walk.best.v, as_float(walk.best.primitive));
  store_counters(counters, index, &walk);
}

static inline void trace_one_any(__global const GnWideNode* nodes, __global const GnTriangleBlock* blocks,
                                 __global const float8* rays, __global uint* occluded,
                                 volatile __global uint* invalid_rays, __global GnRayCounters* counters, uint index) {
  const GnRay ray = load_ray(rays, index);
  GnWideWalk walk = start_walk(&ray);
  if (gn_ray_is_valid(&ray)) {
    const GnWideRay wide = wide_ray(&ray);
    walk_any(&walk, &wide, nodes, blocks);
  } else {
    atomic_inc(invalid_rays);
  }
  occluded[index] = walk.found;
  store_counters(counters, index, &walk);
}

#endif
