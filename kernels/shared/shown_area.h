// How much of a triangle shows, for both compilers. Feeds parts_math.h and collapse_math.h.
#ifndef GNOMON_SHARED_SHOWN_AREA_H
#define GNOMON_SHARED_SHOWN_AREA_H

#include "layout.h"

// The area of the triangle's projections along the three axes, all together; never above half the surface of its box.
GN_INLINE gn_f32 gn_shown_area(const gn_f32* v0, const gn_f32* v1, const gn_f32* v2) {
  gn_f32 a[3], b[3];
  int k;
  for (k = 0; k < 3; ++k) {
    a[k] = v1[k] - v0[k];
    b[k] = v2[k] - v0[k];
  }
  return 0.5f * (gn_abs(a[1] * b[2] - a[2] * b[1]) + gn_abs(a[2] * b[0] - a[0] * b[2]) + gn_abs(a[0] * b[1] - a[1] * b[0]));
}

#endif
