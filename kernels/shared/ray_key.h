// Where a ray belongs when a batch is sorted, for both compilers: first by its origin's cell, cells in Morton order, then
// by the octant it goes to. Rays that follow each other then find nodes and triangles in the cache. Finer cells and finer
// directions were tried and gain less than they cost to sort (host/notes/ray-sorting.md). Feeds ray_sort.cl.
#ifndef GNOMON_SHARED_RAY_KEY_H
#define GNOMON_SHARED_RAY_KEY_H

#include "fast_math.h"

// Five bits an axis and one for each sign: two passes of nine bits, whose 512 counters stay in a CPU's nearest cache.
#define GN_RAY_KEY_BITS 18u
#define GN_RAY_CELLS 32u

// The cell of a coordinate; origins outside the scene, infinite or NaN go to its edge.
GN_INLINE gn_u32 gn_ray_cell(gn_f32 x, gn_f32 lo, gn_f32 scale) {
  const gn_f32 cell = (x - lo) * scale;
  return cell > 0.0f ? cell < (gn_f32)GN_RAY_CELLS ? (gn_u32)cell : GN_RAY_CELLS - 1u : 0u;
}

// scale: cells per unit.
GN_INLINE gn_u32 gn_ray_key(const gn_f32* lo, gn_f32 scale, const gn_f32* origin, const gn_f32* direction) {
  const gn_u32 cell = gn_spread_bits(gn_ray_cell(origin[0], lo[0], scale)) << 2 |
                      gn_spread_bits(gn_ray_cell(origin[1], lo[1], scale)) << 1 |
                      gn_spread_bits(gn_ray_cell(origin[2], lo[2], scale));
  return cell << 3 | (direction[0] < 0.0f ? 4u : 0u) | (direction[1] < 0.0f ? 2u : 0u) | (direction[2] < 0.0f ? 1u : 0u);
}

#endif
