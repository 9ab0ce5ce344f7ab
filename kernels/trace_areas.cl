// Batched ray tracing through local trees, each of one influence area's triangles, and the global tree of all. A ray
// that starts in an area asks its tree up to where it leaves the region, then the global tree from there on: the same
// answers as the global tree's alone, since within the region the two hold the same triangles. Note: top-level.md.
// Options beyond walk.h's and area_lookup.h's: GN_PUBLISHED_RULE (1: the thesis' rule, which may give wrong hits).
#include "shared/hit_math.h"
#include "area_lookup.h"

#ifndef GN_PUBLISHED_RULE
#define GN_PUBLISHED_RULE 0
#endif

// All trees share the caller's triangles: leaves name them by index.
typedef struct GnLeaves {
  __global const GnTriangle* triangles;
  __global const uint* order;
} GnLeaves;

static inline GnLeafTriangle leaf_triangle(const GnLeaves* leaves, uint place) {
  GnLeafTriangle leaf;
  int k;
  leaf.primitive = leaves->order[place];
  leaf.pad0 = 0u;
  leaf.pad1 = 0u;
  for (k = 0; k < 3; ++k) {
    leaf.v0[k] = leaves->triangles[leaf.primitive].v0[k];
    leaf.v1[k] = leaves->triangles[leaf.primitive].v1[k];
    leaf.v2[k] = leaves->triangles[leaf.primitive].v2[k];
  }
  return leaf;
}

#define GN_STATE GnAreaWalk
#define GN_WALK_OF(state) (&(state)->walk)
#include "walk.h"

#define GN_GLOBAL_ROOT 0u

typedef struct GnForest {
  __global const GnNode* nodes;
  GnLeaves leaves;
  GnTopLevel top;
} GnForest;
#define GN_FOREST_PARAMETERS                                                                       \
  __global const GnNode *nodes, __global const GnTriangle *triangles, __global const uint *order, \
      GN_TOP_LEVEL_PARAMETERS

static inline GnForest forest_of(GN_FOREST_PARAMETERS) {
  GnForest forest;
  forest.nodes = nodes;
  forest.leaves.triangles = triangles;
  forest.leaves.order = order;
  forest.top = top_level_of(areas, boxes, cells, cell_areas, box_count);
  return forest;
}

static inline GnAreaWalk start_area_walk(const GnRay* ray) {
  GnAreaWalk state;
  state.walk = start_walk(ray);
  state.exit = ray->tmin;
  state.area = GN_NONE;
  state.phase = GN_PHASE_CHOICE;
  state.tested = 0u;
  return state;
}

// The part of the ray that the state's phase asks about.
static inline GnRay part_of(const GnRay* ray, const GnAreaWalk* state) {
  GnRay part = *ray;
#if !GN_PUBLISHED_RULE
  if (state->phase == GN_PHASE_LOCAL) {
    part.tmax = gn_min(state->exit, ray->tmax);
  } else if (state->area != GN_NONE) {
    part.tmin = state->exit;
  }
#endif
  return part;
}

// Turns to the tree of the ray's next area, if there is one, else to the global tree.
static inline void choose_tree(GnAreaWalk* state, const GnRay* ray, const GnTopLevel* top) {
  const GnRayStart start = gn_ray_start(ray);
  GnRay part;
  state->phase = GN_PHASE_GLOBAL;
  // By the published rule a ray goes from area to area; by ours it asks one at most.
  if (state->area == GN_NONE || GN_PUBLISHED_RULE) {
    const GnChoice choice = choose_area(top, &start, state->area + 1u);
    state->tested += choice.tested;
    state->walk.steps += choice.steps;
    if (choice.area != GN_NONE) {
      const GnArea area = top->areas[choice.area];
      state->area = choice.area;
      state->exit = gn_area_exit(&area, &start);
      state->phase = GN_PHASE_LOCAL;
    }
  }
  part = part_of(ray, state);
  state->walk.limit = gn_slab_limit(part.tmax);
  state->walk.current = GN_NONE;
  state->walk.height = 0u;
  state->walk.done = 0u;
}

