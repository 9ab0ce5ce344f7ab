// The first pass of a build: triangles become boxes, and each chunk's bounds are gathered. Feeds the level loop.
#include "triangle_box.h"

// One work-group per chunk of chunk_size triangles. bounds receives two entries per chunk: union of boxes, and bounds
// of doubled centroids. first_bad receives the lowest index of a triangle with a coordinate that is not finite or
// out of range (GN_NONE when all are fine).
__kernel void prepare_primitives(__global const float* triangles, __global float8* primitives,
                                 __global GnBounds* bounds, volatile __global uint* first_bad, uint count,
                                 uint chunk_size) {
  __local int keys[6];
  const uint chunk = (uint)get_group_id(0);
  const uint begin = chunk * chunk_size;
  const uint end = min(count, begin + chunk_size);
  GnBoxPair boxes = empty_pair(), centroids = empty_pair();
  uint i;
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const float3 a = vload3(3u * (size_t)i, triangles);
    const float3 b = vload3(3u * (size_t)i + 1u, triangles);
    const float3 c = vload3(3u * (size_t)i + 2u, triangles);
    const GnBoxPair box = box_of_corners(a, b, c);
    const float4 hi4 = box.hi;
    const float4 lo4 = (float4)(box.lo.xyz, float_with_index(i));
    if (!is_traceable(a) || !is_traceable(b) || !is_traceable(c)) atomic_min(first_bad, i);
    // In two halves: oclgrind 21.10 does not survive a vector of eight made of two.
    vstore4(lo4, 0, (__global float*)(primitives + i));
    vstore4(hi4, 1, (__global float*)(primitives + i));
    boxes.lo = GN_VMIN(lo4, boxes.lo);
    boxes.hi = GN_VMAX(hi4, boxes.hi);
    centroids.lo = GN_VMIN(lo4 + hi4, centroids.lo);
    centroids.hi = GN_VMAX(lo4 + hi4, centroids.hi);
  }
  boxes = group_union(boxes, keys);
  centroids = group_union(centroids, keys);
  if (GN_LOCAL_ID == 0u) {
    store_bounds(bounds + 2u * chunk, boxes);
    store_bounds(bounds + 2u * chunk + 1u, centroids);
  }
}

// The same of primitives that are there already: parts of triangles.
__kernel void bound_primitives(__global const float8* primitives, __global GnBounds* bounds, uint count,
                               uint chunk_size) {
  __local int keys[6];
  const uint chunk = (uint)get_group_id(0);
  const uint begin = chunk * chunk_size;
  const uint end = min(count, begin + chunk_size);
  GnBoxPair boxes = empty_pair(), centroids = empty_pair();
  uint i;
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const float4 lo = (float4)(vload3(0, (__global const float*)(primitives + i)), 0.0f);
    const float4 hi = vload4(1, (__global const float*)(primitives + i));
    boxes.lo = GN_VMIN(lo, boxes.lo);
    boxes.hi = GN_VMAX(hi, boxes.hi);
    centroids.lo = GN_VMIN(lo + hi, centroids.lo);
    centroids.hi = GN_VMAX(lo + hi, centroids.hi);
  }
  boxes = group_union(boxes, keys);
  centroids = group_union(centroids, keys);
  if (GN_LOCAL_ID == 0u) {
    store_bounds(bounds + 2u * chunk, boxes);
    store_bounds(bounds + 2u * chunk + 1u, centroids);
  }
}
