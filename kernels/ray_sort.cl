// A batch of rays put in order (ray_key.h), and answers put back in the caller's order.
// Not for sorting keys (radix_sort.cl). One work-item per ray.
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
