// A ray from the batch: eight floats, origin, tmin, direction, tmax; its range is made finite. Feeds all tracing kernels.
#ifndef GNOMON_LOAD_RAY_H
#define GNOMON_LOAD_RAY_H

#include "shared/hit_math.h"

static inline GnRay load_ray(__global const float8* rays, uint index) {
  const float8 r = rays[index];
  GnRay ray;
  ray.origin[0] = r.s0;
  ray.origin[1] = r.s1;
  ray.origin[2] = r.s2;
  ray.tmin = gn_finite_tmin(r.s3);
  ray.direction[0] = r.s4;
  ray.direction[1] = r.s5;
  ray.direction[2] = r.s6;
  ray.tmax = gn_finite_tmax(r.s7);
  return ray;
}

#endif
