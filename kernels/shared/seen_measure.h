// The measure of an influence area's rays that meet a box: in one step for boxes that are small seen from the eye and
// inside the window, else precisely, by cutting the faces through which the rays leave the box. Leaving faces, not entered
// ones: a ray meets the box on its way exactly when it leaves it on its way, also when it begins inside.
// The double-precision reference is host/areas/projection.h. Feeds measure_math.h.
#ifndef GNOMON_SHARED_SEEN_MEASURE_H
#define GNOMON_SHARED_SEEN_MEASURE_H

#include "build_layout.h"
#include "polygon_math.h"

// A box counts as small when its diagonal is below 1/10 of its distance: the one-step measures are then right within 1 %.
#define GN_SMALL_SEEN 0.01f  // (1/10)^2

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
  if (m->kind != GN_MEASURE_SOLID_ANGLE || m->culled) {
    count = gn_cut_polygon(a, count, forward, -m->near_distance * unit, b);
    for (i = 0u; i < 3u * count; ++i) a[i] = b[i];
  }
  if (!m->culled) return count;
  for (side = 0u; side < (m->kind == GN_MEASURE_YAW_PITCH ? 2u : 4u); ++side) {
    const gn_f32 half_size = side < 2u ? m->half_width : m->half_height;
    const gn_f32 sign = side % 2u == 0u ? -1.0f : 1.0f;
    gn_f32 plane[3] = {side < 2u ? sign : 0.0f, side < 2u ? 0.0f : sign, 0.0f};
    const int parallel = m->kind == GN_MEASURE_WINDOW;
    plane[2] = parallel ? 0.0f : half_size;
    count = gn_cut_polygon(a, count, plane, parallel ? half_size * unit : 0.0f, b);
    for (i = 0u; i < 3u * count; ++i) a[i] = b[i];
  }
  return count;
}

// Yaw and pitch of a point in the frame, z > 0.
GN_INLINE void gn_yaw_pitch(const gn_f32* p, gn_f32* yaw, gn_f32* pitch) {
  const gn_f32 level = gn_root(p[0] * p[0] + p[2] * p[2]);
  const gn_f32 to_side = gn_angle_of(gn_abs(p[0]), p[2]);
  const gn_f32 to_top = gn_angle_of(gn_abs(p[1]), level);
  *yaw = p[0] < 0.0f ? -to_side : to_side;
  *pitch = p[1] < 0.0f ? -to_top : to_top;
}

// Mean of min(x, limit) over x from a to b.
GN_INLINE gn_f32 gn_mean_below(gn_f32 a, gn_f32 b, gn_f32 limit) {
  const gn_f32 low = gn_min(a, b), high = gn_max(a, b);
  if (high <= limit || high - low < 1e-30f) return gn_min(0.5f * (a + b), limit);
  if (low >= limit) return limit;
  return limit - 0.5f * (limit - low) * (limit - low) * gn_reciprocal(high - low);
}

// Mean of x from a to b, clamped to [-limit, limit].
GN_INLINE gn_f32 gn_mean_clamped(gn_f32 a, gn_f32 b, gn_f32 limit) {
  return gn_mean_below(a, b, limit) - gn_mean_below(-a, -b, limit) - 0.5f * (a + b);
}

// Area in yaw and pitch between one side of the polygon and pitch 0, pitch clamped to the window: summed over all sides
// this is the polygon's area inside the window. A side is a curve there: it is taken in sixteen steps, right within 1 %.
GN_INLINE gn_f32 gn_side_yaw_pitch(const GnMeasure* m, const gn_f32* from, const gn_f32* to) {
  gn_f32 sum = 0.0f, yaw_a, pitch_a;
  gn_u32 step;
  gn_yaw_pitch(from, &yaw_a, &pitch_a);
  for (step = 1u; step <= 16u; ++step) {
    const gn_f32 t = 0.0625f * (gn_f32)step;
    gn_f32 p[3], yaw_b, pitch_b;
    p[0] = from[0] + t * (to[0] - from[0]);
    p[1] = from[1] + t * (to[1] - from[1]);
    p[2] = from[2] + t * (to[2] - from[2]);
    gn_yaw_pitch(p, &yaw_b, &pitch_b);
    sum += gn_mean_clamped(pitch_a, pitch_b, m->half_pitch) * (yaw_b - yaw_a);
    yaw_a = yaw_b;
    pitch_a = pitch_b;
  }
  return sum;
}

