// Batched ray tracing over the wide tree: in packets of 64 or 16 where consecutive rays run together, one by one
// where they do not. Hits are those of the other flavours, bit for bit. A work-item has a work-group of its own, as in
// trace_wide.cl.
// Options: those of wide_walk.h, GN_RAYS_PER_ITEM, GN_CHOOSE (packet_choice.h).
#include "packet_walk.h"

#ifndef GN_RAYS_PER_ITEM
#define GN_RAYS_PER_ITEM 64
#endif

static inline void write_packet(GnPacket* p, GnFound* found, __global const uint* leaves,
                                __global const float8* rays, __global float4* hits) {
  uint i;
  for (i = 0u; i < 16u * p->groups; ++i) {
    const uint g = i >> 4, bit = 1u << (i & 15u), index = p->first + i;
    if (p->pending[g] & bit) {
      const uint seat = ((const uint*)p->seat)[i];
#if GN_FAST
      hits[index] = (float4)(((const float*)p->nearest)[i], ((const float*)p->hit_u)[i], ((const float*)p->hit_v)[i],
                             as_float(gn_number_at(leaves, seat)));
#else
      hand_in(found, index, seat, leaves, rays, hits);
#endif
    } else if (p->found[g] & bit) {
      hits[index] = (float4)(p->best[i].t, p->best[i].u, p->best[i].v, as_float(p->best[i].primitive));
    } else {
      hits[index] = (float4)(INFINITY, 0.0f, 0.0f, as_float(GN_NONE));
    }
  }
}

#if GN_FRAME
#define GN_FRAME_OF_PACKET(packet) packet.frame = *boxes;
#else
#define GN_FRAME_OF_PACKET(packet)
#endif

static inline void reset_counters(GnPacket* p) {
#if GN_COUNTERS
  uint g;
  for (g = 0u; g <= GN_GROUPS; ++g) p->boxes[g] = 0u;
  for (g = 0u; g < GN_GROUPS; ++g) p->triangles[g] = 0u;
#endif
}

// Work done for all rays at once counts as the first's.
static inline void store_packet_counters(const GnPacket* p, __global GnRayCounters* counters) {
#if GN_COUNTERS
  uint i;
  for (i = 0u; i < 16u * p->groups; ++i) {
    counters[p->first + i].boxes = p->boxes[i >> 4] + (i == 0u ? p->boxes[GN_GROUPS] : 0u);
    counters[p->first + i].triangles = p->triangles[i >> 4];
  }
#endif
}

// How many groups of sixteen from ray `index` on make a packet; 0: none.
static inline uint packet_from(GnPacket* p, __global const float8* rays, uint index, uint left, float size) {
  reset_counters(p);
  if (left >= GN_PACKET && start_packet(p, rays, index, GN_GROUPS, size)) return GN_GROUPS;
  if (left >= 16u && start_packet(p, rays, index, 1u, size)) return 1u;
  return 0u;
}

// The first packet from ray `index` on: returns its groups and leaves in *start where it begins; 0 groups: none, *start is
// end.
static inline uint next_packet(GnPacket* p, GnChoice* choice, __global const float8* rays, uint index, uint end, float size,
                               uint* start) {
  uint groups = 0u;
  while (index < end && !choice->alone) {
    groups = packet_from(p, rays, index, end - index, size);
    if (groups > 0u) break;
    index = gn_run_end(index, end, rays_to_pass(choice));
  }
  *start = groups > 0u ? index : end;
  return groups;
}

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_closest(__global const GnWideNode* nodes, __global const uint* leaves,
                            __global const float8* rays, __global float4* hits, volatile __global uint* invalid_rays,
                            __global GnRayCounters* counters, uint count GN_MORE_PARAMETERS) {
  uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  const uint end = gn_run_end(index, count, GN_RAYS_PER_ITEM);
  const float size = GN_SCENE_SIZE(nodes);
  GnPacket packet;
  GnFound found;
  GnChoice choice = {0u, 1u, 0u};  // for closest hits packets pay wherever there are any (host/notes/packets.md)
  const GnWideBatch batch = {nodes, leaves, rays, hits, 0, invalid_rays, counters, &found GN_MORE_OF_BATCH};
  GN_FRAME_OF_PACKET(packet)
  found.count = 0u;
  while (index < end) {
    uint start;
    const uint groups = next_packet(&packet, &choice, rays, index, end, size, &start);
    trace_singly(&batch, index, start, 0);
    if (groups == 0u) break;
    begin_choice(&packet.work, &choice);
    expect_range(rays + start + 16u * groups, GN_PACKET * sizeof(float8));  // those of the next
    walk_packet(&packet, &batch, 0);
    write_packet(&packet, &found, leaves, rays, hits);
    store_packet_counters(&packet, counters);
    index = start + 16u * groups;
  }
  if (found.count > 0u) settle_found(&found, leaves, rays, hits);
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_any(__global const GnWideNode* nodes, __global const uint* leaves,
                        __global const float8* rays, __global uint* occluded, volatile __global uint* invalid_rays,
                        __global GnRayCounters* counters, uint count GN_MORE_PARAMETERS) {
  uint index = (uint)get_global_id(0) * GN_RAYS_PER_ITEM;
  const uint end = gn_run_end(index, count, GN_RAYS_PER_ITEM);
  const float size = GN_SCENE_SIZE(nodes);
  const GnWideBatch batch = {nodes, leaves, rays, 0, occluded, invalid_rays, counters, 0 GN_MORE_OF_BATCH};
  GnPacket packet;
  GnChoice choice = {0u, 0u, 0u};
  GN_FRAME_OF_PACKET(packet)
  while (index < end) {
    uint start, i;
    const uint groups = next_packet(&packet, &choice, rays, index, end, size, &start);
    trace_singly(&batch, index, start, 1);
    if (groups == 0u) break;
    begin_choice(&packet.work, &choice);
    expect_range(rays + start + 16u * groups, GN_PACKET * sizeof(float8));  // those of the next
    walk_packet(&packet, &batch, 1);
    choose(&packet.work, 16u * groups, &choice);
    for (i = 0u; i < 16u * groups; ++i) occluded[start + i] = (packet.found[i >> 4] >> (i & 15u)) & 1u;
    store_packet_counters(&packet, counters);
    index = start + 16u * groups;
  }
}
