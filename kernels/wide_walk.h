// Rays through the wide tree one by one, eight boxes or eight triangles a step. Closest hit visits children by distance, any
// hit the last slot first. Hits are those of trace.cl, bit for bit.
// A step is short and ends with the next node's address, which nothing can foresee: a processor would wait for memory and
// for branches it guessed wrong. So several rays take steps by turns, first all that look at a node, then all that look at
// a leaf: while one's node is on its way from memory, others compute; steps of different rays, which do not depend on each
// other, run side by side; and neither what a ray looks at next nor whether it is done decides a branch.
// Options: GN_WIDE_STACK (at least 7 * depth of the wide tree + 9), GN_COUNTERS, GN_PORTABLE (eight.h), GN_RAYS_AT_ONCE
// (1: one after the other, each in a loop of its own, for devices that end long loops), GN_FRAME (wide_leaf.h), GN_REGIONS
// (1: rays within a region whole begin at the root of its tree; not beside GN_FRAME).
// Feeds trace_wide.cl, trace_packet.cl.
#ifndef GNOMON_WIDE_WALK_H
#define GNOMON_WIDE_WALK_H

#ifndef GN_REGIONS
#define GN_REGIONS 0
#endif

#include "ahead.h"
#include "settle.h"
#if GN_REGIONS
#include "within.h"
#endif

#ifndef GN_WIDE_STACK
#define GN_WIDE_STACK 256
#endif
#ifndef GN_RAYS_AT_ONCE
#define GN_RAYS_AT_ONCE 1
#endif

// Whether what floats found is handed in, to be worked out eight rays at once (settle.h).
#define GN_HAND_IN (GN_HAS_FP64 && !GN_FAST)

#define GN_PLANES(node, offset) (*(__global const float8*)((__global const char*)(node) + (offset)))

// The slots whose boxes the ray may meet within [tmin, limit], and where it enters them.
static inline uint boxes_met(const GnWideRay* ray, __global const GnWideNode* node, float limit, float8* entries) {
  const uint x = ray->near_side[0], y = ray->near_side[1], z = ray->near_side[2];
  const float8 near_x = (GN_PLANES(node, x) - ray->origin[0]) * ray->inverse[0];
  const float8 near_y = (GN_PLANES(node, y) - ray->origin[1]) * ray->inverse[1];
  const float8 near_z = (GN_PLANES(node, z) - ray->origin[2]) * ray->inverse[2];
  const float8 margin = (float8)(ray->far_margin);
  const float8 far_x = fma(GN_PLANES(node, x ^ 32u) - GN_FAR_ORIGIN(ray, 0), (float8)(ray->far_inverse[0]), margin);
  const float8 far_y = fma(GN_PLANES(node, y ^ 32u) - GN_FAR_ORIGIN(ray, 1), (float8)(ray->far_inverse[1]), margin);
  const float8 far_z = fma(GN_PLANES(node, z ^ 32u) - GN_FAR_ORIGIN(ray, 2), (float8)(ray->far_inverse[2]), margin);
  float8 near = GN_MAX8(near_x, (float8)ray->tmin);
  float8 far = GN_MIN8(far_x, (float8)limit);
  near = GN_MAX8(near_y, near);
  far = GN_MIN8(far_y, far);
  near = GN_MAX8(near_z, near);
  far = GN_MIN8(far_z, far);
  *entries = near;
  return lanes_not_above(near, far);
}

#if GN_COUNTERS
static inline uint filled_slots(__global const GnWideNode* node) {
  uint i, count = 0u;
  for (i = 0u; i < GN_WIDTH; ++i) count += node->links[i] != GN_NONE;
  return count;
}
#define GN_COUNT_BOXES(node) walk->boxes += filled_slots(node)
#else
#define GN_COUNT_BOXES(node)
#endif

static inline GnWideWalk start_walk(const GnRay* ray) {
  GnWideWalk walk;
  walk.best.t = INFINITY;
  walk.best.u = 0.0f;
  walk.best.v = 0.0f;
  walk.best.primitive = GN_NONE;
  walk.nearest = INFINITY;
  walk.farthest = INFINITY;
  walk.limit = limit_for(ray->tmax);
  walk.found = 0u;
  walk.pending = 0u;
  walk.seat = 0u;
  walk.boxes = 0u;
  walk.triangles = 0u;
  return walk;
}

// A ray on its way: the node or leaf it looks at next, GN_NONE when it is done, and those that wait, with where it enters
// them. At the bottom lies GN_NONE, so that taking the next is no question.
typedef struct GnWalker {
  GnWideRay ray;
  GnWideWalk walk;
  uint index;
  uint current;
  uint height;
  uint links[GN_WIDE_STACK];
  uint keys[GN_WIDE_STACK];
} GnWalker;

