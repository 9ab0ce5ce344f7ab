// The first passes of the fast builder: the cube of all centroids, and every triangle's place on the Morton curve through
// it. Not for sorting (radix_sort.cl).
#include "shared/fast_math.h"
#include "triangle_box.h"

// One work-group per chunk of chunk_size triangles: bounds of their doubled centroids. first_bad receives the lowest
// index of a triangle with a coordinate that is not finite or out of range (GN_NONE when all are fine).
__kernel void bound_centroids(__global const float* triangles, __global GnBounds* bounds,
                              volatile __global uint* first_bad, uint count, uint chunk_size) {
  __local int keys[6];
  const uint chunk = (uint)get_group_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  GnBoxPair centroids = empty_pair();
  uint i;
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const GnCorners corners = corners_of(triangles, i);
    const GnBoxPair box = box_of_corners(corners.a, corners.b, corners.c);
    if (!is_traceable(corners.a) || !is_traceable(corners.b) || !is_traceable(corners.c)) atomic_min(first_bad, i);
    centroids.lo = GN_VMIN(box.lo + box.hi, centroids.lo);
    centroids.hi = GN_VMAX(box.lo + box.hi, centroids.hi);
  }
  centroids = group_union(centroids, keys);
  if (GN_LOCAL_ID == 0u) store_bounds(bounds + chunk, centroids);
}

// One work-group per chunk. keys are GnMortonKey. The i-th is of triangle i, or (again != 0) of the triangle that stands
// there already. fine: gn_morton_code's.
__kernel void assign_codes(__global const float* triangles, __global uint2* keys, float lo_x, float lo_y, float lo_z,
                           float scale, uint fine, uint again, uint count, uint chunk_size) {
  const uint chunk = (uint)get_group_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  const GnMortonFrame frame = {{lo_x, lo_y, lo_z}, scale};
  uint i;
  for (i = begin + GN_LOCAL_ID; i < end; i += GN_WGS) {
    const uint triangle = again ? keys[i].y : i;
    const GnCorners corners = corners_of(triangles, triangle);
    const GnBoxPair box = box_of_corners(corners.a, corners.b, corners.c);
    const float4 c = box.lo + box.hi;
    keys[i] = (uint2)(gn_morton_code(frame, c.x, c.y, c.z, (int)fine), triangle);
  }
}

// One work-item per whole segment of sorted keys: raises crowded where all its triangles share a cell.
__kernel void find_crowded(__global const uint2* keys, volatile __global uint* crowded, uint segments) {
  const uint segment = (uint)get_global_id(0);
  if (segment >= segments) return;
  __global const uint2* first = keys + GN_SEGMENT * segment;
  if (first[0].x == first[GN_SEGMENT - 1u].x) atomic_max(crowded, 1u);
}
