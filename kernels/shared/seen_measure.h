// The measure of an influence area's rays that meet a box: in one step for boxes that are small seen from the eye and
// inside the window, else precisely, by the box's outline or by cutting the faces through which the rays leave the box.
// Leaving faces, not entered ones: a ray meets the box on its way exactly when it leaves it on its way, also when it begins
// inside.
// The double-precision reference is host/areas/projection.h. Feeds measure_math.h.
#ifndef GNOMON_SHARED_SEEN_MEASURE_H
#define GNOMON_SHARED_SEEN_MEASURE_H

#include "frame_box.h"
#include "outline_measure.h"
#include "polygon_math.h"
#include "step_measure.h"
#include "whole_angle.h"
#include "window_measure.h"

// A box counts as small when its diagonal is below 1/10 of its distance, as middling when it is below 1/2: measures in one
// step and in a few are then right within 1 %.
#define GN_SMALL_SEEN 0.01f  // (1/10)^2
#define GN_MIDDLING_SEEN 0.25f

// Planes that may cut what is measured: where rays begin, and the window's sides, right, left, upper and lower. Yaw and
// pitch keep the last two for later (side_math.h). What lies where the plane's product plus offset is not negative stays.
#define GN_CUT_PLANES 5u
typedef struct GnCutPlane {
  gn_f32 normal[3];
  gn_f32 offset;
} GnCutPlane;

GN_INLINE GnCutPlane gn_cut_plane(const GnMeasure* m, gn_f32 unit, gn_u32 which) {
  const gn_f32 sign = which % 2u == 1u ? -1.0f : 1.0f;
  const gn_f32 half_size = which < 3u ? m->half_width : m->half_height;
  const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
  GnCutPlane plane = {{0.0f, 0.0f, 1.0f}, -m->near_distance * unit};
  if (which == 0u) return plane;
  plane.normal[which < 3u ? 0 : 1] = sign;
  plane.normal[2] = parallel ? 0.0f : half_size;
  plane.offset = parallel ? half_size * unit : 0.0f;
  return plane;
}

GN_INLINE int gn_may_cut(const GnMeasure* m, gn_u32 which) {
  const gn_u32 kind = gn_kind_of(m);
  if (which == 0u) return kind != GN_MEASURE_SOLID_ANGLE || m->culled != 0u;
  return m->culled != 0u && (which < 3u || kind != GN_MEASURE_YAW_PITCH);
}

// What one face, through which rays leave, contributes. corners: the box's, by a bit for each axis. cutting: by a bit for
// each plane, those that cut the box.
GN_INLINE gn_f32 gn_face_measure(const GnMeasure* m, const gn_f32* corners, gn_u32 axis, gn_u32 upper, gn_u32 cutting,
                                 gn_f32 unit) {
  const gn_u32 u = axis == 2u ? 0u : axis + 1u, v = u == 2u ? 0u : u + 1u;
  gn_f32 polygon[3 * GN_MAX_CORNERS], scratch[3 * GN_MAX_CORNERS];
  gn_u32 count = 4u, i, k;
  for (i = 0u; i < 4u; ++i) {
    const gn_u32 corner = upper << axis | (i == 1u || i == 2u ? 1u : 0u) << u | (i >> 1u) << v;
    for (k = 0u; k < 3u; ++k) polygon[3u * i + k] = corners[3u * corner + k];
  }
  for (i = 0u; i < GN_CUT_PLANES; ++i) {
    if ((cutting >> i & 1u) != 0u) {
      const GnCutPlane plane = gn_cut_plane(m, unit, i);
      count = gn_cut_polygon(polygon, count, plane.normal, plane.offset, scratch);
    }
  }
  if (gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE) return gn_polygon_solid_angle(polygon, count);
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH) return gn_polygon_yaw_pitch(m->half_pitch, polygon, count);
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) gn_project_polygon(polygon, count);
  return gn_polygon_flat_area(polygon, count);
}

GN_INLINE GnFrameBox gn_bounds_of(const GnOutline* outline) {
  GnFrameBox box = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
  gn_u32 i, k;
  for (k = 0u; k < 3u; ++k) {
    for (i = 0u; i < 3u; ++i) {
      box.at[i] += 0.5f * (outline->at[2u * k][i] + outline->at[2u * k + 1u][i]);
      box.reach[i] += 0.5f * gn_abs(outline->at[2u * k + 1u][i] - outline->at[2u * k][i]);
    }
  }
  return box;
}

