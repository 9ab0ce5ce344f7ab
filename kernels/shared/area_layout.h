// Structs of the top level that cross between host and device, as those of layout.h: influence areas as the tracer
// tests them, the flat structures that look them up, and where a ray stands between two passes.
// Feeds area_math.h, trace_areas.cl, host/areas/shared_area.h and host/tree/top_level.h.
#ifndef GNOMON_SHARED_AREA_LAYOUT_H
#define GNOMON_SHARED_AREA_LAYOUT_H

#include "layout.h"

// GnArea.kind, numbered as gnomon::AreaKind.
#define GN_AREA_PLANE 0u
#define GN_AREA_POINT 1u
#define GN_AREA_OMNI 2u

#define GN_AREA_PLANES 6

// One influence area in float: every number is the nearest float to the true one, except for the box, which encloses
// the true region. area_math.h takes off what that rounding may be wrong by.
typedef struct GnArea {
  gn_f32 planes[4 * GN_AREA_PLANES];  // plane, point: inside where n . p + w >= 0 for each (n, w); n is unit, inwards
  gn_f32 lo[3];                       // of the enclosing box
  gn_u32 kind;
  gn_f32 hi[3];
  gn_f32 size;      // largest magnitude in lo and hi
  gn_f32 focus[3];  // plane: unit direction of its rays; point: the eye; omni: the centre
  gn_f32 affinity;  // square of the least |cos| between a ray and the area's; 0: rays of every direction are meant
  gn_f32 radius;    // omni
  gn_u32 root;      // of its local tree; GN_NONE: no triangle touches the region
  gn_u32 pad0;
  gn_u32 pad1;
} GnArea;
GN_SIZE_IS(GnArea, 160);

// A box in a list of them, or in a tree of them laid out depth first. Whoever is not in the box goes on at `skip`,
// others at the next entry. area: the lowest area below; an entry with skip == its place + 1 is that area itself.
typedef struct GnAreaBox {
  gn_f32 lo[3];
  gn_u32 skip;
  gn_f32 hi[3];
  gn_u32 area;
} GnAreaBox;
GN_SIZE_IS(GnAreaBox, 32);

// A cell of an octree. Inner: children at [first_child, first_child + 8), numbered by bits x = 1, y = 2, z = 4 (set:
// upper half). Leaf (first_child == GN_NONE): its areas are [first, first + count) of the octree's list, ascending.
typedef struct GnAreaCell {
  gn_u32 first_child;
  gn_u32 first;
  gn_u32 count;
  gn_u32 pad;
} GnAreaCell;
GN_SIZE_IS(GnAreaCell, 16);

// GnAreaCounters.outcome.
#define GN_OUTCOME_GLOBAL 0u    // no area for this ray: the global tree alone
#define GN_OUTCOME_LOCAL 1u     // hit in a local tree
#define GN_OUTCOME_INSIDE 2u    // missed, and ends before it leaves the area: no second question
#define GN_OUTCOME_FALLBACK 3u  // asked a local tree, then the global one

// Work one ray caused, when counters are compiled in.
typedef struct GnAreaCounters {
  gn_u32 boxes;      // nodes of local and global trees
  gn_u32 triangles;
  gn_u32 areas;      // regions tested exactly
  gn_u32 outcome;
} GnAreaCounters;
GN_SIZE_IS(GnAreaCounters, 16);

// GnAreaWalk.phase: which tree is asked.
#define GN_PHASE_CHOICE 0u
#define GN_PHASE_LOCAL 1u
#define GN_PHASE_GLOBAL 2u

// GnWalk for a ray that may go through two trees.
typedef struct GnAreaWalk {
  GnWalk walk;
  gn_f32 exit;   // up to where the local tree answers
  gn_u32 area;   // whose local tree is or was asked; GN_NONE: none
  gn_u32 phase;
  gn_u32 tested;  // areas
} GnAreaWalk;
GN_SIZE_IS(GnAreaWalk, 64);

#endif
