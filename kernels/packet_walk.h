// A packet of rays through the wide tree: a node's boxes are tested against the bounds of all rays at once; a child that
// is left is tested against the rays themselves, sixteen at a time, when its turn comes. Closest hit visits children
// by distance, any hit the last slot first.
// Options: GN_WIDE_STACK, GN_COUNTERS, GN_PORTABLE, GN_REGIONS (wide_walk.h). Feeds trace_packet.cl.
#ifndef GNOMON_PACKET_WALK_H
#define GNOMON_PACKET_WALK_H

#include "packet_leaf.h"
#include "wide_walk.h"

// The slots whose boxes any ray of the packet may meet, and the least distance at which one could. With rounding that
// never turns an order around, no ray's own test (rays_in_box) says more.
static inline uint boxes_near_packet(const GnPacket* p, __global const GnWideNode* node, float8* entries) {
  float8 near = (float8)p->tmin_of_all, far = (float8)INFINITY;
  uint k;
  for (k = 0u; k < 3u; ++k) {
    const uint side = p->near_side[k];
    const float8 to_near = GN_PLANES(node, side) - p->near_origin[k];
    const float8 to_far = GN_PLANES(node, side ^ 32u) - p->far_origin[k];
    const float8 near_a = to_near * p->least_inverse[k], near_b = to_near * p->most_inverse[k];
    const float8 far_a = to_far * p->least_inverse[k], far_b = to_far * p->most_inverse[k];
    // NaN (a plane through the origins of rays that run within it) ends up in near_b or far_b and bounds nothing.
    const float8 first = GN_MIN8(near_a, near_b), last = GN_MAX8(far_a, far_b);
    near = GN_MAX8(first, near);
    far = GN_MIN8(last, far);
  }
  far *= 1.0f + GN_SLAB_SLACK;
  far = GN_MIN8(far, (float8)p->limit_of_all);
  *entries = near;
  return lanes_not_above(near, far);
}

// One slot's box: the planes met first, then those met last.
typedef struct GnSlotBox {
  float near[3];
  float far[3];
} GnSlotBox;

static inline GnSlotBox box_of_slot(const GnPacket* p, __global const GnWideNode* node, uint slot) {
  GnSlotBox box;
  uint k;
  for (k = 0u; k < 3u; ++k) {
    box.near[k] = ((__global const float*)((__global const char*)node + p->near_side[k]))[slot];
    box.far[k] = ((__global const float*)((__global const char*)node + (p->near_side[k] ^ 32u)))[slot];
#if GN_FRAME
    box.near[k] -= p->near_side[k] & 32u ? -p->margin : p->margin;
    box.far[k] += p->near_side[k] & 32u ? -p->margin : p->margin;
#endif
  }
  return box;
}

static inline uint rays_in_box(const GnPacket* p, uint g, const GnSlotBox* box) {
  const float16 near_x = (box->near[0] - p->origin[0][g]) * p->inverse[0][g];
  const float16 near_y = (box->near[1] - p->origin[1][g]) * p->inverse[1][g];
  const float16 near_z = (box->near[2] - p->origin[2][g]) * p->inverse[2][g];
  const float16 far_x = (box->far[0] - p->origin[0][g]) * p->inverse[0][g];
  const float16 far_y = (box->far[1] - p->origin[1][g]) * p->inverse[1][g];
  const float16 far_z = (box->far[2] - p->origin[2][g]) * p->inverse[2][g];
  float16 near = GN_MAX8(near_x, p->tmin[g]);
  float16 far = GN_MIN8(far_x, (float16)INFINITY);
  near = GN_MAX8(near_y, near);
  far = GN_MIN8(far_y, far);
  near = GN_MAX8(near_z, near);
  far = GN_MIN8(far_z, far);
  far *= 1.0f + GN_SLAB_SLACK;
  far = GN_MIN8(far, p->limit[g]);
  return lanes_not_above16(near, far) & p->active[g];
}

