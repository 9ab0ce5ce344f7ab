// A batch of rays put in order (ray_key.h, light_key.h), and answers put back in the caller's order.
// Not for sorting keys (radix_sort.cl). One work-item per ray, but for find_light_keys.
// Options: GN_WGS, of lanes.h.
#include "shared/light_key.h"
#include "shared/ray_key.h"

// keys: the ray's, and its index. scale: cells per unit.
__kernel void find_ray_keys(__global const float8* rays, __global uint2* keys, float lo_x, float lo_y, float lo_z,
                            float scale, uint count) {
  const uint i = (uint)get_global_id(0);
  const float lo[3] = {lo_x, lo_y, lo_z};
  if (i < count) {
    const float8 ray = rays[i];
    const float origin[3] = {ray.s0, ray.s1, ray.s2};
    const float direction[3] = {ray.s4, ray.s5, ray.s6};
    keys[i] = (uint2)(gn_ray_key(lo, scale, origin, direction), i);
  }
}

#if GN_HAS_LANES
#define GN_KEYS_PER_ITEM 4u
#define GN_LANES_OF(a, component) (float4)(a[0].component, a[1].component, a[2].component, a[3].component)
#define GN_LANE(bits, lane) ((const uint*)&(bits))[lane]
#else
#define GN_KEYS_PER_ITEM 1u
#define GN_LANES_OF(a, component) a[0].component
#define GN_LANE(bits, lane) (bits)
#endif

// The same by lights. A work-item takes as many rays as there are lanes.
__kernel void find_light_keys(__global const float8* rays, __global uint2* keys, __global const GnRayLight* lights,
                              uint light_count, float lo_x, float lo_y, float lo_z, float scale, uint count) {
  const uint begin = (uint)get_global_id(0) * GN_KEYS_PER_ITEM;
  const float lo[3] = {lo_x, lo_y, lo_z};
  if (begin < count) {
    const uint left = min(count - begin, GN_KEYS_PER_ITEM);
    float8 some[GN_KEYS_PER_ITEM];
    uint i;
    for (i = 0u; i < GN_KEYS_PER_ITEM; ++i) some[i] = rays[begin + min(i, left - 1u)];
    {
      const gn_lanes origin[3] = {GN_LANES_OF(some, s0), GN_LANES_OF(some, s1), GN_LANES_OF(some, s2)};
      const gn_lanes direction[3] = {GN_LANES_OF(some, s4), GN_LANES_OF(some, s5), GN_LANES_OF(some, s6)};
      const gn_lane_bits found = gn_light_keys(lights, light_count, lo, scale, origin, direction);
      for (i = 0u; i < left; ++i) keys[begin + i] = (uint2)(GN_LANE(found, i), begin + i);
    }
  }
}

__kernel void gather_rays(__global const float8* rays, __global const uint2* keys, __global float8* sorted, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) sorted[i] = rays[keys[i].y];
}

// Answers of one, two and four words.
__kernel void scatter_1(__global const uint* sorted, __global const uint2* keys, __global uint* answers, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) answers[keys[i].y] = sorted[i];
}
__kernel void scatter_2(__global const uint2* sorted, __global const uint2* keys, __global uint2* answers, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) answers[keys[i].y] = sorted[i];
}
__kernel void scatter_4(__global const uint4* sorted, __global const uint2* keys, __global uint4* answers, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) answers[keys[i].y] = sorted[i];
}
