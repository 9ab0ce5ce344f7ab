// Batched ray tracing over the compact tree, one ray per work-item, for GPUs: a node is five loads of 16 bytes, and of
// a node's children that the ray meets all wait as one entry of the stack. Children are visited in the order of their
// slots, turned by the octant of the ray's direction. A quantised box is made the float box it stands for and tested as
// any other. Options: GN_GROUP_STACK (at least the tree's depth: each level leaves at most one group waiting), GN_COUNTERS
// (walk.h).
// Source: Ylitie, Karras, Laine 2017 (node groups).
#include "shared/compact_layout.h"
#include "shared/hit_math.h"

#ifndef GN_GROUP_STACK
#define GN_GROUP_STACK 32
#endif

typedef GnPackedLeaves GnLeaves;

// index: among all triangles of the node.
static inline GnLeafTriangle leaf_triangle(const GnLeaves* leaves, uint index) {
  const GnPlainTriangle packed = gn_packed_triangle(leaves, index);
  GnLeafTriangle triangle;
  int k;
  for (k = 0; k < 3; ++k) {
    triangle.v0[k] = as_float(packed.corners[k]);
    triangle.v1[k] = as_float(packed.corners[3 + k]);
    triangle.v2[k] = as_float(packed.corners[6 + k]);
  }
  triangle.primitive = packed.number;
  return triangle;
}

#define GN_STATE GnWalk
#define GN_WALK_OF(state) (state)
#include "walk.h"

// Which slots of a node the ray meets, as bits of slot ^ turn: nodes, and leaves shifted by 8.
static inline uint met_slots(GnWalk* walk, const GnRayFrame* frame, float tmin, uint turn, __global const uint* node,
                             uint4 head, uint4 links) {
  const uint4 x = vload4(2, node), y = vload4(3, node), z = vload4(4, node);
  const float scale[3] = {gn_axis_scale(head.w, 0u), gn_axis_scale(head.w, 1u), gn_axis_scale(head.w, 2u)};
  const float origin[3] = {as_float(head.x), as_float(head.y), as_float(head.z)};
  const uint2 near_x = frame->inverse[0] < 0.0f ? x.zw : x.xy, far_x = frame->inverse[0] < 0.0f ? x.xy : x.zw;
  const uint2 near_y = frame->inverse[1] < 0.0f ? y.zw : y.xy, far_y = frame->inverse[1] < 0.0f ? y.xy : y.zw;
  const uint2 near_z = frame->inverse[2] < 0.0f ? z.zw : z.xy, far_z = frame->inverse[2] < 0.0f ? z.xy : z.zw;
  uint met = 0u, slot;
  for (slot = 0u; slot < 8u; ++slot) {
    const uint shift = 8u * (slot & 3u), holds_node = (head.w >> (24u + slot)) & 1u;
    const uint holds_leaf = (((slot < 4u ? links.z : links.w) >> shift) & 255u) != 0u ? 1u : 0u;
    const float near[3] = {gn_plane_at(origin[0], scale[0], ((slot < 4u ? near_x.x : near_x.y) >> shift) & 255u),
                           gn_plane_at(origin[1], scale[1], ((slot < 4u ? near_y.x : near_y.y) >> shift) & 255u),
                           gn_plane_at(origin[2], scale[2], ((slot < 4u ? near_z.x : near_z.y) >> shift) & 255u)};
    const float far[3] = {gn_plane_at(origin[0], scale[0], ((slot < 4u ? far_x.x : far_x.y) >> shift) & 255u),
                          gn_plane_at(origin[1], scale[1], ((slot < 4u ? far_y.x : far_y.y) >> shift) & 255u),
                          gn_plane_at(origin[2], scale[2], ((slot < 4u ? far_z.x : far_z.y) >> shift) & 255u)};
    if (!(holds_node | holds_leaf)) continue;
    walk->boxes += 1u;
    if (gn_planes_entry(frame, near, far, tmin, walk->limit) < INFINITY)
      met |= 1u << ((slot ^ turn) + (holds_node ? 0u : 8u));
  }
  return met;
}