GN_INLINE gn_f32 gn_polygon_yaw_pitch(const GnMeasure* m, const gn_f32* polygon, gn_u32 count) {
  gn_f32 sum = 0.0f;
  gn_u32 i;
  if (count < 3u) return 0.0f;
  for (i = 0u; i < count; ++i) sum += gn_side_yaw_pitch(m, polygon + 3u * i, polygon + 3u * (i + 1u == count ? 0u : i + 1u));
  return gn_abs(sum);
}

// What one face, through which rays leave, contributes.
GN_INLINE gn_f32 gn_face_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi, gn_u32 axis, gn_f32 at,
                                 gn_f32 unit) {
  gn_f32 a[3 * GN_MAX_CORNERS], b[3 * GN_MAX_CORNERS];
  gn_u32 count;
  gn_face_polygon(m, lo, hi, axis, at, unit, a);
  count = gn_cut_face(m, unit, a, b);
  if (m->kind == GN_MEASURE_SOLID_ANGLE) return gn_polygon_solid_angle(a, count);
  if (m->kind == GN_MEASURE_YAW_PITCH) return gn_polygon_yaw_pitch(m, a, count);
  if (m->kind == GN_MEASURE_NEAR_PLANE) gn_project_polygon(a, count);
  return gn_polygon_flat_area(a, count);
}

// The precise measure: of all faces through which rays leave.
GN_INLINE gn_f32 gn_precise_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  gn_f32 sum = 0.0f, unit = 1.0f;
  gn_u32 axis;
  const int parallel = m->kind == GN_MEASURE_WINDOW;
  if (!parallel) {
    gn_f32 largest = 0.0f;
    for (axis = 0u; axis < 3u; ++axis) {
      largest = gn_max(largest, gn_max(gn_abs(lo[axis] - m->origin[axis]), gn_abs(hi[axis] - m->origin[axis])));
    }
    unit = gn_power_near_reciprocal(largest);
  }
  for (axis = 0u; axis < 3u; ++axis) {
    // Rays from the origin leave by the upper face where it is ahead of the origin, parallel ones where they go up.
    const int up = parallel ? m->forward[axis] > 0.0f : hi[axis] > m->origin[axis];
    const int down = parallel ? m->forward[axis] < 0.0f : lo[axis] < m->origin[axis];
    if (up) sum += gn_face_measure(m, lo, hi, axis, hi[axis], unit);
    if (down) sum += gn_face_measure(m, lo, hi, axis, lo[axis], unit);
  }
  return sum;
}

// The one-step measure: the box's area as seen along the ray through its middle. Faces on both sides of an axis average to
// |p_k| where the eye is beyond them, and to half the size where it is between them.
GN_INLINE gn_f32 gn_small_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  const gn_f32 dx = hi[0] - lo[0], dy = hi[1] - lo[1], dz = hi[2] - lo[2];
  gn_f32 p[3], area, inverse, level;
  p[0] = 0.5f * (lo[0] + hi[0]) - m->origin[0];
  p[1] = 0.5f * (lo[1] + hi[1]) - m->origin[1];
  p[2] = 0.5f * (lo[2] + hi[2]) - m->origin[2];
  if (m->kind == GN_MEASURE_WINDOW) {
    return gn_abs(m->forward[0]) * dy * dz + dx * (gn_abs(m->forward[1]) * dz + gn_abs(m->forward[2]) * dy);
  }
  inverse = m->kind == GN_MEASURE_NEAR_PLANE ? gn_reciprocal(gn_max(gn_dot(p, m->forward), 1e-30f))
                                             : gn_reciprocal_root(gn_max(gn_dot(p, p), 1e-30f));
  level = gn_dot(p, m->up) * inverse;
  p[0] = gn_max(gn_abs(p[0]), 0.5f * dx) * inverse;
  p[1] = gn_max(gn_abs(p[1]), 0.5f * dy) * inverse;
  p[2] = gn_max(gn_abs(p[2]), 0.5f * dz) * inverse;
  area = (p[0] * dy * dz + dx * (p[1] * dz + p[2] * dy)) * inverse * inverse;
  if (m->kind != GN_MEASURE_YAW_PITCH) return area;
  // dyaw dpitch = solid angle / cos(pitch)
  return area * gn_reciprocal_root(gn_max(1.0f - level * level, 1e-12f));
}