// What a batch is traced against, and where answers go: hits, or occluded for any hit.
typedef struct GnWideBatch {
  __global const GnWideNode* nodes;
  __global const uint* leaves;
  __global const float8* rays;
  __global float4* hits;
  __global uint* occluded;
  volatile __global uint* invalid_rays;
  __global GnRayCounters* counters;
  GnFound* found;  // hits that are not worked out yet
#if GN_FRAME
  __global const GnBoxFrame* boxes;
#endif
#if GN_REGIONS
  __global const GnRegion* regions;
  uint region_count;
#endif
} GnWideBatch;

// What kernels take beyond the others' parameters for boxes in a frame, or for regions, and put at a batch's end.
#if GN_FRAME
#define GN_MORE_PARAMETERS , __global const GnBoxFrame* boxes
#define GN_MORE_OF_BATCH , boxes
#define GN_TAKE_RAY(out, ray, batch) set_wide_ray(out, ray, (batch)->boxes)
#else
#define GN_TAKE_RAY(out, ray, batch) set_wide_ray(out, ray)
#endif
#if GN_REGIONS
#define GN_MORE_PARAMETERS , __global const GnRegion *regions, uint region_count
#define GN_MORE_OF_BATCH , regions, region_count
#define GN_ROOT_OF(wide_ray, ray, batch) root_of(ray, (wide_ray)->inverse, (batch)->regions, (batch)->region_count)
#else
#define GN_ROOT_OF(wide_ray, ray, batch) 0u
#endif
#ifndef GN_MORE_PARAMETERS
#define GN_MORE_PARAMETERS
#define GN_MORE_OF_BATCH
#endif

// Four cache lines: of a node all, of a leaf what most have.
static inline void send_for(const GnWideBatch* batch, uint link) {
  const int is_leaf = (link & GN_LEAF_LINK) != 0u;
  __global const char* at = is_leaf ? (__global const char*)(batch->leaves + GN_TRIANGLE_WORDS * gn_link_place(link))
                                    : (__global const char*)(batch->nodes + link);
  if (link == GN_NONE) at = (__global const char*)batch->nodes;
  GN_EXPECT(at);
  GN_EXPECT(at + GN_CACHE_LINE);
  GN_EXPECT(at + 2u * GN_CACHE_LINE);
  GN_EXPECT(at + 3u * GN_CACHE_LINE);
}

static inline void take_next(GnWalker* walker, const GnWideBatch* batch, uint height) {
  walker->height = height - 1u;
  walker->current = walker->links[height - 1u];
  send_for(batch, walker->current);
}

#if !GN_EIGHT_AVX512
// Any hit without an instruction for compaction: nodes wait, each with the slots met that have not been looked at in place
// of a key. At the bottom lies the root with one slot, and whatever that is stands for GN_NONE.
static inline void take_last_met(GnWalker* walker, const GnWideBatch* batch) {
  const uint at = walker->height - 1u, slots = walker->keys[at], slot = highest_bit(slots);
  const uint link = batch->nodes[walker->links[at]].links[slot], rest = slots & ~(1u << slot);
  walker->keys[at] = rest;
  walker->height -= rest == 0u;
  walker->current = at == 0u ? GN_NONE : link;
  send_for(batch, walker->current);
}
#endif

// All children met go onto the stack and the nearest, or for any hit the last, comes off again: how many they are decides
// no branch.
static inline void step_node(GnWalker* walker, const GnWideBatch* batch, int any_hit) {
  GnWideWalk* walk = &walker->walk;
  const uint height = walker->height;
  __global const GnWideNode* node = batch->nodes + walker->current;
  float8 entries;
  const uint met = boxes_met(&walker->ray, node, walk->limit, &entries);
  const uint count = popcount(met);
  GN_COUNT_BOXES(node);
  if (any_hit) {
#if GN_EIGHT_AVX512
    put_in_order(met, node->links, walker->links + height);
#else
    walker->links[height] = walker->current;
    walker->keys[height] = met;
    walker->height = height + (met != 0u);
    take_last_met(walker, batch);
    return;
#endif
  } else {
    put_by_distance(GN_MAX8(entries, (float8)0.0f), met, count, node->links, walker->keys + height,
                    walker->links + height);
  }
  take_next(walker, batch, height + count);
}

// A nearer hit leaves nothing waiting that is entered beyond it: then whatever comes off the stack is worth a look.
static inline void step_leaf(GnWalker* walker, const GnWideBatch* batch, int any_hit) {
  const float limit = walker->walk.limit;
  if (test_wide_leaf(&walker->walk, &walker->ray, batch->leaves, walker->current, any_hit)) {
    walker->current = GN_NONE;
    return;
  }
  if (!any_hit && walker->walk.limit < limit) {
    walker->height = keep_near(walker->keys, walker->links, walker->height, walker->walk.limit);
  }
#if !GN_EIGHT_AVX512
  if (any_hit) {
    take_last_met(walker, batch);
    return;
  }
#endif
  take_next(walker, batch, walker->height);
}

