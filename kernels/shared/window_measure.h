// The measure of boxes as parallel rays through a window see them, all of the box ahead of where the rays
// begin, in every lane at once: nothing outside the window, the area across the rays inside it, and what the
// window leaves of the outline in between. Not for boxes that the window's own plane cuts (seen_measure.h).
// Feeds seen_measure.h.
#ifndef GNOMON_SHARED_WINDOW_MEASURE_H
#define GNOMON_SHARED_WINDOW_MEASURE_H

#include "build_layout.h"
#include "elementary_math.h"

// A box in the window's plane: what its two faces across each axis add to a corner, first the one that rays
// enter by. In this order every box has the same six corners on its outline.
typedef struct GnFlatBox {
  gn_lanes x[3][2];
  gn_lanes y[3][2];
} GnFlatBox;

// All edges along an axis have one direction in the window's plane.
typedef struct GnFlatEdge {
  gn_f32 slope;    // dy / dx
  gn_f32 inverse;  // |dx / dy|
  gn_f32 sign;     // of dx from the face that rays enter by to the other
} GnFlatEdge;

GN_INLINE GnFlatEdge gn_flat_edge(const GnMeasure* m, gn_u32 k) {
  const gn_f32 along = gn_abs(m->right[k]), across = gn_abs(m->up[k]), smallest = 1e-30f;
  const gn_f32 slope = across * gn_reciprocal(gn_max(along, smallest));
  GnFlatEdge edge;
  edge.slope = (m->right[k] < 0.0f) == (m->up[k] < 0.0f) ? slope : -slope;
  edge.inverse = along * gn_reciprocal(gn_max(across, smallest));
  edge.sign = (m->right[k] < 0.0f) == (m->forward[k] < 0.0f) ? 1.0f : -1.0f;
  return edge;
}

GN_INLINE gn_lanes gn_lanes_within(gn_lanes x, gn_lanes low, gn_lanes high) {
  return gn_lanes_max(gn_lanes_min(x, high), low);
}

// Area between a line and y = limit where the line is above it. low, high: its lowest and highest y; run: its
// extent in x.
GN_LANES_INLINE gn_lanes gn_areas_above(gn_lanes low, gn_lanes high, gn_lanes limit, gn_lanes run,
                                        gn_f32 inverse) {
  const gn_lanes p = gn_lanes_max(high - limit, GN_ALL(0.0f)), q = gn_lanes_max(low - limit, GN_ALL(0.0f));
  const gn_lanes above = gn_lanes_min((p - q) * inverse, run);
  return 0.5f * (p + q) * (low >= limit ? run : above);
}

// Area between the edge from a to b and y = 0, cut to the window: x in [-half_width, half_width], y in
// [bottom, top]. Positive where x grows. sign: of b's x less a's.
GN_LANES_INLINE gn_lanes gn_edge_areas(const GnFlatEdge* edge, gn_f32 sign, gn_lanes ax, gn_lanes ay,
                                       gn_lanes bx, gn_lanes by, gn_lanes half_width, gn_lanes bottom,
                                       gn_lanes top) {
  const gn_lanes lowest = gn_lanes_min(ay, by), highest = gn_lanes_max(ay, by);
  const gn_lanes from = gn_lanes_within(ax, -half_width, half_width),
                 to = gn_lanes_within(bx, -half_width, half_width);
  const gn_lanes run = sign * (to - from);
  // A steep edge's slope times what x rounds by may be any number.
  const gn_lanes y_from = gn_lanes_within(ay + edge->slope * (from - ax), lowest, highest);
  const gn_lanes y_to = gn_lanes_within(by + edge->slope * (to - bx), lowest, highest);
  const gn_lanes low = gn_lanes_min(y_from, y_to), high = gn_lanes_max(y_from, y_to);
  const gn_lanes over = gn_areas_above(low, high, top, run, edge->inverse);
  const gn_lanes under = gn_areas_above(-high, -low, -bottom, run, edge->inverse);
  return sign * (0.5f * (low + high) * run - over + under);
}