// The square of the distance that the density of rays depends on: from the eye, along forward, or from the up axis.
GN_INLINE gn_f32 gn_seen_distance_square(const GnMeasure* m, const gn_f32* p) {
  const gn_f32 along = gn_dot(p, m->forward), above = gn_dot(p, m->up);
  if (m->kind == GN_MEASURE_NEAR_PLANE) return along * along;
  return gn_dot(p, p) - (m->kind == GN_MEASURE_YAW_PITCH ? above * above : 0.0f);
}

// Whether no ray can meet the box: all of it lies beyond one side of the window, or behind where rays begin. centre is
// seen from the origin.
GN_INLINE int gn_is_out_of_sight(const GnMeasure* m, const gn_f32* centre, const gn_f32* half_size) {
  const int parallel = m->kind == GN_MEASURE_WINDOW;
  gn_u32 side, k;
  if (!m->culled) return 0;
  for (side = 0u; side < 5u; ++side) {
    const int across = side < 2u, begins = side == 4u;
    const gn_f32 sign = side % 2u == 0u ? 1.0f : -1.0f;
    const gn_f32 window = across ? m->half_width : m->half_height;
    gn_f32 distance = begins ? m->near_distance : parallel ? -window : 0.0f, reach = 0.0f;
    if (m->kind == GN_MEASURE_YAW_PITCH && !across && !begins) continue;  // these sides are cones
    for (k = 0u; k < 3u; ++k) {
      const gn_f32 outwards = begins ? -m->forward[k]
                                     : sign * (across ? m->right[k] : m->up[k]) - (parallel ? 0.0f : window * m->forward[k]);
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

// How the boxes of a node must be measured: precisely where it is large as seen from the eye, or not all of it is inside
// the window and ahead of where rays begin.
GN_INLINE int gn_seen_how(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  gn_f32 centre[3], half_size[3], at[3], reach[3];
  gn_u32 k;
  if (m->kind == GN_MEASURE_LINEAR) return 0;
  for (k = 0u; k < 3u; ++k) {
    centre[k] = 0.5f * (lo[k] + hi[k]) - m->origin[k];
    half_size[k] = 0.5f * (hi[k] - lo[k]);
  }
  if (gn_is_out_of_sight(m, centre, half_size)) return GN_SEEN_NOTHING;
  if (m->kind != GN_MEASURE_WINDOW &&
      !(4.0f * gn_dot(half_size, half_size) < GN_SMALL_SEEN * gn_seen_distance_square(m, centre))) {
    return 1;
  }
  if (m->kind == GN_MEASURE_SOLID_ANGLE && !m->culled) return 0;
  at[0] = gn_dot(centre, m->right);
  at[1] = gn_dot(centre, m->up);
  at[2] = gn_dot(centre, m->forward);
  reach[0] = gn_abs(m->right[0]) * half_size[0] + gn_abs(m->right[1]) * half_size[1] + gn_abs(m->right[2]) * half_size[2];
  reach[1] = gn_abs(m->up[0]) * half_size[0] + gn_abs(m->up[1]) * half_size[1] + gn_abs(m->up[2]) * half_size[2];
  reach[2] = gn_abs(m->forward[0]) * half_size[0] + gn_abs(m->forward[1]) * half_size[1] + gn_abs(m->forward[2]) * half_size[2];
  if (!(at[2] - reach[2] >= m->near_distance)) return 1;
  if (!m->culled) return 0;
  {
    const gn_f32 depth = m->kind == GN_MEASURE_WINDOW ? 1.0f : at[2] - reach[2];
    return !(gn_abs(at[0]) + reach[0] <= m->half_width * depth && gn_abs(at[1]) + reach[1] <= m->half_height * depth);
  }
}

GN_INLINE gn_f32 gn_seen_measure(const GnMeasure* m, int how, const gn_f32* lo, const gn_f32* hi) {
  if (how == GN_SEEN_NOTHING) return 0.0f;
  return how == GN_SEEN_PRECISE ? gn_precise_measure(m, lo, hi) : gn_small_measure(m, lo, hi);
}

#endif
