// Reciprocals, roots and angles from additions, multiplications and integer steps alone: the same bits on every device,
// where division and the library's functions may round as they like. Errors are a few ulp, enough to weigh boxes, not to
// decide hits. Feeds cost_math.h and the measures.
#ifndef GNOMON_SHARED_ELEMENTARY_MATH_H
#define GNOMON_SHARED_ELEMENTARY_MATH_H

#include "lanes.h"

// 1 / x for normal x > 0 within 2 ulp: a first guess from the exponent, then Newton's steps. Scaling x by a power of two
// scales the result exactly.
GN_INLINE gn_lanes gn_reciprocals(gn_lanes x) {
  gn_lanes r = gn_lanes_of_bits(0x7ef311c7u - gn_bits_of_lanes(x));
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  return r;
}

// 1 / sqrt(x) for normal x > 0 within 5e-6, likewise: one of Newton's steps less.
GN_INLINE gn_lanes gn_rough_reciprocal_roots(gn_lanes x) {
  const gn_lanes half_x = 0.5f * x;
  gn_lanes r = gn_lanes_of_bits(0x5f375a86u - (gn_bits_of_lanes(x) >> 1));
  r = r * (1.5f - half_x * r * r);
  r = r * (1.5f - half_x * r * r);
  return r;
}

// 1 / sqrt(x) for normal x > 0 within 4 ulp.
GN_INLINE gn_lanes gn_reciprocal_roots(gn_lanes x) {
  const gn_lanes r = gn_rough_reciprocal_roots(x);
  return r * (1.5f - 0.5f * x * r * r);
}

// sqrt(x) for x >= 0; what is below the smallest normal number counts as 0.
GN_INLINE gn_lanes gn_roots(gn_lanes x) { return x < 1.17549435e-38f ? GN_ALL(0.0f) : x * gn_reciprocal_roots(x); }

// The power of two that brings x near 1, within float's normal range.
GN_INLINE gn_lanes gn_powers_near_reciprocal(gn_lanes x) {
  const gn_lane_bits exponent = gn_bits_of_lanes(x) & 0x7f800000u;
  const gn_lane_bits power = exponent >= 0x7e800000u ? GN_ALL_BITS(0x00800000u) : 0x7f000000u - exponent;
  return gn_lanes_of_bits(exponent == 0u ? GN_ALL_BITS(0x7e800000u) : power);  // 2^126
}

// The angle of (x, y) in radians, y >= 0: from 0 to pi; 0 for the origin. Relative error 2^-21. The octant is brought to
// |q| <= tan(pi/8); there atan(q)/q is a polynomial in q^2 (interpolated at Chebyshev's nodes, error 2^-27).
GN_INLINE gn_lanes gn_angles_of(gn_lanes y, gn_lanes x) {
  const gn_lanes a = gn_lanes_abs(x);
  const gn_lanes larger = gn_lanes_max(a, y), smaller = gn_lanes_min(a, y);
  const gn_lane_mask turned = smaller > 0.41421357f * larger;
  const gn_lanes above = turned ? smaller - larger : smaller;
  const gn_lanes q = above * gn_reciprocals(turned ? smaller + larger : larger);
  const gn_lanes z = q * q;
  gn_lanes angle = GN_ALL(0.079762918f);
  angle = angle * z - 0.13848490f;
  angle = angle * z + 0.19974082f;
  angle = angle * z - 0.33332786f;
  angle = (turned ? GN_ALL(0.78539819f) : GN_ALL(0.0f)) + (angle * z * q + q);
  angle = y > a ? 1.5707964f - angle : angle;
  angle = x < 0.0f ? 3.1415927f - angle : angle;
  return larger < 1.17549435e-38f ? GN_ALL(0.0f) : angle;
}

// The same of one number.
GN_INLINE gn_f32 gn_reciprocal(gn_f32 x) { return gn_first_lane(gn_reciprocals(GN_ALL(x))); }
GN_INLINE gn_f32 gn_rough_reciprocal_root(gn_f32 x) { return gn_first_lane(gn_rough_reciprocal_roots(GN_ALL(x))); }
GN_INLINE gn_f32 gn_reciprocal_root(gn_f32 x) { return gn_first_lane(gn_reciprocal_roots(GN_ALL(x))); }
GN_INLINE gn_f32 gn_root(gn_f32 x) { return gn_first_lane(gn_roots(GN_ALL(x))); }
GN_INLINE gn_f32 gn_power_near_reciprocal(gn_f32 x) { return gn_first_lane(gn_powers_near_reciprocal(GN_ALL(x))); }
GN_INLINE gn_f32 gn_angle_of(gn_f32 y, gn_f32 x) { return gn_first_lane(gn_angles_of(GN_ALL(y), GN_ALL(x))); }

// Roots and angles of four numbers, as above.
GN_INLINE void gn_four_roots(const gn_f32* x, gn_f32* root) {
#if GN_HAS_LANES
  vstore4(gn_roots(vload4(0, x)), 0, root);
#else
  gn_u32 i;
  for (i = 0u; i < 4u; ++i) root[i] = gn_root(x[i]);
#endif
}

GN_INLINE void gn_four_angles(const gn_f32* y, const gn_f32* x, gn_f32* angle) {
#if GN_HAS_LANES
  vstore4(gn_angles_of(vload4(0, y), vload4(0, x)), 0, angle);
#else
  gn_u32 i;
  for (i = 0u; i < 4u; ++i) angle[i] = gn_angle_of(y[i], x[i]);
#endif
}

GN_INLINE gn_f32 gn_dot(const gn_f32* a, const gn_f32* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

GN_INLINE gn_lanes gn_lanes_dot(const gn_lanes* a, const gn_f32* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

#endif