#if GN_REGIONS
// Those of sixteen rays that are within a region whole.
static inline uint rays_within(const GnPacket* p, uint g, __global const GnRegion* region) {
  const float16 x = p->direction[0][g], y = p->direction[1][g], z = p->direction[2][g], tmin = p->tmin[g];
  const float16 at_x = p->origin[0][g] + tmin * x, at_y = p->origin[1][g] + tmin * y, at_z = p->origin[2][g] + tmin * z;
  const float16 largest = GN_MAX8(GN_MAX8(fabs(x), fabs(y)), fabs(z));
  const float16 far = GN_MAX8(GN_MAX8(fabs(p->origin[0][g]), fabs(p->origin[1][g])), fabs(p->origin[2][g]));
  const float16 reach = far + tmin * largest, none = (float16)(0.0f);  // no tmin is below 0 in a packet
  const float16 margin = GN_AREA_MARGIN * GN_MAX8(reach, (float16)(region->size)), steeper = GN_AREA_SLOPE * largest;
  float16 end = (float16)(INFINITY), length;
  uint k, within = 65535u;
  for (k = 0u; k < 3u; ++k) {
    const float side = p->near_side[k] & 32u ? region->lo[k] : region->hi[k];
    const float16 leaves_at = (side - p->origin[k][g]) * p->inverse[k][g];
    end = GN_MIN8(leaves_at, end);
  }
  end *= end < 0.0f ? (float16)(1.0f - GN_SLAB_SLACK) : (float16)(1.0f + GN_SLAB_SLACK);
  end = GN_MIN8(end, p->tmax[g]);
  length = (end - tmin) * GN_REGION_LONGER;
  for (k = 0u; k < 8u && within != 0u; ++k) {
    const float a = region->planes[0][k], b = region->planes[1][k], c = region->planes[2][k];
    const float16 at = a * at_x + b * at_y + c * at_z + region->planes[3][k] - margin;
    const float16 slope = a * x + b * y + c * z - steeper;
    within &= lanes_not_above16(none, at) & lanes_not_above16(none, at + slope * length);
  }
  return within;
}

// As root_of, for all rays of a packet.
static inline uint root_of_packet(const GnPacket* p, __global const GnRegion* regions, uint count) {
  uint i, g;
  for (i = 0u; i < count; ++i) {
    for (g = 0u; g < p->groups && rays_within(p, g, regions + i) == 65535u; ++g) {
    }
    if (g == p->groups) return regions[i].root;
  }
  return 0u;
}
#define GN_ROOT_OF_PACKET(p, batch) root_of_packet(p, (batch)->regions, (batch)->region_count)
#else
#define GN_ROOT_OF_PACKET(p, batch) 0u
#endif

static inline void walk_packet(GnPacket* p, const GnWideBatch* batch, int any_hit) {
  __global const GnWideNode* nodes = batch->nodes;
  uint places[GN_WIDE_STACK], keys[GN_WIDE_STACK];
  uint height = 0u, current = GN_ROOT_OF_PACKET(p, batch);
  for (;;) {
    float8 entries;
    uint met = boxes_near_packet(p, nodes + current, &entries);
    GN_WORK(p, nodes, 1u);
#if GN_COUNTERS
    p->boxes[GN_GROUPS] += filled_slots(nodes + current);
#endif
    if (met != 0u) {
      const uint count = popcount(met);
      if (any_hit) {
        put_lanes(met, 8u * current, places + height);
      } else {
        put_places(entries, met, count, 8u * current, keys + height, places + height);
      }
      height += count;
    }
    for (;;) {
      __global const GnWideNode* node;
      GnSlotBox box;
      uint link, slot, g, masks[GN_GROUPS], some = 0u;
      if (height == 0u) return;
      height -= 1u;
      if (!any_hit && as_float(keys[height] & ~7u) > p->limit_of_all) continue;
      node = nodes + (places[height] >> 3);
      slot = places[height] & 7u;
      link = node->links[slot];
      box = box_of_slot(p, node, slot);
      if (!(link & GN_LEAF_LINK)) {
        for (g = 0u; g < p->groups; ++g) {
#if GN_COUNTERS
          p->boxes[g] += 1u;
#endif
          if (p->active[g] != 0u) masks[g] = rays_in_box(p, g, &box);
          if (p->active[g] == 0u || masks[g] == 0u) continue;
          some = 1u;
          if (!GN_MEASURED(p)) break;
          GN_WORK(p, alone_nodes, popcount(masks[g]));
        }
        GN_WORK(p, boxes, g < p->groups ? g + 1u : g);
        if (some == 0u) continue;
        current = link;
        break;
      }
      for (g = 0u; g < p->groups; ++g) {
#if GN_COUNTERS
        p->boxes[g] += 1u;
#endif
        masks[g] = rays_in_box(p, g, &box);
        some |= masks[g];
        GN_WORK(p, alone_blocks, popcount(masks[g]));
      }
      GN_WORK(p, boxes, p->groups);
      if (some == 0u) continue;
      test_packet_leaf(p, batch->rays, batch->leaves, link, masks, any_hit);
      if (any_hit) {
        uint left = 0u;
        for (g = 0u; g < p->groups; ++g) left |= p->active[g];
        if (left == 0u) return;
      }
    }
  }
}

#endif
