// The measure of an influence area's rays that meet a box: in one step for boxes that are small seen from the eye and
// inside the window, else precisely, by the box's outline or by cutting the faces through which the rays leave the box.
// Leaving faces, not entered ones: a ray meets the box on its way exactly when it leaves it on its way, also when it begins
// inside.
// The double-precision reference is host/areas/projection.h. Feeds measure_math.h.
#ifndef GNOMON_SHARED_SEEN_MEASURE_H
#define GNOMON_SHARED_SEEN_MEASURE_H

#include "outline_measure.h"
#include "polygon_math.h"
#include "step_measure.h"
#include "whole_angle.h"

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

// Bounds of a box in the area's frame.
typedef struct GnFrameBox {
  gn_f32 at[3];
  gn_f32 reach[3];
} GnFrameBox;

// Whether all of the box lies above or below the cones that are a yaw and pitch window's upper and lower sides.
GN_INLINE int gn_is_beyond_pitch(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 height = gn_abs(box->at[1]) - box->reach[1];
  const gn_f32 x = gn_abs(box->at[0]) + box->reach[0], z = gn_abs(box->at[2]) + box->reach[2];
  return height > 0.0f && height * height > m->half_height * m->half_height * (x * x + z * z);
}

// Which planes cut the box, by a bit for each; GN_NONE where one of them, or a window's pitch, leaves nothing of it.
GN_INLINE gn_u32 gn_cutting_planes(const GnMeasure* m, const GnOutline* outline, gn_f32 unit) {
  gn_u32 cutting = 0u, i, k;
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH && m->culled) {
    GnFrameBox box = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (i = 0u; i < 3u; ++i) {
      for (k = 0u; k < 3u; ++k) {
        box.at[i] += 0.5f * (outline->at[2u * k][i] + outline->at[2u * k + 1u][i]);
        box.reach[i] += 0.5f * gn_abs(outline->at[2u * k + 1u][i] - outline->at[2u * k][i]);
      }
    }
    if (gn_is_beyond_pitch(m, &box)) return GN_NONE;
  }
  for (i = 0u; i < GN_CUT_PLANES; ++i) {
    const GnCutPlane plane = gn_cut_plane(m, unit, i);
    gn_f32 lowest = plane.offset, highest = plane.offset;
    if (!gn_may_cut(m, i)) continue;
    for (k = 0u; k < 3u; ++k) {
      const gn_u32 across = i < 3u ? 0u : 1u;
      const gn_f32* low = outline->at[2u * k];
      const gn_f32* high = outline->at[2u * k + 1u];
      const gn_f32 a = plane.normal[across] * low[across] + plane.normal[2] * low[2];
      const gn_f32 b = plane.normal[across] * high[across] + plane.normal[2] * high[2];
      lowest += gn_min(a, b);
      highest += gn_max(a, b);
    }
    if (highest < 0.0f) return GN_NONE;
    if (lowest < 0.0f) cutting |= 1u << i;
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

// The measure of a box that no plane cuts, where it takes less than others do.
GN_INLINE gn_f32 gn_uncut_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  const GnBoxes box = gn_boxes_of(lo, hi);
  if (gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE) return gn_first_lane(gn_whole_solid_angles(m, &box));
  {
    const gn_f32 dx = hi[0] - lo[0], dy = hi[1] - lo[1], dz = hi[2] - lo[2];
    return gn_abs(m->forward[0]) * dy * dz + dx * (gn_abs(m->forward[1]) * dz + gn_abs(m->forward[2]) * dy);
  }
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
    const GnOutline outline = gn_outline_of(m, lo, hi, unit);
    const gn_u32 cutting = gn_cutting_planes(m, &outline, unit);
    if (cutting == GN_NONE) return 0.0f;
    if (cutting == 0u && (kind == GN_MEASURE_SOLID_ANGLE || kind == GN_MEASURE_WINDOW)) return gn_uncut_measure(m, lo, hi);
    if (outline.ahead != 0u && kind != GN_MEASURE_SOLID_ANGLE) return gn_outline_measure(m, &outline, unit);
    return gn_faces_measure(m, &outline, cutting, unit);
  }
}

