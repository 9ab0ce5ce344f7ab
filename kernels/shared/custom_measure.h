// Your own measure: change the one function here, and builders on every device, the reference builder, tests and rows
// follow. What stands here is a worked example, a measure for thick rays (cones of rays, beams, spheres that move): how
// likely a ball of radius r, thrown from everywhere, is to touch the box. By Steiner's formula the box grown by r has half
// the surface S/2 + pi r (d_x + d_y + d_z) + 2 pi r^2. Used where measure.kind is GN_MEASURE_CUSTOM; r is half_width.
//
// What a measure must keep: the same bits on both compilers (no division, no library functions: elementary_math.h has
// replacements), not smaller for a larger box, no NaN for finite boxes. Feeds measure_math.h.
#ifndef GNOMON_SHARED_CUSTOM_MEASURE_H
#define GNOMON_SHARED_CUSTOM_MEASURE_H

#include "build_layout.h"

GN_INLINE gn_f32 gn_custom_measure(const GnMeasure* m, const gn_f32* lo, const gn_f32* hi) {
  const gn_f32 dx = hi[0] - lo[0], dy = hi[1] - lo[1], dz = hi[2] - lo[2];
  const gn_f32 r = m->half_width;
  return dx * (dy + dz) + dy * dz + 3.1415927f * r * (dx + dy + dz) + 6.2831853f * r * r;
}

#endif