static inline void hand_over(GnWalker* walker, const GnWideBatch* batch, int any_hit) {
  const uint index = walker->index;
  const GnHit* best = &walker->walk.best;
  if (any_hit) {
    batch->occluded[index] = walker->walk.found;
  } else if (GN_HAND_IN && walker->walk.pending) {
    hand_in(batch->found, index, walker->walk.seat, batch->leaves, batch->rays, batch->hits);
  } else {
    settle(&walker->walk, &walker->ray, batch->leaves);
    batch->hits[index] = (float4)(best->t, best->u, best->v, as_float(best->primitive));
  }
#if GN_COUNTERS
  batch->counters[index].boxes = walker->walk.boxes;
  batch->counters[index].triangles = walker->walk.triangles;
#endif
}

// Takes up a ray, or hands it over as a miss at once where it is not traceable, and returns 0.
static inline uint take_up(GnWalker* walker, const GnWideBatch* batch, uint index, int any_hit) {
  const GnRay ray = load_ray(batch->rays, index);
  walker->walk = start_walk(&ray);
  walker->index = index;
  walker->current = 0u;
  walker->height = 1u;
  walker->links[0] = any_hit && !GN_EIGHT_AVX512 ? 0u : GN_NONE;
  walker->keys[0] = any_hit && !GN_EIGHT_AVX512 ? 1u : 0u;
  if (gn_ray_is_valid(&ray)) {
    GN_TAKE_RAY(&walker->ray, &ray, batch);
    walker->current = GN_ROOT_OF(&walker->ray, &ray, batch);
    return 1u;
  }
  atomic_inc(batch->invalid_rays);
  hand_over(walker, batch, any_hit);
  return 0u;
}

#if GN_RAYS_AT_ONCE > 1
// Puts a walker at the end of one of three lists: those that look at a node next, those that look at a leaf, and those that
// are done. Without a branch: where a ray goes next cannot be foreseen. Counts are the caller's own variables, so that they
// stay in registers.
static inline void sort_in(uint walker, uint link, uint* at_nodes, uint* nodes, uint* at_leaves, uint* leaves, uint* done,
                           uint* ended) {
  const uint is_node = (link & GN_LEAF_LINK) == 0u, is_done = link == GN_NONE;
  at_nodes[*nodes] = walker;
  *nodes += is_node;
  at_leaves[*leaves] = walker;
  *leaves += 1u - is_node - is_done;
  done[*ended] = walker;
  *ended += is_done;
}
#endif

// Traces rays [index, end).
static inline void trace_singly(const GnWideBatch* batch, uint index, uint end, int any_hit) {
#if GN_RAYS_AT_ONCE > 1
  GnWalker walkers[GN_RAYS_AT_ONCE];
  uint at_nodes[GN_RAYS_AT_ONCE], at_leaves[GN_RAYS_AT_ONCE], done[GN_RAYS_AT_ONCE];
  uint nodes = 0u, leaves = 0u, ended = 0u;
  for (; index < end && nodes < GN_RAYS_AT_ONCE; ++index) {
    at_nodes[nodes] = nodes;
    nodes += take_up(walkers + nodes, batch, index, any_hit);
  }
  while (nodes + leaves > 0u) {
    uint i, count = nodes;
    nodes = 0u;
    for (i = 0u; i < count; ++i) {
      const uint at = at_nodes[i];
      step_node(walkers + at, batch, any_hit);
      sort_in(at, walkers[at].current, at_nodes, &nodes, at_leaves, &leaves, done, &ended);
    }
    count = leaves;
    leaves = 0u;
    for (i = 0u; i < count; ++i) {
      const uint at = at_leaves[i];
      step_leaf(walkers + at, batch, any_hit);
      sort_in(at, walkers[at].current, at_nodes, &nodes, at_leaves, &leaves, done, &ended);
    }
    for (i = 0u; i < ended; ++i) {
      const uint at = done[i];
      uint goes_on = 0u;
      hand_over(walkers + at, batch, any_hit);
      for (; !goes_on && index < end; ++index) goes_on = take_up(walkers + at, batch, index, any_hit);
      at_nodes[nodes] = at;
      nodes += goes_on;
    }
    ended = 0u;
  }
#else
  GnWalker walker;
  for (; index < end; ++index) {
    if (!take_up(&walker, batch, index, any_hit)) continue;
    while (walker.current != GN_NONE) {
      if ((walker.current & GN_LEAF_LINK) != 0u) {
        step_leaf(&walker, batch, any_hit);
      } else {
        step_node(&walker, batch, any_hit);
      }
    }
    hand_over(&walker, batch, any_hit);
  }
#endif
}

#endif
