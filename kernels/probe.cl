// Asks the device what the host assumes: sizes and offsets of every shared struct, and that arithmetic is neither
// contracted nor flushed where trees are decided.
#include "shared/hit_math.h"
#include "shared/cost_math.h"
#include "shared/area_math.h"
#include "shared/wide_layout.h"
#include "shared/compact_layout.h"
#include "shared/box_frame.h"

// From a real address: a null pointer need not have the bits of zero.
#define GN_OFFSET(type, member) \
  ((uint)((__global char*)&((__global type*)out)->member - (__global char*)out))

__kernel void probe_layout(__global uint* out) {
  out[0] = sizeof(GnTriangle);
  out[1] = sizeof(GnLeafTriangle);
  out[2] = sizeof(GnPrimitive);
  out[3] = sizeof(GnNode);
  out[4] = sizeof(GnRay);
  out[5] = sizeof(GnHit);
  out[6] = sizeof(GnRayCounters);
  out[7] = sizeof(GnBin);
  out[8] = sizeof(GnSplit);
  out[9] = sizeof(GnTask);
  out[10] = sizeof(GnChunk);
  out[11] = sizeof(GnChildren);
  out[12] = GN_OFFSET(GnLeafTriangle, primitive);
  out[13] = GN_OFFSET(GnNode, hi);
  out[14] = GN_OFFSET(GnRay, direction);
  out[15] = GN_OFFSET(GnTask, buffer);
  out[16] = GN_HAS_FP64;
  out[17] = sizeof(GnWalk);
  out[18] = sizeof(GnArea);
  out[19] = sizeof(GnAreaBox);
  out[20] = sizeof(GnAreaCell);
  out[21] = sizeof(GnAreaCounters);
  out[22] = sizeof(GnAreaWalk);
  out[23] = GN_OFFSET(GnArea, kind);
  out[24] = GN_OFFSET(GnArea, root);
  out[25] = GN_OFFSET(GnAreaWalk, exit);
  out[26] = sizeof(GnWideNode);
  out[27] = sizeof(GnLeaf);
  out[28] = sizeof(GnForest);
  out[29] = sizeof(GnCollapseTask);
  out[30] = GN_OFFSET(GnWideNode, links);
  out[31] = GN_OFFSET(GnLeaf, count);
  out[32] = GN_OFFSET(GnForest, triangles);
  out[33] = GN_OFFSET(GnCollapseTask, largest_leaf);
  out[34] = sizeof(GnCompactNode);
  out[35] = sizeof(GnPackHead);
  out[36] = GN_OFFSET(GnPackHead, least);
  out[37] = sizeof(GnPlainTriangle);
  out[38] = GN_OFFSET(GnCompactNode, planes);
  out[39] = sizeof(GnBoxFrame);
  out[40] = GN_OFFSET(GnBoxFrame, size);
}

// x[i] y[i] z[i] -> products and sums that would differ were they fused, the division-free reciprocal, and bins.
__kernel void probe_arithmetic(__global const float* x, __global const float* y, __global const float* z,
                               __global float* fused, __global float* reciprocal, __global uint* bin) {
  const size_t i = get_global_id(0);
  fused[i] = x[i] * y[i] + z[i];
  reciprocal[i] = gn_reciprocal(gn_abs(x[i]) + 1e-20f);
  bin[i] = gn_bin_of(gn_abs(y[i]), 0.0f, gn_bin_scale(0.0f, gn_abs(y[i]) + gn_abs(z[i]) + 1e-20f, 16u), 16u);
}

// Box entries and triangle hits for rays and boxes or triangles in pairs: the functions traversal is made of.
__kernel void probe_hits(__global const GnRay* rays, __global const GnTriangle* triangles, __global GnHit* hits,
                         __global float* entries) {
  const size_t i = get_global_id(0);
  const GnRay ray = rays[i];
  const GnTriangle triangle = triangles[i];
  const GnRayFrame frame = gn_ray_frame(&ray);
  GnHit hit = {INFINITY, 0.0f, 0.0f, GN_NONE};
  float lo[3], hi[3];
  int k;
  for (k = 0; k < 3; ++k) {
    lo[k] = gn_min(gn_min(triangle.v0[k], triangle.v1[k]), triangle.v2[k]);
    hi[k] = gn_max(gn_max(triangle.v0[k], triangle.v1[k]), triangle.v2[k]);
  }
  if (gn_triangle_hit(&frame, triangle.v0, triangle.v1, triangle.v2, &hit)) hit.primitive = (uint)i;
  hits[i] = hit;
  entries[i] = gn_box_entry(&frame, lo, hi, ray.tmin, gn_slab_limit(ray.tmax));
}

// Whether rays start in areas, are meant for them and where they leave, in pairs.
__kernel void probe_areas(__global const GnRay* rays, __global const GnArea* areas, __global uint* contains,
                          __global uint* affine, __global float* exits) {
  const size_t i = get_global_id(0);
  const GnRay ray = rays[i];
  const GnArea area = areas[i];
  const GnRayStart start = gn_ray_start(&ray);
  contains[i] = gn_area_contains(&area, &start) ? 1u : 0u;
  affine[i] = gn_area_is_affine(&area, &start) ? 1u : 0u;
  exits[i] = contains[i] ? gn_area_exit(&area, &start) : -INFINITY;
}
