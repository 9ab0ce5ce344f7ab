// Batched ray tracing over the wide tree, ray by ray: the flavour for CPUs. A work-item traces a run of rays in a work-group
// of its own: compilers that loop over a group's work-items give each its own copy of everything private, which then leaves
// the cache.
// Options: those of wide_walk.h, GN_RAYS_PER_ITEM.
#include "wide_walk.h"

#ifndef GN_RAYS_PER_ITEM
#define GN_RAYS_PER_ITEM 64
#endif

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_closest(__global const GnWideNode* nodes, __global const uint* leaves,
                            __global const float8* rays, __global float4* hits, volatile __global uint* invalid_rays,
                            __global GnRayCounters* counters, uint count GN_MORE_PARAMETERS) {
  const uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  GnFound found;
  const GnWideBatch batch = {nodes, leaves, rays, hits, 0, invalid_rays, counters, &found GN_MORE_OF_BATCH};
  found.count = 0u;
  trace_singly(&batch, index, gn_run_end(index, count, GN_RAYS_PER_ITEM), 0);
  if (found.count > 0u) settle_found(&found, leaves, rays, hits);
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_any(__global const GnWideNode* nodes, __global const uint* leaves,
                        __global const float8* rays, __global uint* occluded, volatile __global uint* invalid_rays,
                        __global GnRayCounters* counters, uint count GN_MORE_PARAMETERS) {
  const uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  const GnWideBatch batch = {nodes, leaves, rays, 0, occluded, invalid_rays, counters, 0 GN_MORE_OF_BATCH};
  trace_singly(&batch, index, gn_run_end(index, count, GN_RAYS_PER_ITEM), 1);
}