// Lowest and highest place of the box beside each side of the window, planes 1 to 4: all four by one formula,
// which compilers take at once.
GN_INLINE void gn_beside_window(const GnMeasure* m, const GnOutline* outline, gn_f32 unit, gn_f32* lowest,
                                gn_f32* highest) {
  const gn_f32 aside[4] = {-1.0f, 1.0f, 0.0f, 0.0f}, above[4] = {0.0f, 0.0f, -1.0f, 1.0f};
  const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
  gn_u32 i, k;
  for (i = 0u; i < 4u; ++i) {
    lowest[i] = parallel ? (i < 2u ? m->half_width : m->half_height) * unit : 0.0f;
    highest[i] = lowest[i];
  }
  for (k = 0u; k < 3u; ++k) {
    const gn_f32* low = outline->at[2u * k];
    const gn_f32* high = outline->at[2u * k + 1u];
    for (i = 0u; i < 4u; ++i) {
      const gn_f32 depth = parallel ? 0.0f : i < 2u ? m->half_width : m->half_height;
      const gn_f32 a = aside[i] * low[0] + above[i] * low[1] + depth * low[2];
      const gn_f32 b = aside[i] * high[0] + above[i] * high[1] + depth * high[2];
      lowest[i] += gn_min(a, b);
      highest[i] += gn_max(a, b);
    }
  }
}

// Which planes cut the box, by a bit for each; GN_NONE where one of them leaves nothing of it.
GN_INLINE gn_u32 gn_cutting_planes(const GnMeasure* m, const GnOutline* outline, gn_f32 unit) {
  gn_f32 lowest[GN_CUT_PLANES], highest[GN_CUT_PLANES];
  gn_u32 cutting = 0u, i, k;
  lowest[0] = -m->near_distance * unit;
  highest[0] = lowest[0];
  for (k = 0u; k < 3u; ++k) {
    lowest[0] += gn_min(outline->at[2u * k][2], outline->at[2u * k + 1u][2]);
    highest[0] += gn_max(outline->at[2u * k][2], outline->at[2u * k + 1u][2]);
  }
  gn_beside_window(m, outline, unit, lowest + 1, highest + 1);
  for (i = 0u; i < GN_CUT_PLANES; ++i) {
    if (!gn_may_cut(m, i)) continue;
    if (highest[i] < 0.0f) return GN_NONE;
    if (lowest[i] < 0.0f) cutting |= 1u << i;
  }
  return cutting;
}

// The measure by faces: of all through which rays leave.
GN_INLINE gn_f32 gn_faces_measure(const GnMeasure* m, const GnOutline* outline, gn_u32 cutting, gn_f32 unit) {
  gn_f32 corners[3 * 8], sum = 0.0f;
  gn_u32 i, k;
  for (i = 0u; i < 8u; ++i) {
    const gn_f32* a = outline->at[i & 1u];
    const gn_f32* b = outline->at[2u + (i >> 1u & 1u)];
    const gn_f32* c = outline->at[4u + (i >> 2u)];
    for (k = 0u; k < 3u; ++k) corners[3u * i + k] = a[k] + b[k] + c[k];
  }
  for (i = 0u; i < 6u; ++i) {
    if ((outline->leaves >> i & 1u) != 0u) sum += gn_face_measure(m, corners, i >> 1u, i & 1u, cutting, unit);
  }
  return sum;
}

// Whether few steps serve a box in yaw and pitch that no plane cuts: neither do the window's upper and lower
// sides, and it is not large. As near as its outline's curves are, for a third of the work.
GN_INLINE int gn_few_steps_serve(const GnMeasure* m, const GnFrameBox* box, const gn_f32* lo,
                                 const gn_f32* hi, gn_f32 unit) {
  const gn_f32 dx = (hi[0] - lo[0]) * unit, dy = (hi[1] - lo[1]) * unit, dz = (hi[2] - lo[2]) * unit;
  const gn_f32 distance = box->at[0] * box->at[0] + box->at[2] * box->at[2];
  if (m->culled && !gn_is_within_pitch(m, box)) return 0;
  return dx * dx + dy * dy + dz * dz < GN_MIDDLING_SEEN * distance;
}

