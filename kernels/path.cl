// A path tracer in wavefronts: every kernel does one thing for all paths of a batch, and rays are traced by the
// tracer's own kernels in between. Paths that have ended, and shadow rays that need not be asked, are packed out by a
// stable prefix sum (scan_values of radix_sort.cl), so a batch's order never depends on the device. One work-item per
// path, or per chunk.
// Options: GN_WGS (1: step_paths looks at lights in lanes, lanes.h).
#include "ahead.h"
#include "shared/path_math.h"

// Paths that one item looks ahead: what a ray met lies anywhere.
#define GN_PATHS_AHEAD 8u

#define GN_PATH_TABLES \
  __global const GnPathFrame *frame, __global const GnTriangle *triangles, __global const uint *surface_ids, \
      __global const GnSurface *surfaces, __global const GnPathLight *lights, __global const float *light_rows, \
      __global const GnEmitter *emitters, __global const GnEmitterLink *links

#define GN_COLLECT_TABLES(tables) \
  tables.frame = frame; \
  tables.triangles = triangles; \
  tables.surface_ids = surface_ids; \
  tables.surfaces = surfaces; \
  tables.lights = lights; \
  tables.light_rows = light_rows; \
  tables.emitters = emitters; \
  tables.links = links

// Paths [0, count) of a batch: its cells, one after another, sample after sample.
__kernel void begin_paths(GN_PATH_TABLES, __global GnPath* paths, __global GnRay* rays, __global uint* owners,
                          uint first_cell, uint cells, uint first_sample, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) {
    GnPathTables tables;
    GnPath path;
    GnRay ray;
    GN_COLLECT_TABLES(tables);
    gn_begin_path(&tables, first_cell + i % cells, first_sample + i / cells, &path, &ray);
    paths[i] = path;
    rays[i] = ray;
    owners[i] = i;
  }
}

// owners: the path of each ray. Writes the ray that each path goes on with, and the shadow ray it wants asked. A work-item
// takes `each` paths, one after another.
__kernel void step_paths(GN_PATH_TABLES, __global GnPath* paths, __global const GnRay* rays, __global const GnHit* hits,
                         __global const uint* owners, __global GnRay* next_rays, __global GnRay* shadow_rays,
                         __global GnLit* lit, uint bounce, uint count, uint each) {
  const uint begin = (uint)get_global_id(0) * each;
  GnPathTables tables;
  uint i;
  GN_COLLECT_TABLES(tables);
  for (i = begin; i < begin + each && i < count; ++i) {
    GnPath path = paths[owners[i]];
    const GnRay ray = rays[i];
    const GnHit hit = hits[i];
    const uint ahead = i + GN_PATHS_AHEAD < count && each > 1u ? hits[i + GN_PATHS_AHEAD].primitive : GN_NONE;
    GnRay next, shadow;
    GnLit brought;
    if (ahead != GN_NONE) {
      expect_range((__global const char*)(triangles + ahead), sizeof(GnTriangle));
      GN_EXPECT(surface_ids + ahead);
    }
    brought.radiance[0] = brought.radiance[1] = brought.radiance[2] = 0.0f;
    brought.light = GN_NONE;
    gn_path_step(&tables, &ray, &hit, bounce, &path, &next, &shadow, &brought);
    paths[owners[i]] = path;
    next_rays[i] = next;
    shadow_rays[i] = shadow;
    lit[owners[i]] = brought;
  }
}

// How many rays of each chunk are any.
__kernel void count_rays(__global const GnRay* rays, __global uint* counts, uint count, uint chunk_size) {
  const uint chunk = (uint)get_global_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  uint i, sum = 0u;
  if (begin == end) return;
  for (i = begin; i < end; ++i) sum += rays[i].tmin <= rays[i].tmax ? 1u : 0u;
  counts[chunk] = sum;
}

// Moves those together, and their owners with them. counts: summed up.
__kernel void pack_rays(__global const GnRay* rays, __global const uint* owners, __global const uint* counts,
                        __global GnRay* packed, __global uint* packed_owners, uint count, uint chunk_size) {
  const uint chunk = (uint)get_global_id(0);
  const uint begin = min(count, chunk * chunk_size);
  const uint end = begin + min(count - begin, chunk_size);
  uint i, place;
  if (begin == end) return;
  place = counts[chunk];
  for (i = begin; i < end; ++i) {
    if (rays[i].tmin <= rays[i].tmax) {
      packed[place] = rays[i];
      packed_owners[place] = owners[i];
      place += 1u;
    }
  }
}

// Adds what free shadow rays bring.
__kernel void add_light(__global GnPath* paths, __global const uint* owners, __global const uint* occluded,
                        __global const GnLit* lit, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i < count) {
    const uint owner = owners[i];
    int k;
    if (occluded[i] != 0u) return;
    for (k = 0; k < 3; ++k) paths[owner].radiance[k] = paths[owner].radiance[k] + lit[owner].radiance[k];
  }
}

// Adds a batch's paths to their pixels, in the order of samples. film: radiance, and how many paths met a surface; what
// was there before sample 0 does not count.
__kernel void add_to_film(__global const GnPathFrame* frame, __global const GnPath* paths, __global float4* film,
                          uint first_cell, uint cells, uint first_sample, uint samples) {
  const uint i = (uint)get_global_id(0);
  if (i < cells) {
    const uint pixel = gn_pixel_of(frame, first_cell + i);
    float4 sum = (float4)(0.0f);
    uint s;
    if (pixel == GN_NONE) return;
    if (first_sample != 0u) sum = film[pixel];
    for (s = 0u; s < samples; ++s) {
      __global const GnPath* path = paths + s * cells + i;
      sum.x = sum.x + path->radiance[0];
      sum.y = sum.y + path->radiance[1];
      sum.z = sum.z + path->radiance[2];
      sum.w = sum.w + (path->seen != 0u ? 1.0f : 0.0f);
    }
    film[pixel] = sum;
  }
}
