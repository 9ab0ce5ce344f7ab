// What a box costs while trees are optimised: what face weights give it (measure_math.h), for each area that is given how
// likely that area's rays meet it, less where it stands behind what stops them, and how many sampled segments do.
// Options: GN_RAY_COSTS (0: face weights alone, without the code for areas and segments; the host has it always).
// Feeds reinsert_math.h.
#ifndef GNOMON_SHARED_BOX_COSTS_H
#define GNOMON_SHARED_BOX_COSTS_H

#include "depth_map.h"
#include "measure_math.h"
#include "segment_costs.h"

#ifndef GN_RAY_COSTS
#ifdef __OPENCL_VERSION__
#define GN_RAY_COSTS 0
#else
#define GN_RAY_COSTS 1
#endif
#endif

#define GN_MOST_COST_AREAS 4u

// Of what is hidden so much counts still, and so much more of everything: maps are coarse, and rays that are stopped begin
// somewhere.
#define GN_HIDDEN_SHARE 0.05f
#define GN_SHARE_OF_ALL 0.1f

// An area and its depth map. scale: cost of a unit of the measure where nothing hides it.
typedef struct GnAreaCost {
  GnMeasure measure;
  GnDepthMap map;
  gn_f32 scale;
  gn_u32 pad;
} GnAreaCost;
GN_SIZE_IS(GnAreaCost, 128);

typedef struct GnBox {
  gn_f32 lo[3];
  gn_f32 hi[3];
} GnBox;

// The seam for measures.
typedef struct GnBoxCosts {
  gn_f32 w[3];  // of the faces
#if GN_RAY_COSTS
  gn_u32 count;
  GN_GLOBAL const gn_u16* maps;
  GnAreaCost areas[GN_MOST_COST_AREAS];
  gn_u32 segment_count;
  GN_GLOBAL const gn_f32* segments;
  gn_f32 per_segment;  // that meets a box
#endif
} GnBoxCosts;

#if GN_RAY_COSTS
GN_INLINE int gn_has_ray_costs(const GnBoxCosts* costs) { return costs->count > 0u || costs->segment_count > 0u; }

// Beside faces'.
GN_INLINE gn_f32 gn_ray_costs(const GnBoxCosts* costs, const GnBox* box) {
  gn_f32 sum =
      costs->per_segment * (gn_f32)gn_segments_met(costs->segments, costs->segment_count, box->lo, box->hi);
  gn_u32 i;
  for (i = 0u; i < costs->count; ++i) {
    const GnAreaCost* area = costs->areas + i;
    const gn_f32 share = gn_unhidden_share(&area->measure, &area->map, costs->maps, box->lo, box->hi);
    if (share >= 0.0f) {
      const int how = gn_measure_how(&area->measure, box->lo, box->hi);
      sum += area->scale * gn_box_measure(&area->measure, how, box->lo, box->hi) *
             (gn_max(share, GN_HIDDEN_SHARE) + GN_SHARE_OF_ALL);
    }
  }
  return sum;
}
#endif

GN_INLINE gn_f32 gn_box_cost(const GnBoxCosts* costs, const GnBox* box) {
  const gn_f32 faces = gn_linear_measure(costs->w, box->lo, box->hi);
#if GN_RAY_COSTS
  if (gn_has_ray_costs(costs)) return faces + gn_ray_costs(costs, box);
#endif
  return faces;
}

#endif
