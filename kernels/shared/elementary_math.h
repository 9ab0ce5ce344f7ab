// Reciprocals, roots and angles from additions, multiplications and integer steps alone: the same bits on every device,
// where division and the library's functions may round as they like. Errors are a few ulp, enough to weigh boxes, not to
// decide hits. Feeds cost_math.h and the measures.
#ifndef GNOMON_SHARED_ELEMENTARY_MATH_H
#define GNOMON_SHARED_ELEMENTARY_MATH_H

#include "scalar.h"

// 1 / x for normal x > 0 within 2 ulp: a first guess from the exponent, then Newton's steps. Scaling x by a power of two
// scales the result exactly.
GN_INLINE gn_f32 gn_reciprocal(gn_f32 x) {
  gn_f32 r = gn_float_of(0x7ef311c7u - gn_bits_of(x));
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  r = r * (2.0f - x * r);
  return r;
}

// 1 / sqrt(x) for normal x > 0 within 5e-6, likewise: one of Newton's steps less.
GN_INLINE gn_f32 gn_rough_reciprocal_root(gn_f32 x) {
  const gn_f32 half_x = 0.5f * x;
  gn_f32 r = gn_float_of(0x5f375a86u - (gn_bits_of(x) >> 1));
  r = r * (1.5f - half_x * r * r);
  r = r * (1.5f - half_x * r * r);
  return r;
}

// 1 / sqrt(x) for normal x > 0 within 4 ulp.
GN_INLINE gn_f32 gn_reciprocal_root(gn_f32 x) {
  const gn_f32 r = gn_rough_reciprocal_root(x);
  return r * (1.5f - 0.5f * x * r * r);
}

// sqrt(x) for x >= 0; what is below the smallest normal number counts as 0.
GN_INLINE gn_f32 gn_root(gn_f32 x) { return x < 1.17549435e-38f ? 0.0f : x * gn_reciprocal_root(x); }

// The power of two that brings x near 1, within float's normal range.
GN_INLINE gn_f32 gn_power_near_reciprocal(gn_f32 x) {
  const gn_u32 exponent = gn_bits_of(x) & 0x7f800000u;
  if (exponent == 0u) return gn_float_of(0x7e800000u);  // 2^126
  return gn_float_of(exponent >= 0x7e800000u ? 0x00800000u : 0x7f000000u - exponent);
}

// The angle of (x, y) in radians, y >= 0: from 0 to pi; 0 for the origin. Relative error 2^-21. The octant is brought to
// |q| <= tan(pi/8); there atan(q)/q is a polynomial in q^2 (interpolated at Chebyshev's nodes, error 2^-27).
GN_INLINE gn_f32 gn_angle_of(gn_f32 y, gn_f32 x) {
  const gn_f32 a = gn_abs(x);
  const gn_f32 larger = gn_max(a, y), smaller = gn_min(a, y);
  gn_f32 q, z, angle, offset = 0.0f;
  if (larger < 1.17549435e-38f) return 0.0f;
  if (smaller > 0.41421357f * larger) {
    q = (smaller - larger) * gn_reciprocal(smaller + larger);
    offset = 0.78539819f;
  } else {
    q = smaller * gn_reciprocal(larger);
  }
  z = q * q;
  angle = 0.079762918f;
  angle = angle * z - 0.13848490f;
  angle = angle * z + 0.19974082f;
  angle = angle * z - 0.33332786f;
  angle = offset + (angle * z * q + q);
  if (y > a) angle = 1.5707964f - angle;
  return x < 0.0f ? 3.1415927f - angle : angle;
}

GN_INLINE gn_f32 gn_dot(const gn_f32* a, const gn_f32* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

#endif
