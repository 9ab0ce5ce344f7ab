// The solid angle of boxes that no window cuts, in every lane at once, however large they are: the sum of those of the
// faces by which rays enter, at most three. Feeds seen_measure.h.
#ifndef GNOMON_SHARED_WHOLE_ANGLE_H
#define GNOMON_SHARED_WHOLE_ANGLE_H

#include "build_layout.h"
#include "elementary_math.h"

// Half the solid angle of a rectangle at a height above the eye, from u[0] to u[1] by v[0] to v[1], as an angle's
// direction: the product of two triangles' (Van Oosterom & Strackee 1983), which divide it along the diagonal from corner
// 0. Their triple product is the height times twice their area: small rectangles lose no digits.
GN_LANES_INLINE gn_lanes gn_rectangle_solid_angles(gn_lanes height, const gn_lanes* u, const gn_lanes* v) {
  const gn_lanes square = height * height;
  const gn_lanes volume = height * ((u[1] - u[0]) * (v[1] - v[0]));
  const gn_lanes u00 = u[0] * u[0], u01 = u[0] * u[1], u11 = u[1] * u[1];
  const gn_lanes v00 = v[0] * v[0], v01 = v[0] * v[1], v11 = v[1] * v[1];
  // Corners, around: a (u0, v0), b (u1, v0), c (u1, v1), d (u0, v1).
  const gn_lanes a = gn_roots(square + u00 + v00), b = gn_roots(square + u11 + v00);
  const gn_lanes c = gn_roots(square + u11 + v11), d = gn_roots(square + u00 + v11);
  const gn_lanes ab = square + u01 + v00, bc = square + u11 + v01, ca = square + u01 + v01;
  const gn_lanes cd = square + u01 + v11, da = square + u00 + v01;
  const gn_lanes one = a * b * c + ab * c + bc * a + ca * b;
  const gn_lanes other = a * c * d + cd * a + da * c + ca * d;
  const gn_lanes x = one * other - volume * volume, y = volume * (one + other);
  return 2.0f * gn_angles_of(gn_lanes_max(y, GN_ALL(0.0f)), x);
}

// 4 pi where the eye is inside the box or on it.
GN_LANES_INLINE gn_lanes gn_whole_solid_angles(const GnMeasure* m, const GnBoxes* box) {
  gn_lanes at[3][2], largest = GN_ALL(0.0f), unit, sum = GN_ALL(0.0f);
  gn_lane_mask inside = GN_ALL(0.0f) == 0.0f;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) {
    at[k][0] = box->lo[k] - m->origin[k];
    at[k][1] = box->hi[k] - m->origin[k];
    largest = gn_lanes_max(largest, gn_lanes_max(gn_lanes_abs(at[k][0]), gn_lanes_abs(at[k][1])));
  }
  unit = gn_powers_near_reciprocal(largest);
  for (k = 0u; k < 3u; ++k) {
    at[k][0] = at[k][0] * unit;
    at[k][1] = at[k][1] * unit;
  }
  for (k = 0u; k < 3u; ++k) {
    const gn_u32 u = k == 2u ? 0u : k + 1u, v = u == 2u ? 0u : u + 1u;
    const gn_lane_mask enters = (at[k][0] > 0.0f) | (at[k][1] < 0.0f);
    const gn_lanes nearer = gn_lanes_min(gn_lanes_abs(at[k][0]), gn_lanes_abs(at[k][1]));
    sum = sum +
          gn_rectangle_solid_angles(enters ? nearer : GN_ALL(0.0f), at[u], at[v]) * (enters ? GN_ALL(1.0f) : GN_ALL(0.0f));
    inside = inside & ((at[k][0] <= 0.0f) & (at[k][1] >= 0.0f));
  }
  return inside ? GN_ALL(12.566371f) : sum;
}

#endif
