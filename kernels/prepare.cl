// The first pass of a build: triangles become boxes, and each chunk's bounds are gathered. Feeds the level loop.
#include "group.h"

static inline int is_traceable(float3 v) {
  // Also false for NaN. The limit is kMaxCoordinate: areas times counts stay finite below it.
  return fabs(v.x) <= 0x1p48f && fabs(v.y) <= 0x1p48f && fabs(v.z) <= 0x1p48f;
}

// gn_without_negative_zero on four lanes at once.
static inline float4 without_negative_zeros(float4 v) {
  const uint4 bits = as_uint4(v);
  return as_float4(select(bits, (uint4)(0u), bits == 0x80000000u));
}

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
    const float4 lo = without_negative_zeros((float4)(GN_VMIN(GN_VMIN(a, b), c), 0.0f));
    const float4 hi4 = without_negative_zeros((float4)(GN_VMAX(GN_VMAX(a, b), c), 0.0f));
    const float4 lo4 = (float4)(lo.xyz, as_float(i));
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
