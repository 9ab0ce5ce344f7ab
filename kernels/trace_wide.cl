// Batched ray tracing over the wide tree, eight boxes or eight triangles a step: the flavour for CPUs. A work-item traces
// a run of rays one after the other, in a work-group of its own: compilers that loop over a group's work-items give
// each its own copy of everything private, which then leaves the cache. Closest hit visits children by distance, any
// hit the largest first. Hits are those of trace.cl, bit for bit.
// Options: GN_WIDE_STACK (at least 7 * depth of the wide tree + 8), GN_COUNTERS, GN_RAYS_PER_ITEM, GN_PORTABLE (eight.h).
#include "shared/hit_math.h"
#include "shared/wide_layout.h"
#include "eight.h"
#include "load_ray.h"

// Keeps rare work from taking registers from the loop around it.
#define GN_OUT_OF_LINE __attribute__((noinline))

#ifndef GN_WIDE_STACK
#define GN_WIDE_STACK 256
#endif
#ifndef GN_COUNTERS
#define GN_COUNTERS 0
#endif
#ifndef GN_RAYS_PER_ITEM
#define GN_RAYS_PER_ITEM 64
#endif

typedef struct GnWideRay {
  GnRayFrame frame;
  float8 origin[3];
  float8 inverse[3];
  float8 far_inverse[3];  // a little larger: far sides are never taken for nearer than they are
  uint near_side[3];      // byte offset of the planes met first, per axis
  float8 far_margin;      // added to far sides: 0 unless tmin is negative
  float tmin;
  float tmax;
} GnWideRay;

// The nearest hit so far lies between nearest and farthest. Floats found it (pending), and which triangle it is is all
// that counts until another comes as near or the walk ends; or best is exact, and both are its t.
typedef struct GnWideWalk {
  GnHit best;
  float nearest;
  float farthest;
  float limit;  // of box entries still of interest
  uint found;
  uint pending;
  uint pending_lane;
  __global const GnTriangleBlock* pending_block;
  uint boxes;
  uint triangles;
} GnWideWalk;

static inline GnWideRay wide_ray(const GnRay* ray) {
  GnWideRay out;
  uint k;
  out.frame = gn_ray_frame(ray);
  for (k = 0u; k < 3u; ++k) {
    const uint backwards = out.frame.inverse[k] < 0.0f;
    out.origin[k] = (float8)(ray->origin[k]);
    out.inverse[k] = (float8)(out.frame.inverse[k]);
    out.far_inverse[k] = (float8)(gn_slab_limit(gn_abs(out.frame.inverse[k])) * (backwards ? -1.0f : 1.0f));
    out.near_side[k] = 64u * k + 32u * backwards;
  }
  // The larger reciprocal makes a negative distance too small; those that matter are no less than tmin.
  out.far_margin = (float8)(ray->tmin < 0.0f ? -4.0f * GN_SLAB_SLACK * ray->tmin : 0.0f);
  out.tmin = ray->tmin;
  out.tmax = ray->tmax;
  return out;
}

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

// Below infinity, where empty slots begin and gn_box_entry puts boxes that are missed: a tmin of -infinity makes far
// sides bound nothing.
static inline float limit_for(float t) { return gn_min(gn_slab_limit(t), FLT_MAX); }

static inline void take_exact(GnWideWalk* walk, const GnHit* hit) {
  walk->best = *hit;
  walk->found = 1u;
  walk->pending = 0u;
  walk->nearest = hit->t;
  walk->farthest = hit->t;
  walk->limit = limit_for(hit->t);
}

// Decides a lane of a block exactly.
static GN_OUT_OF_LINE int resolve(const GnRayFrame* frame, __global const GnTriangleBlock* block, uint lane,
                                  int verdict, GnHit* hit) {
  float v0[3], v1[3], v2[3];
  uint k;
  for (k = 0u; k < 3u; ++k) {
    v0[k] = block->corners[k][lane];
    v1[k] = block->corners[3u + k][lane];
    v2[k] = block->corners[6u + k][lane];
  }
  hit->primitive = block->primitives[lane];
  return gn_triangle_resolve(frame, v0, v1, v2, verdict, hit);
}

// The exact values of a hit that floats found.
static inline void settle(GnWideWalk* walk, const GnWideRay* ray) {
  GnHit hit;
  if (!walk->pending) return;
  resolve(&ray->frame, walk->pending_block, walk->pending_lane, 1, &hit);
  take_exact(walk, &hit);
}

// A triangle that floats cannot rank, or not even call met.
static GN_OUT_OF_LINE void test_exactly(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block,
                                        uint lane, int verdict) {
  GnHit hit;
  if (!resolve(&ray->frame, block, lane, verdict, &hit)) return;
  if (!(hit.t >= ray->tmin && hit.t <= ray->tmax)) return;
  settle(walk, ray);
  if (!walk->found || gn_hit_is_nearer(&hit, &walk->best)) take_exact(walk, &hit);
}

