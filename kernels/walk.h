// One ray's way through a binary tree, nearest child first: what the tracing kernels share. Before this file, the
// including one defines GnLeaves, where leaves find their triangles,
//   static inline GnLeafTriangle leaf_triangle(const GnLeaves* leaves, uint place);
// and GN_STATE, all that a ray must remember between two passes, with GN_WALK_OF(state), the GnWalk* in it.
// Options: GN_STACK_SIZE (at least the deepest tree's depth + 1; each level leaves at most one node waiting, so it
// cannot overflow), GN_COUNTERS (1: write what each ray cost), GN_STEP_LIMIT (0: a ray is traced in one go; more: in
// passes of so many steps, for devices that end long loops, DeviceInfo::loop_limit). Feeds trace.cl, trace_areas.cl.
#ifndef GNOMON_WALK_H
#define GNOMON_WALK_H

#include "load_ray.h"

#ifndef GN_STACK_SIZE
#define GN_STACK_SIZE 96
#endif
#ifndef GN_COUNTERS
#define GN_COUNTERS 0
#endif
#ifndef GN_STEP_LIMIT
#define GN_STEP_LIMIT 0
#endif

// Nodes still to visit, and where the ray enters them. Between passes they wait in global memory, entry h of ray i
// at h * rays + i.
typedef struct GnStack {
#if GN_STEP_LIMIT > 0
  __global uint* nodes;
  __global float* entries;
  uint stride;
#else
  uint nodes[GN_STACK_SIZE];
  float entries[GN_STACK_SIZE];
#endif
} GnStack;
#if GN_STEP_LIMIT > 0
#define GN_STACK_AT(stack, height) ((size_t)(height) * (stack)->stride)
#else
#define GN_STACK_AT(stack, height) (height)
#endif

static inline float entry_of(const GnRayFrame* frame, __global const GnNode* node, float tmin, float limit) {
  const float lo[3] = {node->lo[0], node->lo[1], node->lo[2]};
  const float hi[3] = {node->hi[0], node->hi[1], node->hi[2]};
  return gn_box_entry(frame, lo, hi, tmin, limit);
}

// Tests a leaf's triangles; with any_hit stops at the first.
static inline void test_leaf(GnWalk* walk, const GnRayFrame* frame, const GnRay* ray,
                             const GnLeaves* leaves, uint first, uint count, int any_hit) {
  uint i;
  walk->steps += count;
  for (i = first; i < first + count; ++i) {
    const GnLeafTriangle triangle = leaf_triangle(leaves, i);
    GnHit hit;
    walk->triangles += 1u;
    if (!gn_triangle_hit(frame, triangle.v0, triangle.v1, triangle.v2, &hit)) continue;
    if (!(hit.t >= ray->tmin && hit.t <= ray->tmax)) continue;
    hit.primitive = triangle.primitive;
    if (!walk->found || gn_hit_is_nearer(&hit, &walk->best)) {
      walk->best = hit;
      walk->found = 1u;
      walk->limit = gn_slab_limit(hit.t);
      if (any_hit) return;
    }
  }
}

// Goes on from walk->current, at first from the root, until the ray is done or has used its steps.
static inline void traverse(GnWalk* walk, GnStack* stack, const GnRay* ray, __global const GnNode* nodes, uint root,
                            const GnLeaves* leaves, int any_hit) {
  const GnRayFrame frame = gn_ray_frame(ray);
  uint height = walk->height, current = walk->current;
  if (current == GN_NONE) {
    current = root;
    walk->boxes += 1u;
    if (entry_of(&frame, nodes + root, ray->tmin, walk->limit) == INFINITY) {
      walk->done = 1u;
      return;
    }
  }
  while (GN_STEP_LIMIT == 0 || walk->steps < GN_STEP_LIMIT) {
    const uint first = nodes[current].first, count = nodes[current].count;
    int descend = 0;
    walk->steps += 1u;
    if (count > 0u) {
      test_leaf(walk, &frame, ray, leaves, first, count, any_hit);
      if (any_hit && walk->found) {
        walk->done = 1u;
        return;
      }
    } else {
      const float left = entry_of(&frame, nodes + first, ray->tmin, walk->limit);
      const float right = entry_of(&frame, nodes + first + 1u, ray->tmin, walk->limit);
      const int left_first = left <= right;
      const float far_entry = left_first ? right : left;
      walk->boxes += 2u;
      if (far_entry < INFINITY) {
        stack->nodes[GN_STACK_AT(stack, height)] = left_first ? first + 1u : first;
        stack->entries[GN_STACK_AT(stack, height)] = far_entry;
        height += 1u;
      }
      current = left_first ? first : first + 1u;
      descend = (left_first ? left : right) < INFINITY;
    }
    if (!descend) {
      // The next waiting node that is not beyond the best hit found since it was pushed.
      do {
        if (height == 0u) {
          walk->done = 1u;
          return;
        }
        height -= 1u;
      } while (stack->entries[GN_STACK_AT(stack, height)] > walk->limit);
      current = stack->nodes[GN_STACK_AT(stack, height)];
    }
  }
  walk->height = height;
  walk->current = current;
}

static inline GnWalk start_walk(const GnRay* ray) {
  GnWalk walk;
  walk.best.t = INFINITY;
  walk.best.u = 0.0f;
  walk.best.v = 0.0f;
  walk.best.primitive = GN_NONE;
  walk.limit = gn_slab_limit(ray->tmax);
  walk.found = 0u;
  walk.boxes = 0u;
  walk.triangles = 0u;
  walk.current = GN_NONE;
  walk.height = 0u;
  walk.steps = 0u;
  walk.done = 0u;
  return walk;
}

#if GN_STEP_LIMIT > 0
// What a launch in passes has beyond one in one go: states and waiting nodes to resume, and a count of rays that need
// another pass. The first pass (0) starts every ray.
#define GN_PASS_PARAMETERS                                                                                      \
  , __global GN_STATE *states, __global uint *waiting, __global float *entries, volatile __global uint *paused, \
      uint pass

// Whether the ray has a way to go; *state, fresh from the start in pass 0, is then where it stands.
static inline int resume(GN_STATE* state, GnStack* stack, __global const GN_STATE* states, __global uint* waiting,
                         __global float* entries, uint index, uint count, uint pass) {
  stack->nodes = waiting + index;
  stack->entries = entries + index;
  stack->stride = count;
  if (pass > 0u) {
    *state = states[index];
    GN_WALK_OF(state)->steps = 0u;
  }
  return GN_WALK_OF(state)->done == 0u;
}
#define GN_RESUME(state, stack) resume(state, stack, states, waiting, entries, index, count, pass)
#define GN_PAUSE(state)                   \
  states[index] = *(state);               \
  if (GN_WALK_OF(state)->done == 0u) {    \
    atomic_inc(paused);                   \
    return;                               \
  }
#else
#define GN_PASS_PARAMETERS
#define GN_RESUME(state, stack) 1
#define GN_PAUSE(state)
#endif

#endif
