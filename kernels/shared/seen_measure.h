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

// A box counts as small when its diagonal is below 1/10 of its distance, as middling when it is below 1/2: measures in one
// step and in a few are then right within 1 %.
#define GN_SMALL_SEEN 0.01f  // (1/10)^2
#define GN_MIDDLING_SEEN 0.25f

// Four of a box's corners, one face, in the area's frame and in units of `unit`.
GN_INLINE void gn_face_polygon(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi, gn_u32 axis, gn_f32 at,
                               gn_f32 unit, gn_f32* polygon) {
  const gn_u32 u = axis == 2u ? 0u : axis + 1u;
  const gn_u32 v = u == 2u ? 0u : u + 1u;
  gn_u32 i;
  for (i = 0u; i < 4u; ++i) {
    gn_f32 p[3];
    p[axis] = (at - m->origin[axis]) * unit;
    p[u] = ((i == 1u || i == 2u ? hi[u] : lo[u]) - m->origin[u]) * unit;
    p[v] = ((i >= 2u ? hi[v] : lo[v]) - m->origin[v]) * unit;
    polygon[3u * i] = gn_dot(p, m->right);
    polygon[3u * i + 1u] = gn_dot(p, m->up);
    polygon[3u * i + 2u] = gn_dot(p, m->forward);
  }
}

// Cuts the face by where rays begin and, if asked, by the window's sides; yaw and pitch keep their upper and lower sides
// for later. a holds the result; b is scratch.
GN_INLINE gn_u32 gn_cut_face(const GnMeasure* m, gn_f32 unit, gn_f32* a, gn_f32* b) {
  const gn_f32 forward[3] = {0.0f, 0.0f, 1.0f};
  gn_u32 count = 4u, i, side;
  if (gn_kind_of(m) != GN_MEASURE_SOLID_ANGLE || m->culled) {
    count = gn_cut_polygon(a, count, forward, -m->near_distance * unit, b);
    for (i = 0u; i < 3u * count; ++i) a[i] = b[i];
  }
  if (!m->culled) return count;
  for (side = 0u; side < (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? 2u : 4u); ++side) {
    const gn_f32 half_size = side < 2u ? m->half_width : m->half_height;
    const gn_f32 sign = side % 2u == 0u ? -1.0f : 1.0f;
    gn_f32 plane[3] = {side < 2u ? sign : 0.0f, side < 2u ? 0.0f : sign, 0.0f};
    const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
    plane[2] = parallel ? 0.0f : half_size;
    count = gn_cut_polygon(a, count, plane, parallel ? half_size * unit : 0.0f, b);
    for (i = 0u; i < 3u * count; ++i) a[i] = b[i];
  }
  return count;
}

// What one face, through which rays leave, contributes.
GN_INLINE gn_f32 gn_face_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi, gn_u32 axis, gn_f32 at,
                                 gn_f32 unit) {
  gn_f32 a[3 * GN_MAX_CORNERS], b[3 * GN_MAX_CORNERS];
  gn_u32 count;
  gn_face_polygon(m, lo, hi, axis, at, unit, a);
  count = gn_cut_face(m, unit, a, b);
  if (gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE) return gn_polygon_solid_angle(a, count);
  if (gn_kind_of(m) == GN_MEASURE_YAW_PITCH) return gn_polygon_yaw_pitch(m->half_pitch, a, count);
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) gn_project_polygon(a, count);
  return gn_polygon_flat_area(a, count);
}