// A triangle that is met for certain, by floats between nearest and farthest.
static inline void test_met(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block, uint lane,
                            float nearest, float farthest) {
  // False where something overflowed: infinities less themselves and NaN compare with nothing.
  const int known = farthest - nearest < INFINITY;
  if (known && (farthest < ray->tmin || nearest > ray->tmax)) return;
  if (known && walk->found && nearest > walk->farthest) return;
  if (known && nearest >= ray->tmin && farthest <= ray->tmax && (!walk->found || farthest < walk->nearest)) {
    walk->found = 1u;
    walk->pending = 1u;
    walk->pending_block = block;
    walk->pending_lane = lane;
    walk->nearest = nearest;
    walk->farthest = farthest;
    walk->limit = limit_for(farthest);
  } else {
    // An edge function that overflowed to NaN hides from the largest and the smallest: nothing is certain then.
    test_exactly(walk, ray, block, lane, known ? 1 : -1);
  }
}

// Tests the first `count` triangles of a block: gn_triangle_filter and gn_met_at, eight at a time.
static inline void test_block(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block, uint count,
                              int any_hit) {
  const GnRayFrame* frame = &ray->frame;
  __global const float8* c = (__global const float8*)block->corners;
  const uint kx = frame->kx, ky = frame->ky, kz = frame->kz;
  const float ox = frame->origin[kx], oy = frame->origin[ky], oz = frame->origin[kz];
  const float8 az = c[kz] - oz, bz = c[3u + kz] - oz, cz = c[6u + kz] - oz;
  const float8 ax = (c[kx] - ox) - frame->shear_x * az;
  const float8 ay = (c[ky] - oy) - frame->shear_y * az;
  const float8 bx = (c[3u + kx] - ox) - frame->shear_x * bz;
  const float8 by = (c[3u + ky] - oy) - frame->shear_y * bz;
  const float8 cx = (c[6u + kx] - ox) - frame->shear_x * cz;
  const float8 cy = (c[6u + ky] - oy) - frame->shear_y * cz;
  const float8 u = cx * by - cy * bx;
  const float8 v = ax * cy - ay * cx;
  const float8 w = bx * ay - by * ax;
  const float8 z = GN_MAX8(GN_MAX8(fabs(az), fabs(bz)), fabs(cz));
  const float8 px = GN_MAX8(GN_MAX8(fabs(ax), fabs(bx)), fabs(cx));
  const float8 py = GN_MAX8(GN_MAX8(fabs(ay), fabs(by)), fabs(cy));
  const float8 q = GN_MAX8(px, py) + GN_EDGE_SHIFT * z;
  const float8 bound = GN_EDGE_ERROR * q * (q + z) + GN_EDGE_UNDERFLOW;
  const float8 largest = GN_MAX8(GN_MAX8(u, v), w), smallest = GN_MIN8(GN_MIN8(u, v), w);
  uint met = ~(lanes_above(largest, bound) & lanes_above(-bound, smallest)) & (255u >> (8u - count));
  if (met != 0u) {
    const uint inside = lanes_above(smallest, bound) | lanes_above(-bound, largest);
    const float8 share = 1.0f / (u + v + w);
    const float8 spread = GN_MAX8(GN_MAX8(az, bz), cz) - GN_MIN8(GN_MIN8(az, bz), cz);
    const float8 inverse = (float8)frame->inverse[kz];
    const float8 error = ((4.0f * bound * spread + GN_MET_UNDERFLOW) * fabs(share) + GN_SLAB_SLACK * z + GN_MET_UNDERFLOW) *
                             fabs(inverse) +
                         GN_MET_UNDERFLOW;
    const float8 t = (u * az + v * bz + w * cz) * share * inverse;
    float nearest[8], farthest[8];
    vstore8(t - error, 0, nearest);
    vstore8(t + error, 0, farthest);
    do {
      const uint lane = lowest_bit(met);
      if ((inside >> lane) & 1u) {
        test_met(walk, ray, block, lane, nearest[lane], farthest[lane]);
      } else {
        test_exactly(walk, ray, block, lane, -1);
      }
      met &= met - 1u;
    } while (met != 0u && !(any_hit && walk->found));
  }
}

// True when an any-hit walk is over.
static inline int test_wide_leaf(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* blocks,
                                 uint link, int any_hit) {
  uint left = gn_link_triangles(link);
  __global const GnTriangleBlock* block = blocks + gn_link_block(link);
#if GN_COUNTERS
  walk->triangles += left;
#endif
  for (;;) {
    test_block(walk, ray, block, min(left, GN_WIDTH), any_hit);
    if (any_hit && walk->found) return 1;
    if (left <= GN_WIDTH) return 0;
    left -= GN_WIDTH;
    block += 1;
  }
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

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_closest(__global const GnWideNode* nodes, __global const GnTriangleBlock* blocks,
                            __global const float8* rays, __global float4* hits, volatile __global uint* invalid_rays,
                            __global GnRayCounters* counters, uint count) {
  uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  const uint end = gn_run_end(index, count, GN_RAYS_PER_ITEM);
  for (; index < end; ++index) trace_one_closest(nodes, blocks, rays, hits, invalid_rays, counters, index);
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_any(__global const GnWideNode* nodes, __global const GnTriangleBlock* blocks,
                        __global const float8* rays, __global uint* occluded, volatile __global uint* invalid_rays,
                        __global GnRayCounters* counters, uint count) {
  uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  const uint end = gn_run_end(index, count, GN_RAYS_PER_ITEM);
  for (; index < end; ++index) trace_one_any(nodes, blocks, rays, occluded, invalid_rays, counters, index);
}
