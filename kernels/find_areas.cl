// The lookup of trace_areas.cl by itself, for many rays: what the bench times and tests compare. Option: GN_LOOKUP.
#include "shared/hit_math.h"
#include "area_lookup.h"


// The area of each ray [0, count), or GN_NONE, as tracing chooses it. Rays that are not traceable have none.
__kernel void choose_areas(GN_TOP_LEVEL_PARAMETERS, __global const GnRay* rays, __global uint* chosen, uint count) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = rays[index];
    const GnTopLevel top = top_level_of(areas, boxes, cells, cell_areas, box_count);
    uint area = GN_NONE;
    if (gn_ray_is_valid(&ray)) {
      const GnRayStart start = gn_ray_start(&ray);
      const GnChoice choice = choose_area(&top, &start, 0u);
      area = choice.area;
    }
    chosen[index] = area;
  }
}

// How many areas the structure offers for each ray's start, and in how many of them it is for certain.
__kernel void count_areas(GN_TOP_LEVEL_PARAMETERS, __global const GnRay* rays, __global uint* offered,
                          __global uint* holding, uint count) {
  const uint index = (uint)get_global_id(0);
  if (index < count) {
    const GnRay ray = rays[index];
    const GnTopLevel top = top_level_of(areas, boxes, cells, cell_areas, box_count);
    uint offers = 0u, holds = 0u;
    if (gn_ray_is_valid(&ray)) {
      const GnRayStart start = gn_ray_start(&ray);
      GnLookup lookup = start_lookup(&top, start.point);
      uint candidate = next_candidate(&lookup, &top, start.point, GN_NONE);
      while (candidate != GN_NONE) {
        const GnArea area = top.areas[candidate];
        offers += 1u;
        holds += gn_area_contains(&area, &start) ? 1u : 0u;
        candidate = next_candidate(&lookup, &top, start.point, GN_NONE);
      }
    }
    offered[index] = offers;
    holding[index] = holds;
  }
}
