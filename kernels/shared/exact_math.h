// The exact sign of a ray against a triangle's edge, and where it meets the triangle's plane, for float input, from
// double arithmetic alone. Rarely reached: hit_math.h comes here only when floats cannot decide, or doubles not tell t to
// a float's last bit. Devices without fp64 never compile it.
// Source: expansion arithmetic after Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997.
#ifndef GNOMON_SHARED_EXACT_MATH_H
#define GNOMON_SHARED_EXACT_MATH_H

#include "layout.h"

#if GN_HAS_FP64

// Adds x to the expansion e of `size` nonoverlapping components (smallest first); returns the new size.
GN_INLINE int gn_grow_expansion(double* e, int size, double x) {
  double q = x;
  int i, kept = 0;
  for (i = 0; i < size; ++i) {
    // Knuth's two-sum: sum + low == q + e[i] exactly.
    const double sum = q + e[i];
    const double virtual_e = sum - q;
    const double low = (q - (sum - virtual_e)) + (e[i] - virtual_e);
    if (low != 0.0) e[kept++] = low;
    q = sum;
  }
  if (q != 0.0) e[kept++] = q;
  return kept;
}

// Adds d * (p * q - r * s) to e exactly. Products of two floats are exact in double; Veltkamp's split of such a
// product gives two halves whose products with a float are exact too.
GN_INLINE int gn_grow_by_minor(double* e, int size, double d, double p, double q, double r, double s) {
  double products[2];
  int i;
  products[0] = p * q;
  products[1] = -(r * s);
  for (i = 0; i < 2; ++i) {
    const double c = products[i] * 134217729.0;  // 2^27 + 1
    const double high = c - (c - products[i]);
    const double low = products[i] - high;
    size = gn_grow_expansion(e, size, d * low);
    size = gn_grow_expansion(e, size, d * high);
  }
  return size;
}

// Adds sign * det(a, b, c).
GN_INLINE int gn_grow_by_determinant(double* e, int size, double sign, const gn_f32* a, const gn_f32* b,
                                     const gn_f32* c) {
  int i;
  for (i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = i == 0 ? 2 : i - 1;
    size = gn_grow_by_minor(e, size, sign * a[i], b[j], c[k], b[k], c[j]);
  }
  return size;
}

// det(d, a - o, b - o) = det(d, a, b) + det(d, b, o) + det(d, o, a), exactly: 36 exact terms summed as an expansion. e
// needs room for 40.
GN_INLINE int gn_exact_edge(double* e, const gn_f32* d, const gn_f32* o, const gn_f32* a, const gn_f32* b) {
  int size = gn_grow_by_determinant(e, 0, 1.0, d, a, b);
  size = gn_grow_by_determinant(e, size, 1.0, d, b, o);
  return gn_grow_by_determinant(e, size, 1.0, d, o, a);
}

GN_INLINE int gn_exact_edge_sign(const gn_f32* d, const gn_f32* o, const gn_f32* a, const gn_f32* b) {
  double e[40];
  const int size = gn_exact_edge(e, d, o, a, b);
  if (size == 0) return 0;
  return e[size - 1] > 0.0 ? 1 : -1;
}

// An expansion as a double: its components do not overlap, so what is lost is below 2^-45 of it.
GN_INLINE double gn_expansion_value(const double* e, int size) {
  double sum = 0.0;
  int i;
  for (i = 0; i < size; ++i) sum += e[i];
  return sum;
}

// The t at which a ray meets the plane of a triangle that it is not parallel to: det(v0 - o, v1 - o, v2 - o) over
// det(d, v0 - v2, v1 - v2). Both are summed exactly, so t is right to half an ulp and 2^-43.
GN_INLINE gn_f32 gn_exact_t(const gn_f32* d, const gn_f32* o, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2) {
  double e[52];
  double numerator;
  int size = gn_grow_by_determinant(e, 0, 1.0, v0, v1, v2);
  size = gn_grow_by_determinant(e, size, -1.0, o, v1, v2);
  size = gn_grow_by_determinant(e, size, -1.0, v0, o, v2);
  size = gn_grow_by_determinant(e, size, -1.0, v0, v1, o);
  numerator = gn_expansion_value(e, size);
  size = gn_exact_edge(e, d, v2, v0, v1);
  return (gn_f32)(numerator / gn_expansion_value(e, size));
}

#endif
#endif
