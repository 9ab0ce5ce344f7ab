// Arithmetic wide enough that a hit's float result is right to the last bit or so: double where the device has it,
// elsewhere pairs of floats (about 46 bits; Dekker 1971, Knuth's two-sum). No fused operations are assumed.
// Feeds hit_math.h alone.
#ifndef GNOMON_SHARED_WIDE_MATH_H
#define GNOMON_SHARED_WIDE_MATH_H

#include "elementary_math.h"

#if GN_HAS_FP64

typedef double GnWide;
// Relative error of a three-by-three determinant of differences, with a margin: 8 x 2^-53 of its permanent.
#define GN_WIDE_EPSILON 2e-15

GN_INLINE GnWide gn_wide_difference(gn_f32 a, gn_f32 b) { return (double)a - (double)b; }
GN_INLINE GnWide gn_wide_add(GnWide a, GnWide b) { return a + b; }
GN_INLINE GnWide gn_wide_subtract(GnWide a, GnWide b) { return a - b; }
GN_INLINE GnWide gn_wide_multiply(GnWide a, GnWide b) { return a * b; }
GN_INLINE GnWide gn_wide_scale(GnWide a, gn_f32 b) { return a * (double)b; }
GN_INLINE GnWide gn_wide_abs(GnWide a) { return fabs(a); }
GN_INLINE GnWide gn_wide_of(gn_f32 a) { return (double)a; }
GN_INLINE int gn_wide_sign(GnWide a) { return (a > 0.0) - (a < 0.0); }
// Whether |a| exceeds the error bound of a value with this permanent.
GN_INLINE int gn_wide_is_certain(GnWide a, GnWide permanent) { return fabs(a) > GN_WIDE_EPSILON * permanent; }
GN_INLINE gn_f32 gn_wide_ratio(GnWide a, GnWide b) { return (gn_f32)(a / b); }
// Products of four floats stay far inside double's range: nothing needs scaling.
GN_INLINE gn_f32 gn_wide_unit(gn_f32 x) {
  (void)x;
  return 1.0f;
}
GN_INLINE GnWide gn_wide_times_unit(GnWide a, gn_f32 unit) {
  (void)unit;
  return a;
}

#else

typedef struct GnWide {
  gn_f32 high;
  gn_f32 low;  // |low| <= ulp(high) / 2
} GnWide;

GN_INLINE GnWide gn_wide_of(gn_f32 a) {
  GnWide r;
  r.high = a;
  r.low = 0.0f;
  return r;
}

// a + b exactly, as a pair.
GN_INLINE GnWide gn_two_sum(gn_f32 a, gn_f32 b) {
  GnWide r;
  gn_f32 virtual_a, virtual_b;
  r.high = a + b;
  virtual_b = r.high - a;
  virtual_a = r.high - virtual_b;
  r.low = (a - virtual_a) + (b - virtual_b);
  return r;
}

// The upper 12 bits of a float; what is left has 12 too (Veltkamp).
GN_INLINE gn_f32 gn_upper_half(gn_f32 a) {
  const gn_f32 c = a * 4097.0f;  // 2^12 + 1
  return c - (c - a);
}

// a * b exactly, as a pair, unless the low part underflows.
GN_INLINE GnWide gn_two_product(gn_f32 a, gn_f32 b) {
  const gn_f32 a_high = gn_upper_half(a), a_low = a - a_high;
  const gn_f32 b_high = gn_upper_half(b), b_low = b - b_high;
  GnWide r;
  r.high = a * b;
  r.low = (a_high * b_high) - r.high;
  r.low = r.low + (a_high * b_low);
  r.low = r.low + (a_low * b_high);
  r.low = r.low + (a_low * b_low);
  return r;
}

GN_INLINE GnWide gn_wide_difference(gn_f32 a, gn_f32 b) { return gn_two_sum(a, -b); }

GN_INLINE GnWide gn_wide_add(GnWide a, GnWide b) {
  GnWide high = gn_two_sum(a.high, b.high);
  const GnWide low = gn_two_sum(a.low, b.low);
  high = gn_two_sum(high.high, high.low + low.high);
  return gn_two_sum(high.high, high.low + low.low);
}

// Parameters are never changed: one OpenCL compiler (Mesa 22.3) lets such a change reach the caller's copy.
GN_INLINE GnWide gn_wide_subtract(GnWide a, GnWide b) {
  GnWide negative;
  negative.high = -b.high;
  negative.low = -b.low;
  return gn_wide_add(a, negative);
}

GN_INLINE GnWide gn_wide_multiply(GnWide a, GnWide b) {
  const GnWide product = gn_two_product(a.high, b.high);
  return gn_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

GN_INLINE GnWide gn_wide_scale(GnWide a, gn_f32 b) { return gn_wide_multiply(a, gn_wide_of(b)); }

GN_INLINE GnWide gn_wide_abs(GnWide a) {
  const GnWide zero = gn_wide_of(0.0f);
  return a.high < 0.0f ? gn_wide_subtract(zero, a) : a;
}

GN_INLINE int gn_wide_sign(GnWide a) { return (a.high > 0.0f) - (a.high < 0.0f); }

// 2^-40 of the permanent covers the determinant's rounding; 1e-33 covers low parts lost to underflow.
GN_INLINE int gn_wide_is_certain(GnWide a, GnWide permanent) {
  return gn_abs(a.high) > 9.0949470e-13f * permanent.high + 1e-33f;
}

// Products of three coordinates of 2^48 would overflow, of 2^-48 would lose their low parts.
GN_INLINE gn_f32 gn_wide_unit(gn_f32 x) { return gn_power_near_reciprocal(x); }

GN_INLINE GnWide gn_wide_times_unit(GnWide a, gn_f32 unit) {
  GnWide r;
  r.high = a.high * unit;
  r.low = a.low * unit;
  return r;
}

// One float quotient and one correction by its exact remainder: the division itself may be off by 2.5 ulp.
GN_INLINE gn_f32 gn_wide_ratio(GnWide a, GnWide b) {
  const gn_f32 quotient = a.high / b.high;
  const GnWide rest = gn_wide_subtract(a, gn_wide_scale(b, quotient));
  return quotient + rest.high / b.high;
}

#endif
#endif
