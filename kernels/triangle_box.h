// A caller's triangle as builders load it: whether it can be traced, and its box. Device only. Feeds prepare.cl, the fast
// builder's kernels and refit.cl.
#ifndef GNOMON_TRIANGLE_BOX_H
#define GNOMON_TRIANGLE_BOX_H

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

// Lanes w are 0.
static inline GnBoxPair box_of_corners(float3 a, float3 b, float3 c) {
  GnBoxPair box;
  box.lo = without_negative_zeros((float4)(GN_VMIN(GN_VMIN(a, b), c), 0.0f));
  box.hi = without_negative_zeros((float4)(GN_VMAX(GN_VMAX(a, b), c), 0.0f));
  return box;
}

typedef struct GnCorners {
  float3 a;
  float3 b;
  float3 c;
} GnCorners;

// Three loads of four floats, none of them beyond the nine.
static inline GnCorners corners_of(__global const float* triangles, uint triangle) {
  __global const float* at = triangles + 9u * (size_t)triangle;
  GnCorners corners;
  corners.a = vload4(0, at).xyz;
  corners.b = vload4(0, at + 3).xyz;
  corners.c = vload4(0, at + 5).yzw;
  return corners;
}

#endif
