// Finding the influence areas that may hold a ray's start, on the device: list, tree of boxes or octree
// (host/tree/top_level.h). Option: GN_LOOKUP, as gnomon::AreaLookup. Feeds trace_areas.cl and find_areas.cl.
#ifndef GNOMON_AREA_LOOKUP_H
#define GNOMON_AREA_LOOKUP_H

#include "shared/area_math.h"

#define GN_LOOKUP_LIST 0
#define GN_LOOKUP_BVH 1
#define GN_LOOKUP_OCTREE 2
#ifndef GN_LOOKUP
#define GN_LOOKUP GN_LOOKUP_LIST
#endif

typedef struct GnTopLevel {
  __global const GnArea* areas;
  __global const GnAreaBox* boxes;  // octree: the root's alone
  __global const GnAreaCell* cells;
  __global const uint* cell_areas;
  uint box_count;  // 0: there are no areas
} GnTopLevel;
#define GN_TOP_LEVEL_PARAMETERS                                                                              \
  __global const GnArea *areas, __global const GnAreaBox *boxes, __global const GnAreaCell *cells,           \
      __global const uint *cell_areas, uint box_count

static inline GnTopLevel top_level_of(GN_TOP_LEVEL_PARAMETERS) {
  GnTopLevel top;
  top.areas = areas;
  top.boxes = boxes;
  top.cells = cells;
  top.cell_areas = cell_areas;
  top.box_count = box_count;
  return top;
}

// A lookup under way: entries [at, end) of the boxes, or of the octree's areas, are still to be seen.
typedef struct GnLookup {
  uint at;
  uint end;
  uint steps;  // made so far
} GnLookup;

static inline GnLookup start_lookup(const GnTopLevel* top, const float* point) {
  GnLookup lookup;
  lookup.at = 0u;
  lookup.end = top->box_count;
  lookup.steps = 0u;
#if GN_LOOKUP == GN_LOOKUP_OCTREE
  if (top->box_count > 0u) {
    const GnAreaBox root = top->boxes[0];
    float lo[3] = {root.lo[0], root.lo[1], root.lo[2]};
    float hi[3] = {root.hi[0], root.hi[1], root.hi[2]};
    lookup.end = 0u;
    if (gn_box_has(lo, hi, point)) {
      GnAreaCell cell = top->cells[0];
      while (cell.first_child != GN_NONE) {
        cell = top->cells[cell.first_child + gn_octree_step(lo, hi, point)];
        lookup.steps += 1u;
      }
      lookup.at = cell.first;
      lookup.end = cell.first + cell.count;
    }
  }
#endif
  return lookup;
}

// The next candidate with an index below `limit`, or GN_NONE when there is none left.
static inline uint next_candidate(GnLookup* lookup, const GnTopLevel* top, const float* point, uint limit) {
  while (lookup->at < lookup->end) {
    lookup->steps += 1u;
#if GN_LOOKUP == GN_LOOKUP_OCTREE
    const uint area = top->cell_areas[lookup->at];
    lookup->at += 1u;
    if (area < limit) return area;
#else
    const GnAreaBox box = top->boxes[lookup->at];
    const int inside = box.area < limit && gn_box_has(box.lo, box.hi, point);
    const uint next = lookup->at + 1u;
    lookup->at = inside ? next : box.skip;
    if (inside && box.skip == next) return box.area;
#endif
  }
  return GN_NONE;
}

// What a choice found, and what it cost.
typedef struct GnChoice {
  uint area;
  uint tested;  // regions tested exactly
  uint steps;
} GnChoice;

// The area whose local tree the ray asks: the lowest one from `from` on that has its start for certain and is meant for
// its direction, so the same one whichever structure is looked up.
static inline GnChoice choose_area(const GnTopLevel* top, const GnRayStart* start, uint from) {
  GnLookup lookup = start_lookup(top, start->point);
  GnChoice choice;
  uint candidate = next_candidate(&lookup, top, start->point, GN_NONE);
  choice.area = GN_NONE;
  choice.tested = 0u;
  while (candidate != GN_NONE) {
    if (candidate >= from) {
      const GnArea area = top->areas[candidate];
      choice.tested += 1u;
      if (gn_area_is_affine(&area, start) && gn_area_contains(&area, start)) {
        choice.area = candidate;
        // Lists and cells name areas in order; a tree does not.
        if (GN_LOOKUP != GN_LOOKUP_BVH) break;
      }
    }
    candidate = next_candidate(&lookup, top, start->point, choice.area);
  }
  choice.steps = lookup.steps + GN_AREA_PLANES * choice.tested;
  return choice;
}

#endif
