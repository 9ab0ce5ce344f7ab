// The precise measure of a box that lies wholly ahead of where rays begin: its area inside the window as seen from the eye,
// from its outline alone. An edge is on the outline where rays leave by one of its two faces; there are four or six of
// them. No polygon is cut. Not for solid angles or parallel rays (whole_angle.h, window_measure.h), nor for boxes around or
// beside the eye (seen_measure.h).
// Feeds seen_measure.h.
#ifndef GNOMON_SHARED_OUTLINE_MEASURE_H
#define GNOMON_SHARED_OUTLINE_MEASURE_H

#include "build_layout.h"
#include "side_math.h"

// Whether rays leave the box by its upper or lower face across the axis: rays from the origin by the upper one where it is
// ahead of the origin, parallel ones where they go up.
GN_INLINE int gn_leaves_by(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi, gn_u32 axis, int upper) {
  if (gn_kind_of(m) == GN_MEASURE_WINDOW) return upper ? m->forward[axis] > 0.0f : m->forward[axis] < 0.0f;
  return upper ? hi[axis] > m->origin[axis] : lo[axis] < m->origin[axis];
}

// A box in the area's frame: a corner is the sum of one of two vectors for each axis (at[2 k] lower, at[2 k + 1] upper).
typedef struct GnOutline {
  gn_f32 at[6][3];
  gn_u32 leaves;  // bit 2 k + 1: rays leave by the upper face across axis k; 2 k: by the lower
  gn_u32 ahead;   // 1: all of the box is ahead of where rays begin
} GnOutline;

GN_INLINE GnOutline gn_outline_of(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi, gn_f32 unit) {
  GnOutline outline;
  gn_f32 nearest = 0.0f;
  gn_u32 k;
  outline.leaves = 0u;
  for (k = 0u; k < 3u; ++k) {
    const gn_f32 low = (lo[k] - m->origin[k]) * unit, high = (hi[k] - m->origin[k]) * unit;
    outline.at[2u * k][0] = low * m->right[k];
    outline.at[2u * k][1] = low * m->up[k];
    outline.at[2u * k][2] = low * m->forward[k];
    outline.at[2u * k + 1u][0] = high * m->right[k];
    outline.at[2u * k + 1u][1] = high * m->up[k];
    outline.at[2u * k + 1u][2] = high * m->forward[k];
    nearest += gn_min(outline.at[2u * k][2], outline.at[2u * k + 1u][2]);
    if (gn_leaves_by(m, lo, hi, k, 0)) outline.leaves |= 1u << (2u * k);
    if (gn_leaves_by(m, lo, hi, k, 1)) outline.leaves |= 2u << (2u * k);
  }
  outline.ahead = nearest >= m->near_distance * unit && (gn_kind_of(m) == GN_MEASURE_WINDOW || nearest > 1e-6f) ? 1u : 0u;
  return outline;
}

// The corner as the measure sees it: near-plane areas at distance 1, yaw and pitch in space.
GN_INLINE void gn_outline_corner(const GnMeasure* m, const GnOutline* outline, gn_u32 a, gn_u32 b, gn_u32 c, gn_f32* p) {
  gn_u32 i;
  for (i = 0u; i < 3u; ++i) p[i] = outline->at[a][i] + outline->at[b][i] + outline->at[c][i];
  if (gn_kind_of(m) == GN_MEASURE_NEAR_PLANE) {
    const gn_f32 scale = gn_reciprocal(p[2]);
    p[0] *= scale;
    p[1] *= scale;
  }
}

// Area in yaw and pitch between the side and pitch 0, cut to the window. The upright sides of the window are planes through
// the up axis: what lies beyond adds nothing. of_a, of_b: its ends' sights.
GN_INLINE gn_f32 gn_cut_side_yaw_pitch(const GnMeasure* m, const gn_f32* a, const GnSight* of_a, const gn_f32* b,
                                       const GnSight* of_b) {
  gn_f32 from = 0.0f, to = 1.0f, p[3], q[3];
  GnSight at_p = *of_a, at_q = *of_b;
  gn_u32 i;
  for (i = 0u; i < 2u; ++i) {
    const gn_f32 sign = i == 0u ? 1.0f : -1.0f;
    const gn_f32 at_a = m->half_width * a[2] - sign * a[0];
    const gn_f32 at_b = m->half_width * b[2] - sign * b[0];
    if (at_a < 0.0f && at_b < 0.0f) return 0.0f;
    if (at_a < 0.0f || at_b < 0.0f) {
      const gn_f32 t = gn_abs(at_a) * gn_reciprocal(gn_max(gn_abs(at_a) + gn_abs(at_b), 1.17549435e-38f));
      if (at_a < 0.0f) from = gn_max(from, t);
      else to = gn_min(to, t);
    }
  }
  if (!(from < to)) return 0.0f;
  for (i = 0u; i < 3u; ++i) {
    p[i] = a[i] + from * (b[i] - a[i]);
    q[i] = to < 1.0f ? a[i] + to * (b[i] - a[i]) : b[i];
  }
  if (from > 0.0f) at_p = gn_sight_of(p);
  if (to < 1.0f) at_q = gn_sight_of(q);
  return gn_side_yaw_pitch(m->half_pitch, p, &at_p, q, &at_q);
}

// The measure of what the outline holds. Heights are taken from one of its corners: those of small boxes keep their digits.
GN_INLINE gn_f32 gn_outline_measure(const GnMeasure* m, const GnOutline* outline) {
  const gn_f32 half_width = m->culled ? m->half_width : GN_FLOAT_MAX;
  const gn_f32 half_height = m->culled ? m->half_height : GN_FLOAT_MAX;
  const int by_angles = gn_kind_of(m) == GN_MEASURE_YAW_PITCH;
  gn_f32 corners[3 * 8], sum = 0.0f, level = 0.0f;
  GnSight sights[8];
  gn_u32 i, edge;
  for (i = 0u; i < 8u; ++i) gn_outline_corner(m, outline, i & 1u, 2u + (i >> 1u & 1u), 4u + (i >> 2u), corners + 3u * i);
  if (by_angles) {
    gn_four_sights(corners, sights);
    gn_four_sights(corners + 12, sights + 4);
  } else {
    level = gn_within(corners[1], -half_height, half_height);
  }
  for (i = 0u; i < 8u; ++i) corners[3u * i + 1u] -= level;
  for (edge = 0u; edge < 12u; ++edge) {
    const gn_u32 k = edge >> 2u, u = k == 2u ? 0u : k + 1u, v = u == 2u ? 0u : u + 1u;
    const gn_u32 at_u = 2u * u + (edge & 1u), at_v = 2u * v + (edge >> 1u & 1u);
    const gn_u32 by_u = outline->leaves >> at_u & 1u, by_v = outline->leaves >> at_v & 1u;
    const gn_u32 lower = (edge & 1u) << u | (edge >> 1u & 1u) << v, upper = lower | 1u << k;
    gn_f32* a = corners + 3u * lower;
    gn_f32* b = corners + 3u * upper;
    gn_f32 part;
    if (by_u == by_v) continue;
    if (by_angles) {
      part = gn_cut_side_yaw_pitch(m, a, &sights[lower], b, &sights[upper]);
    } else {
      part = gn_side_area(a, b, half_width, -half_height - level, half_height - level);
    }
    // Around a face, seen from outside, its edges along an axis go up on one side and down on the other.
    if ((at_u + at_v + by_u) % 2u != 0u) part = -part;
    sum += part;
  }
  return gn_abs(sum);
}

#endif