// What of the outline is inside the window. Heights are taken from one corner's: those of small boxes keep
// their digits.
GN_LANES_INLINE gn_lanes gn_cut_outlines(const GnMeasure* m, const GnFlatBox* box) {
  const gn_lanes half_width = GN_ALL(m->half_width), half_height = GN_ALL(m->half_height);
  const GnFlatEdge edges[3] = {gn_flat_edge(m, 0u), gn_flat_edge(m, 1u), gn_flat_edge(m, 2u)};
  gn_lanes x[6], y[6], level, bottom, top, sum = GN_ALL(0.0f);
  gn_u32 i;
  for (i = 0u; i < 6u; ++i) {
    // Around, by a bit for each axis: 1 3 2 6 4 5, all but the two that rays meet first and last.
    const gn_u32 a = i < 2u || i == 5u ? 1u : 0u, b = i >= 1u && i <= 3u ? 1u : 0u, c = i >= 3u ? 1u : 0u;
    x[i] = box->x[0][a] + box->x[1][b] + box->x[2][c];
    y[i] = box->y[0][a] + box->y[1][b] + box->y[2][c];
  }
  level = gn_lanes_within(y[0], -half_height, half_height);
  bottom = -half_height - level;
  top = half_height - level;
  for (i = 0u; i < 6u; ++i) y[i] = y[i] - level;
  for (i = 0u; i < 6u; ++i) {
    const gn_u32 next = i == 5u ? 0u : i + 1u;
    const GnFlatEdge* edge = &edges[i % 3u == 2u ? 2u : 1u - i % 3u];
    const gn_f32 sign = i % 2u == 0u ? edge->sign : -edge->sign;
    sum = sum + gn_edge_areas(edge, sign, x[i], y[i], x[next], y[next], half_width, bottom, top);
  }
  return gn_lanes_abs(sum);
}

GN_LANES_INLINE gn_lanes gn_window_measures(const GnMeasure* m, const GnBoxes* box) {
  const gn_lanes half_width = GN_ALL(m->half_width), half_height = GN_ALL(m->half_height);
  gn_lanes left = GN_ALL(0.0f), right = left, bottom = left, top = left, area;
  gn_lane_mask outside, cut;
  GnFlatBox flat;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) {
    const gn_lanes low = box->lo[k] - m->origin[k], high = box->hi[k] - m->origin[k];
    const gn_lanes entered = m->forward[k] < 0.0f ? high : low, left_by = m->forward[k] < 0.0f ? low : high;
    flat.x[k][0] = entered * m->right[k];
    flat.x[k][1] = left_by * m->right[k];
    flat.y[k][0] = entered * m->up[k];
    flat.y[k][1] = left_by * m->up[k];
    left = left + gn_lanes_min(flat.x[k][0], flat.x[k][1]);
    right = right + gn_lanes_max(flat.x[k][0], flat.x[k][1]);
    bottom = bottom + gn_lanes_min(flat.y[k][0], flat.y[k][1]);
    top = top + gn_lanes_max(flat.y[k][0], flat.y[k][1]);
  }
  outside = ((left > half_width) | (right < -half_width)) | ((bottom > half_height) | (top < -half_height));
  cut = ((left < -half_width) | (right > half_width)) | ((bottom < -half_height) | (top > half_height));
  {
    const gn_lanes dx = box->hi[0] - box->lo[0], dy = box->hi[1] - box->lo[1], dz = box->hi[2] - box->lo[2];
    area = gn_abs(m->forward[0]) * dy * dz + dx * (gn_abs(m->forward[1]) * dz + gn_abs(m->forward[2]) * dy);
  }
  if (gn_any_lane(cut & !outside)) area = cut ? gn_cut_outlines(m, &flat) : area;
  return outside ? GN_ALL(0.0f) : area;
}

#endif
