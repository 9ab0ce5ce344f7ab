// What one side of a polygon contributes to its area inside a window: the area between the side and a level line, both
// cut to the window. Summed over all sides, in turn, this is the polygon's area there, as Green's theorem has it: cutting a
// region to a band is clamping the integrand. No divisions by devices' own rules (elementary_math.h).
// Feeds outline_measure.h and seen_measure.h.
#ifndef GNOMON_SHARED_SIDE_MATH_H
#define GNOMON_SHARED_SIDE_MATH_H

#include "elementary_math.h"

// Mean of min(x, limit) over x from a to b.
GN_INLINE gn_f32 gn_mean_below(gn_f32 a, gn_f32 b, gn_f32 limit) {
  const gn_f32 low = gn_min(a, b), high = gn_max(a, b);
  if (high <= limit || high - low < 1e-30f) return gn_min(0.5f * (a + b), limit);
  if (low >= limit) return limit;
  return limit - 0.5f * (limit - low) * (limit - low) * gn_reciprocal(high - low);
}

// Mean of x from a to b, clamped to [low, high].
GN_INLINE gn_f32 gn_mean_within(gn_f32 a, gn_f32 b, gn_f32 low, gn_f32 high) {
  return gn_mean_below(a, b, high) - gn_mean_below(-a, -b, -low) - 0.5f * (a + b);
}

// x clamped to [low, high].
GN_INLINE gn_f32 gn_within(gn_f32 x, gn_f32 low, gn_f32 high) { return gn_max(gn_min(x, high), low); }

// Area between the straight side from a to b (x, y) and y = 0, x clamped to [-half_width, half_width], y to [low, high].
GN_INLINE gn_f32 gn_side_area(const gn_f32* a, const gn_f32* b, gn_f32 half_width, gn_f32 low, gn_f32 high) {
  const gn_f32 from = gn_within(a[0], -half_width, half_width), to = gn_within(b[0], -half_width, half_width);
  gn_f32 y_from = a[1], y_to = b[1];
  if (from == to) return 0.0f;
  if (from != a[0] || to != b[0]) {
    const gn_f32 run = gn_abs(b[0] - a[0]);
    const gn_f32 slope = run < 1.17549435e-38f ? 0.0f : (b[1] - a[1]) * gn_reciprocal(run);
    y_from = a[1] + slope * gn_abs(from - a[0]);
    y_to = b[1] - slope * gn_abs(b[0] - to);
  }
  return gn_mean_within(y_from, y_to, low, high) * (to - from);
}

// A point in the frame, z > 0, as seen from the eye: its distance from the up axis, and two angles.
typedef struct GnSight {
  gn_f32 level;
  gn_f32 yaw;
  gn_f32 pitch;
} GnSight;

// Sights of four points, x y z after one another.
GN_INLINE void gn_four_sights(const gn_f32* points, GnSight* sights) {
  gn_f32 square[4], level[4], z[4], aside[4], height[4], yaw[4], pitch[4];
  gn_u32 i;
  for (i = 0u; i < 4u; ++i) {
    const gn_f32* p = points + 3u * i;
    square[i] = p[0] * p[0] + p[2] * p[2];
    aside[i] = gn_abs(p[0]);
    height[i] = gn_abs(p[1]);
    z[i] = p[2];
  }
  gn_four_roots(square, level);
  gn_four_angles(aside, z, yaw);
  gn_four_angles(height, level, pitch);
  for (i = 0u; i < 4u; ++i) {
    sights[i].level = level[i];
    sights[i].yaw = points[3u * i] < 0.0f ? -yaw[i] : yaw[i];
    sights[i].pitch = points[3u * i + 1u] < 0.0f ? -pitch[i] : pitch[i];
  }
}

GN_INLINE GnSight gn_sight_of(const gn_f32* p) {
  GnSight sight;
  gn_f32 to_side, to_top;
  sight.level = gn_root(p[0] * p[0] + p[2] * p[2]);
  to_side = gn_angle_of(gn_abs(p[0]), p[2]);
  to_top = gn_angle_of(gn_abs(p[1]), sight.level);
  sight.yaw = p[0] < 0.0f ? -to_side : to_side;
  sight.pitch = p[1] < 0.0f ? -to_top : to_top;
  return sight;
}

// Area in yaw and pitch between one side of the polygon and pitch 0, pitch clamped to the window: summed over all sides
// this is the polygon's area inside the window. A side is a curve there: it is taken in up to sixteen steps, none longer
// than a quarter of its distance unless sixteen are. Where the window leaves the curve alone, twice as long steps tell how
// far off these are (Richardson's extrapolation). Right within 1 %. a, b: its ends' sights.
GN_INLINE gn_f32 gn_side_yaw_pitch(gn_f32 half_pitch, const gn_f32* from, const GnSight* a, const gn_f32* to,
                                   const GnSight* b) {
  const gn_f32 d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  const gn_f32 near_level = 0.25f * gn_min(a->level, b->level);
  gn_f32 share = 1.0f, left = gn_dot(d, d), sum = 0.0f, coarse = 0.0f, highest = gn_max(gn_abs(a->pitch), gn_abs(b->pitch));
  GnSight last = *a, last_but_one = *a, next[4];
  gn_u32 steps = 1u, step;
  // Between two ends beyond the same limit a side's pitch is beyond it too: tan(pitch) goes like a cosine of yaw.
  const int beyond = gn_min(a->pitch, b->pitch) >= half_pitch || gn_max(a->pitch, b->pitch) <= -half_pitch;
  while (!beyond && steps < 16u && left > near_level * near_level) {
    steps *= 2u;
    share *= 0.5f;
    left *= 0.25f;
  }
  if (steps == 1u) return gn_mean_within(a->pitch, b->pitch, -half_pitch, half_pitch) * (b->yaw - a->yaw);
  for (step = 0u; step < steps; ++step) {
    const gn_u32 turn = step % 4u;
    if (turn == 0u) {
      gn_f32 points[3 * 4];
      gn_u32 i;
      for (i = 0u; i < 12u; ++i) points[i] = from[i % 3u] + share * (gn_f32)(step + i / 3u + 1u) * d[i % 3u];
      gn_four_sights(points, next);
    }
    if (step + 1u == steps) next[turn] = *b;
    sum += gn_mean_within(last.pitch, next[turn].pitch, -half_pitch, half_pitch) * (next[turn].yaw - last.yaw);
    if (step % 2u == 1u) {
      coarse += 0.5f * (last_but_one.pitch + next[turn].pitch) * (next[turn].yaw - last_but_one.yaw);
      last_but_one = next[turn];
    }
    highest = gn_max(highest, gn_abs(next[turn].pitch));
    last = next[turn];
  }
  return highest > half_pitch ? sum : sum + 0.33333334f * (sum - coarse);
}

GN_INLINE gn_f32 gn_polygon_yaw_pitch(gn_f32 half_pitch, const gn_f32* polygon, gn_u32 count) {
  gn_f32 sum = 0.0f;
  GnSight first, from;
  gn_u32 i;
  if (count < 3u) return 0.0f;
  first = gn_sight_of(polygon);
  from = first;
  for (i = 1u; i <= count; ++i) {
    const gn_f32* corner = polygon + 3u * (i == count ? 0u : i);
    const GnSight to = i == count ? first : gn_sight_of(corner);
    sum += gn_side_yaw_pitch(half_pitch, polygon + 3u * (i - 1u), &from, corner, &to);
    from = to;
  }
  return gn_abs(sum);
}

#endif
