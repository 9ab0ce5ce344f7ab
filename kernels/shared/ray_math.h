// Which rays are traced, what is computed once for each, and ray against box, for both compilers. The box test is
// conservative (it never rejects a box the exact ray meets) and NaN-safe. Not for triangles (hit_math.h).
// Source: Ize 2013 (conservative slabs).
#ifndef GNOMON_SHARED_RAY_MATH_H
#define GNOMON_SHARED_RAY_MATH_H

#include "build_layout.h"

// What is computed once per ray.
typedef struct GnRayFrame {
  gn_f32 origin[3];
  gn_f32 direction[3];
  gn_f32 inverse[3];  // 1 / direction; +-inf for zero components, NaN for denormal ones
  gn_f32 shear_x;     // direction[kx] / direction[kz]
  gn_f32 shear_y;
  gn_u32 kx, ky, kz;  // kz: the axis of the largest direction component
} GnRayFrame;

GN_INLINE int gn_is_finite(gn_f32 x) { return (gn_bits_of(x) & 0x7f800000u) != 0x7f800000u; }

// A ray we can trace: finite origin and direction, a direction neither too short nor too long, a range that is not NaN.
GN_INLINE int gn_ray_is_valid(const GnRay* ray) {
  gn_f32 longest = 0.0f;
  int k;
  for (k = 0; k < 3; ++k) {
    if (!gn_is_finite(ray->origin[k]) || !gn_is_finite(ray->direction[k])) return 0;
    longest = gn_max(longest, gn_abs(ray->direction[k]));
  }
  return longest >= GN_SHORTEST_DIRECTION && longest <= GN_LONGEST_DIRECTION && ray->tmin == ray->tmin &&
         ray->tmax == ray->tmax;
}

// The ends of a ray's range as tracers use them: hits have finite t. Two hits at infinity could not be ranked. An empty
// range stays empty, and NaN stays NaN.
GN_INLINE gn_f32 gn_finite_tmin(gn_f32 tmin) { return tmin < -GN_FLOAT_MAX ? -GN_FLOAT_MAX : tmin; }
GN_INLINE gn_f32 gn_finite_tmax(gn_f32 tmax) { return tmax > GN_FLOAT_MAX ? GN_FLOAT_MAX : tmax; }

// Of a direction's component. Of a denormal one the reciprocal may overflow, and devices may flush it: then the ray's
// way along this axis is not known and its slabs must bound nothing, as NaN does in gn_box_entry.
GN_INLINE gn_f32 gn_slab_inverse(gn_f32 component) {
  const gn_u32 magnitude = gn_bits_of(component) & 0x7fffffffu;
  return magnitude != 0u && magnitude < 0x00800000u ? gn_float_of(0x7fc00000u) : 1.0f / component;
}

GN_INLINE GnRayFrame gn_ray_frame(const GnRay* ray) {
  GnRayFrame frame;
  int k;
  for (k = 0; k < 3; ++k) {
    frame.origin[k] = ray->origin[k];
    frame.direction[k] = ray->direction[k];
    frame.inverse[k] = gn_slab_inverse(ray->direction[k]);
  }
  frame.kz = gn_abs(ray->direction[1]) > gn_abs(ray->direction[0]) ? 1u : 0u;
  if (gn_abs(ray->direction[2]) > gn_abs(ray->direction[frame.kz])) frame.kz = 2u;
  frame.kx = frame.kz == 2u ? 0u : frame.kz + 1u;
  frame.ky = frame.kx == 2u ? 0u : frame.kx + 1u;
  frame.shear_x = ray->direction[frame.kx] / ray->direction[frame.kz];
  frame.shear_y = ray->direction[frame.ky] / ray->direction[frame.kz];
  return frame;
}

// Twice the relative error a slab distance can have (subtraction 1/2 ulp, reciprocal 2.5 ulp, product 1/2 ulp, on
// near and on far: 15 x 2^-24), rounded up to 2^-19.
#define GN_SLAB_SLACK 1.9073486e-06f

// The largest parameter at which a box still matters when the nearest hit so far, or tmax, is t. Multiplies, so that
// infinities stay themselves.
GN_INLINE gn_f32 gn_slab_limit(gn_f32 t) { return t * (t < 0.0f ? 1.0f - GN_SLAB_SLACK : 1.0f + GN_SLAB_SLACK); }

// Where a ray enters between its nearer and farther planes, or +inf if it misses them within [tmin, limit]. limit comes
// from gn_slab_limit. 0 * inf (a ray in a face's plane) gives NaN, which loses every comparison: that slab then bounds
// nothing. So does a reciprocal that is NaN.
GN_INLINE gn_f32 gn_planes_entry(const GnRayFrame* ray, const gn_f32* nearer, const gn_f32* farther, gn_f32 tmin,
                                 gn_f32 limit) {
  gn_f32 near = tmin, far = GN_INFINITY;
  int k;
  for (k = 0; k < 3; ++k) {
    const gn_f32 a = (nearer[k] - ray->origin[k]) * ray->inverse[k];
    const gn_f32 b = (farther[k] - ray->origin[k]) * ray->inverse[k];
    near = gn_max(a, near);
    far = gn_min(b, far);
  }
  far = gn_min(gn_slab_limit(far), limit);
  return near <= far ? near : GN_INFINITY;
}

// The same for a box.
GN_INLINE gn_f32 gn_box_entry(const GnRayFrame* ray, const gn_f32* lo, const gn_f32* hi, gn_f32 tmin, gn_f32 limit) {
  gn_f32 nearer[3], farther[3];
  int k;
  for (k = 0; k < 3; ++k) {
    const int backwards = ray->inverse[k] < 0.0f;
    nearer[k] = backwards ? hi[k] : lo[k];
    farther[k] = backwards ? lo[k] : hi[k];
  }
  return gn_planes_entry(ray, nearer, farther, tmin, limit);
}

#endif