static inline uint highest_bit(uint bits) { return 31u - clz(bits); }

static inline void traverse_compact(GnWalk* walk, const GnRay* ray, __global const uint* nodes,
                                    __global const uint* packed, int any_hit) {
  const GnRayFrame frame = gn_ray_frame(ray);
  // Slots on the lower side of an axis that the ray goes up come first: as the highest bits.
  const uint turn = (frame.inverse[0] < 0.0f ? 0u : 1u) | (frame.inverse[1] < 0.0f ? 0u : 2u) |
                    (frame.inverse[2] < 0.0f ? 0u : 4u);
  // A group: where a node's children that are nodes begin, which slots they have, and which are yet to be visited.
  uint2 waiting[GN_GROUP_STACK];
  uint first = 0u, slots = 1u, visits = 1u << turn, height = 0u;
  for (;;) {
    uint slot, turned, leaves_met, counts[2];
    __global const uint* node;
    uint4 head, links;
    GnLeaves leaves;
    if (visits == 0u) {
      if (height == 0u) return;
      height -= 1u;
      first = waiting[height].x;
      slots = waiting[height].y & 255u;
      visits = waiting[height].y >> 8;
    }
    turned = highest_bit(visits);
    visits ^= 1u << turned;
    slot = turned ^ turn;
    node = nodes + 20u * (size_t)(first + popcount(slots & ((1u << slot) - 1u)));
    if (visits != 0u) {
      waiting[height] = (uint2)(first, (visits << 8) | slots);
      height += 1u;
    }
    head = vload4(0, node);
    links = vload4(1, node);
    visits = met_slots(walk, &frame, ray->tmin, turn, node, head, links);
    leaves_met = visits >> 8;
    visits &= 255u;
    first = links.x;
    slots = head.w >> 24;
    counts[0] = links.z;
    counts[1] = links.w;
    if (leaves_met == 0u) continue;
    gn_open_leaves(packed + links.y, gn_leaf_triangles(counts), &leaves);
    while (leaves_met != 0u) {
      turned = highest_bit(leaves_met);
      leaves_met ^= 1u << turned;
      slot = turned ^ turn;
      test_leaf(walk, &frame, ray, &leaves, gn_bytes_before(counts, slot), gn_byte_of(counts, slot), any_hit);
      if (any_hit && walk->found) return;
    }
  }
}

#define GN_COMPACT_PARAMETERS(answer)                                                                          \
  __global const uint *nodes, __global const uint *packed, __global const float8 *rays, __global answer *answers, \
      volatile __global uint *invalid_rays, __global GnRayCounters *counters, uint count

static inline GnWalk walk_ray(__global const uint* nodes, __global const uint* packed, const GnRay* ray,
                              volatile __global uint* invalid_rays, int any_hit) {
  GnWalk walk = start_walk(ray);
  if (gn_ray_is_valid(ray)) {
    traverse_compact(&walk, ray, nodes, packed, any_hit);
  } else {
    atomic_inc(invalid_rays);
  }
  return walk;
}

static inline void store_counters(__global GnRayCounters* counters, uint index, const GnWalk* walk) {
#if GN_COUNTERS
  counters[index].boxes = walk->boxes;
  counters[index].triangles = walk->triangles;
#endif
}

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_closest(GN_COMPACT_PARAMETERS(float4)) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    const GnWalk walk = walk_ray(nodes, packed, &ray, invalid_rays, 0);
    answers[index] = (float4)(walk.best.t, walk.best.u, walk.best.v, as_float(walk.best.primitive));
    store_counters(counters, index, &walk);
  }
}

// Any hit of rays [0, count): answers receive 1 or 0.
__kernel void trace_any(GN_COMPACT_PARAMETERS(uint)) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = load_ray(rays, index);
    const GnWalk walk = walk_ray(nodes, packed, &ray, invalid_rays, 1);
    answers[index] = walk.found;
    store_counters(counters, index, &walk);
  }
}