// Whether nothing is left to ask once a tree has been gone through.
static inline int is_answered(const GnAreaWalk* state, const GnRay* ray) {
  if (state->walk.found || state->phase == GN_PHASE_GLOBAL) return 1;
  return !GN_PUBLISHED_RULE && ray->tmax <= state->exit;
}

// Goes on until the ray is done or has used its steps.
static inline void walk_forest(GnAreaWalk* state, GnStack* stack, const GnRay* ray, const GnForest* forest,
                               int any_hit) {
  if (state->phase == GN_PHASE_CHOICE) choose_tree(state, ray, &forest->top);
  while (1) {
    const GnRay part = part_of(ray, state);
    const uint root = state->phase == GN_PHASE_LOCAL ? forest->top.areas[state->area].root : GN_GLOBAL_ROOT;
    state->walk.done = root == GN_NONE ? 1u : 0u;
    if (root != GN_NONE) traverse(&state->walk, stack, &part, forest->nodes, root, &forest->leaves, any_hit);
    if (!state->walk.done || is_answered(state, ray)) return;
    choose_tree(state, ray, &forest->top);
    if (GN_STEP_LIMIT > 0 && state->walk.steps >= GN_STEP_LIMIT) return;
  }
}

static inline void walk_ray(GnAreaWalk* state, GnStack* stack, const GnRay* ray, const GnForest* forest,
                            volatile __global uint* invalid_rays, int any_hit) {
  if (gn_ray_is_valid(ray)) {
    walk_forest(state, stack, ray, forest, any_hit);
  } else {
    state->walk.done = 1u;
    atomic_inc(invalid_rays);
  }
}

static inline uint outcome_of(const GnAreaWalk* state) {
  if (state->phase == GN_PHASE_LOCAL) return state->walk.found ? GN_OUTCOME_LOCAL : GN_OUTCOME_INSIDE;
  return state->area == GN_NONE ? GN_OUTCOME_GLOBAL : GN_OUTCOME_FALLBACK;
}

static inline void store_counters(__global GnAreaCounters* counters, uint index, const GnAreaWalk* state) {
#if GN_COUNTERS
  counters[index].boxes = state->walk.boxes;
  counters[index].triangles = state->walk.triangles;
  counters[index].areas = state->tested;
  counters[index].outcome = outcome_of(state);
#endif
}

// Closest hit of rays [0, count). invalid_rays counts rays that are not traceable; they miss.
__kernel void trace_areas_closest(GN_FOREST_PARAMETERS, __global const float8* rays, __global float4* hits,
                                  volatile __global uint* invalid_rays, __global GnAreaCounters* counters,
                                  uint count GN_PASS_PARAMETERS) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnForest forest = forest_of(nodes, triangles, order, areas, boxes, cells, cell_areas, box_count);
    const GnRay ray = load_ray(rays, index);
    GnAreaWalk state = start_area_walk(&ray);
    GnStack stack;
    if (!GN_RESUME(&state, &stack)) return;
    walk_ray(&state, &stack, &ray, &forest, invalid_rays, 0);
    GN_PAUSE(&state)
    hits[index] =
        (float4)(state.walk.best.t, state.walk.best.u, state.walk.best.v, as_float(state.walk.best.primitive));
    store_counters(counters, index, &state);
  }
}

// Any hit of rays [0, count): occluded receives 1 or 0.
__kernel void trace_areas_any(GN_FOREST_PARAMETERS, __global const float8* rays, __global uint* occluded,
                              volatile __global uint* invalid_rays, __global GnAreaCounters* counters,
                              uint count GN_PASS_PARAMETERS) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnForest forest = forest_of(nodes, triangles, order, areas, boxes, cells, cell_areas, box_count);
    const GnRay ray = load_ray(rays, index);
    GnAreaWalk state = start_area_walk(&ray);
    GnStack stack;
    if (!GN_RESUME(&state, &stack)) return;
    walk_ray(&state, &stack, &ray, &forest, invalid_rays, 1);
    GN_PAUSE(&state)
    occluded[index] = state.walk.found;
    store_counters(counters, index, &state);
  }
}