// The precise measure: of all faces through which rays leave.
GN_INLINE gn_f32 gn_precise_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  gn_f32 sum = 0.0f, unit = 1.0f;
  gn_u32 axis;
  const int parallel = gn_kind_of(m) == GN_MEASURE_WINDOW;
  if (!parallel) {
    gn_f32 largest = 0.0f;
    for (axis = 0u; axis < 3u; ++axis) {
      largest = gn_max(largest, gn_max(gn_abs(lo[axis] - m->origin[axis]), gn_abs(hi[axis] - m->origin[axis])));
    }
    unit = gn_power_near_reciprocal(largest);
  }
  if (gn_kind_of(m) != GN_MEASURE_SOLID_ANGLE) {
    const GnOutline outline = gn_outline_of(m, lo, hi, unit);
    if (outline.ahead) return gn_outline_measure(m, &outline, unit);
  }
  for (axis = 0u; axis < 3u; ++axis) {
    if (gn_leaves_by(m, lo, hi, axis, 1)) sum += gn_face_measure(m, lo, hi, axis, hi[axis], unit);
    if (gn_leaves_by(m, lo, hi, axis, 0)) sum += gn_face_measure(m, lo, hi, axis, lo[axis], unit);
  }
  return sum;
}

// The square of the distance that the density of rays depends on: from the eye, along forward, or from the up axis.
GN_INLINE gn_f32 gn_seen_distance_square(const GnMeasure* m, const gn_f32* p) {
  const gn_f32 along = gn_dot(p, m->forward), above = gn_dot(p, m->up);
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) return along * along;
  return gn_dot(p, p) - (gn_kind_of(m) == GN_MEASURE_YAW_PITCH ? above * above : 0.0f);
}

// Bounds of a box in the area's frame.
typedef struct GnFrameBox {
  gn_f32 at[3];
  gn_f32 reach[3];
} GnFrameBox;

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

// Whether all of the box lies above or below the cones that are a yaw and pitch window's upper and lower sides.
GN_INLINE int gn_is_beyond_pitch(const GnMeasure* m, const GnFrameBox* box) {
  const gn_f32 height = gn_abs(box->at[1]) - box->reach[1];
  const gn_f32 x = gn_abs(box->at[0]) + box->reach[0], z = gn_abs(box->at[2]) + box->reach[2];
  return height > 0.0f && height * height > m->half_height * m->half_height * (x * x + z * z);
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
  int steps = GN_SEEN_ONE_STEP;
  for (k = 0u; k < 3u; ++k) {
    centre[k] = 0.5f * (lo[k] + hi[k]) - m->origin[k];
    half_size[k] = 0.5f * (hi[k] - lo[k]);
  }
  if (gn_kind_of(m) != GN_MEASURE_WINDOW) {
    size = 4.0f * gn_dot(half_size, half_size);
    distance = gn_seen_distance_square(m, centre);
    if (!(size < GN_SMALL_SEEN * distance)) steps = size < GN_MIDDLING_SEEN * distance ? GN_SEEN_FEW_STEPS : GN_SEEN_PRECISE;
  }
  if (gn_kind_of(m) == GN_MEASURE_SOLID_ANGLE && !m->culled) return steps;
  box = gn_frame_box(m, centre, half_size);
  if (gn_is_out_of_sight(m, centre, half_size, &box)) return GN_SEEN_NOTHING;
  return gn_is_seen_whole(m, &box) ? steps : GN_SEEN_PRECISE;
}

// Of a box in each lane. how: GN_SEEN_ONE_STEP or GN_SEEN_FEW_STEPS.
GN_INLINE gn_lanes gn_step_measures(const GnMeasure* m, const int how, const GnBoxes* box) {
  return how == GN_SEEN_ONE_STEP ? gn_one_step_measures(m, box) : gn_few_step_measures(m, box);
}

GN_INLINE gn_f32 gn_seen_measure(const GnMeasure* m, int how, const gn_f32* lo, const gn_f32* hi) {
  if (how == GN_SEEN_NOTHING) return 0.0f;
  if (how == GN_SEEN_PRECISE) return gn_precise_measure(m, lo, hi);
  {
    const GnBoxes box = gn_boxes_of(lo, hi);
    return gn_first_lane(gn_step_measures(m, how, &box));
  }
}

#endif