// The precise measure.
GN_INLINE gn_f32 gn_precise_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  const gn_u32 kind = gn_kind_of(m);
  gn_f32 unit = 1.0f;
  if (kind != GN_MEASURE_WINDOW) {
    gn_f32 largest = 0.0f;
    gn_u32 axis;
    for (axis = 0u; axis < 3u; ++axis) {
      largest = gn_max(largest, gn_max(gn_abs(lo[axis] - m->origin[axis]), gn_abs(hi[axis] - m->origin[axis])));
    }
    unit = gn_power_near_reciprocal(largest);
  }
  {
    const GnBoxes lanes = gn_boxes_of(lo, hi);
    const GnOutline outline = gn_outline_of(m, lo, hi, unit);
    gn_u32 cutting;
    if (kind == GN_MEASURE_WINDOW && outline.ahead != 0u) return gn_first_lane(gn_window_measures(m, &lanes));
    cutting = gn_cutting_planes(m, &outline, unit);
    if (cutting == GN_NONE) return 0.0f;
    if (kind == GN_MEASURE_YAW_PITCH) {
      const GnFrameBox box = gn_bounds_of(&outline);
      if (m->culled && gn_is_beyond_pitch(m, &box)) return 0.0f;
      if (cutting == 0u && gn_few_steps_serve(m, &box, lo, hi, unit)) return gn_first_lane(gn_few_step_measures(m, &lanes));
    }
    if (cutting == 0u && kind == GN_MEASURE_SOLID_ANGLE) return gn_first_lane(gn_whole_solid_angles(m, &lanes));
    if (outline.ahead != 0u && kind != GN_MEASURE_SOLID_ANGLE) return gn_outline_measure(m, &outline);
    return gn_faces_measure(m, &outline, cutting, unit);
  }
}

// The square of the distance that the density of rays depends on: from the eye, along forward, or from the up axis.
GN_INLINE gn_f32 gn_seen_distance_square(const GnMeasure* m, const gn_f32* p) {
  const gn_f32 along = gn_dot(p, m->forward), above = gn_dot(p, m->up);
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) return along * along;
  return gn_dot(p, p) - (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? above * above : 0.0f);
}

#define GN_SEEN_ONE_STEP 0
#define GN_SEEN_PRECISE 1
#define GN_SEEN_NOTHING 2
#define GN_SEEN_FEW_STEPS 3
#define GN_SEEN_WHOLE 4
#define GN_SEEN_CUT 5  // by the sides of a window of parallel rays, but all of it ahead of where they begin

// How the boxes of a node must be measured: precisely where it is large as seen from the eye, or not all of it is inside
// the window and ahead of where rays begin.
GN_INLINE int gn_seen_how(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  gn_f32 centre[3], half_size[3], distance, size;
  GnFrameBox box;
  gn_u32 k;
  const int large = gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE ? GN_SEEN_WHOLE : GN_SEEN_PRECISE;
  int steps = GN_SEEN_ONE_STEP;
  for (k = 0u; k < 3u; ++k) {
    centre[k] = 0.5f * (lo[k] + hi[k]) - m->origin[k];
    half_size[k] = 0.5f * (hi[k] - lo[k]);
  }
  if (gn_kind_of(m) != GN_MEASURE_WINDOW) {
    size = 4.0f * gn_dot(half_size, half_size);
    distance = gn_seen_distance_square(m, centre);
    if (!(size < GN_SMALL_SEEN * distance)) steps = size < GN_MIDDLING_SEEN * distance ? GN_SEEN_FEW_STEPS : large;
  }
  if (gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE && !m->culled) return steps;
  box = gn_frame_box(m, centre, half_size);
  if (gn_is_out_of_sight(m, centre, half_size, &box)) return GN_SEEN_NOTHING;
  if (gn_is_seen_whole(m, &box)) return steps;
  return gn_kind_of(m) == GN_MEASURE_WINDOW && box.at[2] - box.reach[2] >= m->near_distance ? GN_SEEN_CUT
                                                                                            : GN_SEEN_PRECISE;
}

// Of a box in each lane. how: GN_SEEN_ONE_STEP, GN_SEEN_FEW_STEPS, GN_SEEN_WHOLE or GN_SEEN_CUT.
GN_LANES_INLINE gn_lanes gn_lane_measures(const GnMeasure* m, const int how, const GnBoxes* box) {
  if (how == GN_SEEN_WHOLE) return gn_whole_solid_angles(m, box);
  if (how == GN_SEEN_CUT) return gn_window_measures(m, box);
  return how == GN_SEEN_ONE_STEP ? gn_one_step_measures(m, box) : gn_few_step_measures(m, box);
}

GN_INLINE gn_f32 gn_seen_measure(const GnMeasure* m, int how, const gn_f32* lo, const gn_f32* hi) {
  if (how == GN_SEEN_NOTHING) return 0.0f;
  if (how == GN_SEEN_PRECISE) return gn_precise_measure(m, lo, hi);
  {
    const GnBoxes box = gn_boxes_of(lo, hi);
    return gn_first_lane(gn_lane_measures(m, how, &box));
  }
}

#endif
