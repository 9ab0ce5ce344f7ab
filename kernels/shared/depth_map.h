// What an area's rays see of a box before something stops them: a small depth map of the area, held as sums so that a box of
// any size takes four reads. A cell is seen as deep as the first thing its ray meets, so what lies behind is met by no ray
// that anything stops. Source: shadow maps (Williams 1978), summed-area tables (Crow 1984).
// Made by host/tree/depth_map.cpp. Feeds box_costs.h.
#ifndef GNOMON_SHARED_DEPTH_MAP_H
#define GNOMON_SHARED_DEPTH_MAP_H

#include "build_layout.h"
#include "elementary_math.h"

// Cells along each side of the window, and slices of its depth.
#define GN_MAP_CELLS 64u
#define GN_MAP_SLICES 32u
#define GN_MAP_ROW (GN_MAP_CELLS + 1u)
#define GN_MAP_SUMS (GN_MAP_SLICES * GN_MAP_ROW * GN_MAP_ROW)

// A map in the frame of a GnMeasure. Its sums: for each slice, from cell row 0 and column 0 up to each row and column, how
// many cells are seen that deep or deeper.
typedef struct GnDepthMap {
  gn_f32 to_cells[2];  // cells a unit: of places across parallel rays, of their slopes for rays from a point
  gn_f32 near_depth;
  gn_f32 to_slices;    // slices a unit of depth along forward
  gn_u32 first;        // of its sums among those of all maps
  gn_u32 is_there;     // 0: everything is seen
} GnDepthMap;
GN_SIZE_IS(GnDepthMap, 24);

// Least and most of a . p over the box's points p, seen from origin.
GN_INLINE void gn_reach_along(const gn_f32* a, const gn_f32* origin, const gn_f32* lo, const gn_f32* hi, gn_f32* least,
                              gn_f32* most) {
  gn_u32 k;
  *least = 0.0f;
  *most = 0.0f;
  for (k = 0u; k < 3u; ++k) {
    const gn_f32 from = a[k] * (lo[k] - origin[k]), to = a[k] * (hi[k] - origin[k]);
    *least += gn_min(from, to);
    *most += gn_max(from, to);
  }
}

// The share of the cells a box covers in which its front is not hidden, [0, 1]; -1 where it is outside the window, 1 where
// there is no map. maps: sums of all maps.
GN_INLINE gn_f32 gn_unhidden_share(const GnMeasure* m, const GnDepthMap* map, GN_GLOBAL const gn_u16* maps, const gn_f32* lo,
                                   const gn_f32* hi) {
  const gn_f32 cells = (gn_f32)GN_MAP_CELLS;
  gn_f32 x[2], y[2], z[2], depth;
  gn_u32 left, right, low, high, slice, seen;
  if (map->is_there == 0u) return 1.0f;
  gn_reach_along(m->right, m->origin, lo, hi, &x[0], &x[1]);
  gn_reach_along(m->up, m->origin, lo, hi, &y[0], &y[1]);
  gn_reach_along(m->forward, m->origin, lo, hi, &z[0], &z[1]);
  if (z[1] < map->near_depth) return -1.0f;
  depth = gn_max(z[0], map->near_depth);
  if (gn_kind_of(m) != GN_MEASURE_WINDOW) {
    // Slopes are largest in front, but for what is on the other side of the middle.
    const gn_f32 both = gn_reciprocal(depth * z[1]), front = z[1] * both, back = depth * both;
    x[0] *= x[0] < 0.0f ? front : back;
    x[1] *= x[1] > 0.0f ? front : back;
    y[0] *= y[0] < 0.0f ? front : back;
    y[1] *= y[1] > 0.0f ? front : back;
  }
  x[0] = gn_max(x[0] * map->to_cells[0] + 0.5f * cells, 0.0f);
  x[1] = gn_min(x[1] * map->to_cells[0] + 0.5f * cells, cells);
  y[0] = gn_max(y[0] * map->to_cells[1] + 0.5f * cells, 0.0f);
  y[1] = gn_min(y[1] * map->to_cells[1] + 0.5f * cells, cells);
  if (!(x[1] >= x[0] && y[1] >= y[0])) return -1.0f;
  // Cells from the one that is touched first to behind the last.
  left = (gn_u32)gn_min(x[0], cells - 1.0f);
  low = (gn_u32)gn_min(y[0], cells - 1.0f);
  right = (gn_u32)gn_min(x[1], cells - 1.0f) + 1u;
  high = (gn_u32)gn_min(y[1], cells - 1.0f) + 1u;
  slice = (gn_u32)gn_min((depth - map->near_depth) * map->to_slices, (gn_f32)(GN_MAP_SLICES - 1u));
  maps += map->first + slice * GN_MAP_ROW * GN_MAP_ROW;
  seen = (gn_u32)maps[high * GN_MAP_ROW + right] + maps[low * GN_MAP_ROW + left];
  seen -= (gn_u32)maps[high * GN_MAP_ROW + left] + maps[low * GN_MAP_ROW + right];
  return (gn_f32)seen * gn_reciprocal((gn_f32)((right - left) * (high - low)));
}

#endif