// The square of the distance that the density of rays depends on: from the eye, along forward, or from the up axis.
GN_INLINE gn_f32 gn_seen_distance_square(const GnMeasure* m, const gn_f32* p) {
  const gn_f32 along = gn_dot(p, m->forward), above = gn_dot(p, m->up);
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) return along * along;
  return gn_dot(p, p) - (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? above * above : 0.0f);
}

GN_INLINE gn_f32 gn_reach(const gn_f32* direction, const gn_f32* half_size) {
  return gn_abs(direction[0]) * half_size[0] + gn_abs(direction[1]) * half_size[1] + gn_abs(direction[2]) * half_size[2];
}

GN_INLINE GnFrameBox gn_frame_box(const GnMeasure* m, const gn_f32* centre, const gn_f32* half_size) {
  GnFrameBox box;
  box.at[0] = gn_dot(centre, m->right);
  box.at[1] = gn_dot(centre, m->up);
  box.at[2] = gn_dot(centre, m->forward);
  box.reach[0] = gn_reach(m->right, half_size);
  box.reach[1] = gn_reach(m->up, half_size);
  box.reach[2] = gn_reach(m->forward, half_size);
  return box;
}

GN_INLINE int gn_is_within_pitch(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 height = gn_abs(box->at[1]) + box->reach[1];
  const gn_f32 x = gn_max(gn_abs(box->at[0]) - box->reach[0], 0.0f), z = gn_max(box->at[2] - box->reach[2], 0.0f);
  return height * height <= m->half_height * m->half_height * (x * x + z * z);
}

// Whether no ray can meet the box: all of it lies beyond one side of the window, or behind where rays begin. centre is
// seen from the origin; box: the same box's bounds in the frame.
GN_INLINE int gn_is_out_of_sight(const GnMeasure* m, const gn_f32* centre, const gn_f32* half_size,
                                 const GnFrameBox* box) {
  const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
  gn_u32 side, k;
  if (!m->culled) return 0;
  if (box->at[2] + box->reach[2] < m->near_distance) return 1;
  if (parallel) {
    return gn_abs(box->at[0]) - box->reach[0] > m->half_width || gn_abs(box->at[1]) - box->reach[1] > m->half_height;
  }
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH && gn_is_beyond_pitch(m, box)) return 1;
  for (side = 0u; side < (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? 2u : 4u); ++side) {
    const gn_f32 sign = side % 2u == 0u ? 1.0f : -1.0f;
    const gn_f32 window = side < 2u ? m->half_width : m->half_height;
    gn_f32 distance = 0.0f, reach = 0.0f;
    for (k = 0u; k < 3u; ++k) {
      const gn_f32 outwards = sign * (side < 2u ? m->right[k] : m->up[k]) - window * m->forward[k];
      distance += outwards * centre[k];
      reach += gn_abs(outwards) * half_size[k];
    }
    if (distance > reach) return 1;
  }
  return 0;
}

#define GN_SEEN_ONE_STEP 0
#define GN_SEEN_PRECISE 1
#define GN_SEEN_NOTHING 2
#define GN_SEEN_FEW_STEPS 3
#define GN_SEEN_WHOLE 4

// Whether the window holds all of the box, and rays begin before it.
GN_INLINE int gn_is_seen_whole(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 nearest = box->at[2] - box->reach[2];
  const gn_f32 depth = gn_kind_of(m) == GN_MEASURE_WINDOW ? 1.0f : nearest;
  if (!(nearest >= m->near_distance)) return 0;
  if (!m->culled) return 1;
  if (!(gn_abs(box->at[0]) + box->reach[0] <= m->half_width * depth)) return 0;
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH) return gn_is_within_pitch(m, box);
  return gn_abs(box->at[1]) + box->reach[1] <= m->half_height * depth;
}

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
  return gn_is_seen_whole(m, &box) ? steps : GN_SEEN_PRECISE;
}

// Of a box in each lane. how: GN_SEEN_ONE_STEP, GN_SEEN_FEW_STEPS or GN_SEEN_WHOLE.
GN_LANES_INLINE gn_lanes gn_lane_measures(const GnMeasure* m, const int how, const GnBoxes* box) {
  if (how == GN_SEEN_WHOLE) return gn_whole_solid_angles(m, box);
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
