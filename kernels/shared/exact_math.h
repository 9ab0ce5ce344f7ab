// The exact sign of a ray against a triangle's edge, for float input, from double arithmetic alone. Rarely reached:
// hit_math.h comes here only when a float filter cannot decide. Devices without fp64 never compile it.
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

// Sign of det(d, a - o, b - o) = d . (a x b + b x o + o x a), exactly: 36 exact terms summed as an expansion.
GN_INLINE int gn_exact_edge_sign(const gn_f32* d, const gn_f32* o, const gn_f32* a, const gn_f32* b) {
  double e[40];
  int i, size = 0;
  for (i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = i == 0 ? 2 : i - 1;
    size = gn_grow_by_minor(e, size, d[i], a[j], b[k], a[k], b[j]);
    size = gn_grow_by_minor(e, size, d[i], b[j], o[k], b[k], o[j]);
    size = gn_grow_by_minor(e, size, d[i], o[j], a[k], o[k], a[j]);
  }
  if (size == 0) return 0;
  return e[size - 1] > 0.0 ? 1 : -1;
}

#endif
#endif
