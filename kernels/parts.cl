// Triangles into parts (shared/parts_math.h): weighs what their boxes waste, counts the parts, writes them as primitives
// that a builder sorts. One work-item per triangle, or per run of triangles where it adds up.
#include "shared/parts_math.h"
#include "triangle_box.h"

static inline void load_cut(__global const float* triangles, uint triangle, GnCut* cut) {
  __global const float* at = triangles + 9u * (size_t)triangle;
  int i, k;
  for (i = 0; i < 3; ++i) {
    for (k = 0; k < 3; ++k) cut->corner[i][k] = gn_without_negative_zero(at[3 * i + k]);
  }
}

// The box of a primitive, as a part not to be divided.
static inline void load_part(__global const float8* primitives, uint i, GnPart* part) {
  __global const float* at = (__global const float*)(primitives + i);
  int k;
  for (k = 0; k < 3; ++k) {
    part->lo[k] = at[k];
    part->hi[k] = at[4 + k];
  }
  part->splits = part->pad = 0u;
}

static inline void store_part(__global float8* primitives, uint i, const GnPart* part, uint triangle) {
  __global float* out = (__global float*)(primitives + i);
  vstore4((float4)(part->lo[0], part->lo[1], part->lo[2], float_with_index(triangle)), 0, out);
  vstore4((float4)(part->hi[0], part->hi[1], part->hi[2], 0.0f), 1, out);
}

// How much a triangle's box wastes.
static inline float waste_of(__global const float* triangles, __global const float8* primitives, uint i) {
  GnCut cut;
  GnPart part;
  load_cut(triangles, i, &cut);
  load_part(primitives, i, &part);
  return gn_wasted_area(&cut, part.lo, part.hi);
}

// One work-item per run. wastes: receives each triangle's bin. bins: how many are in each.
__kernel void weigh_waste(__global const float* triangles, __global const float8* primitives, __global ushort* wastes,
                          volatile __global uint* bins, uint count, uint run) {
  const uint begin = (uint)get_global_id(0) * run;
  uint i;
  for (i = begin; i < count && i < begin + run; ++i) {
    const uint bin = gn_waste_bin(waste_of(triangles, primitives, i));
    wastes[i] = (ushort)bin;
    atomic_inc(bins + bin);
  }
}

static inline void start_parts(__global const float* triangles, __global const float8* primitives, uint i, uint splits,
                               GnCut* cut, GnPart* parts) {
  load_cut(triangles, i, cut);
  load_part(primitives, i, parts);
  parts[0].splits = splits;
}

// One work-item per run. counts: receives how many parts each triangle has.
__kernel void count_parts(__global const float* triangles, __global const float8* primitives,
                          __global const GnPlaneGrid* grid_in, __global const ushort* wastes, __global uint* counts,
                          uint count, uint run) {
  const GnPlaneGrid grid = *grid_in;
  const uint begin = (uint)get_global_id(0) * run;
  GnCut cut;
  GnPart parts[GN_MOST_PARTS], one;
  uint i;
  for (i = begin; i < count && i < begin + run; ++i) {
    uint found = 1u;
    if (wastes[i] >= grid.floor) {
      uint height = 1u;
      start_parts(triangles, primitives, i, gn_splits_of(wastes[i], grid.floor), &cut, parts);
      found = 0u;
      while (gn_next_part(&grid, &cut, parts, &height, &one)) found += 1u;
    }
    counts[i] = found;
  }
}

// One work-item per run. first: where each triangle's parts begin.
__kernel void write_parts(__global const float* triangles, __global const float8* primitives,
                          __global const GnPlaneGrid* grid_in, __global const ushort* wastes, __global const uint* first,
                          __global float8* out, uint count, uint run) {
  const GnPlaneGrid grid = *grid_in;
  const uint begin = (uint)get_global_id(0) * run;
  GnCut cut;
  GnPart parts[GN_MOST_PARTS], one;
  uint i;
  for (i = begin; i < count && i < begin + run; ++i) {
    uint at = first[i];
    if (wastes[i] >= grid.floor) {
      uint height = 1u;
      start_parts(triangles, primitives, i, gn_splits_of(wastes[i], grid.floor), &cut, parts);
      while (gn_next_part(&grid, &cut, parts, &height, &one)) {
        store_part(out, at, &one, i);
        at += 1u;
      }
    } else {
      __global const float* whole = (__global const float*)(primitives + i);
      vstore4(vload4(0, whole), 0, (__global float*)(out + at));
      vstore4(vload4(1, whole), 1, (__global float*)(out + at));
    }
  }
}
