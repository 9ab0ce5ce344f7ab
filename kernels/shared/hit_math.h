// Ray against triangle, for both compilers. Hit or miss is decided exactly: a float filter answers almost always, wide
// and expansion arithmetic answer the rest, so shared edges and vertices never leak and no epsilon exists. On a
// device without fp64 what pairs of floats cannot decide counts as inside: still nothing lost, but a hit may then lie
// outside its triangle by 2^-40 of the distance. Not for boxes (ray_math.h), trees (traversal) or double-precision judging
// (oracle).
// Source: Woop, Benthin, Wald 2013 (shear).
#ifndef GNOMON_SHARED_HIT_MATH_H
#define GNOMON_SHARED_HIT_MATH_H

#include "exact_math.h"
#include "ray_math.h"
#include "wide_math.h"

// A triangle's edge functions along the ray in floats, and what bounds their errors.
typedef struct GnEdges {
  gn_f32 az, bz, cz;  // the corners' distances along the ray's main axis
  gn_f32 u, v, w;
  gn_f32 z;      // the largest distance
  gn_f32 bound;  // of the error of u, v and w
} GnEdges;

// Bounds of what rounding and underflow do to edge functions and distances, explained where they are used.
#define GN_EDGE_SHIFT 9.5367432e-07f   // 2^-20
#define GN_EDGE_ERROR_8 2.9802322e-07f  // 5 * 2^-24
#define GN_EDGE_UNDERFLOW 1e-36f
#define GN_MET_UNDERFLOW 1e-37f

// With z the largest distance along the ray's main axis, p the largest sheared coordinate and e = 2^-24, a sheared
// coordinate is off by at most e(2p + 8z), an edge function by 12 e p^2 + 32 e p z + 128 e^2 z^2. Replacing p by
// q = p + 2^-20 z makes 40 e q (q + z) an upper bound; 1e-36 covers underflow. Taken as 5 e (8 q (q + z)) it is infinite
// where edge functions or their sum overflow: nothing is certain then.
GN_INLINE GnEdges gn_triangle_edges(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2) {
  const gn_u32 kx = ray->kx, ky = ray->ky, kz = ray->kz;
  const gn_f32 az = v0[kz] - ray->origin[kz];
  const gn_f32 bz = v1[kz] - ray->origin[kz];
  const gn_f32 cz = v2[kz] - ray->origin[kz];
  const gn_f32 ax = (v0[kx] - ray->origin[kx]) - ray->shear_x * az;
  const gn_f32 ay = (v0[ky] - ray->origin[ky]) - ray->shear_y * az;
  const gn_f32 bx = (v1[kx] - ray->origin[kx]) - ray->shear_x * bz;
  const gn_f32 by = (v1[ky] - ray->origin[ky]) - ray->shear_y * bz;
  const gn_f32 cx = (v2[kx] - ray->origin[kx]) - ray->shear_x * cz;
  const gn_f32 cy = (v2[ky] - ray->origin[ky]) - ray->shear_y * cz;
  const gn_f32 px = gn_max(gn_max(gn_abs(ax), gn_abs(bx)), gn_abs(cx));
  const gn_f32 py = gn_max(gn_max(gn_abs(ay), gn_abs(by)), gn_abs(cy));
  const gn_f32 z = gn_max(gn_max(gn_abs(az), gn_abs(bz)), gn_abs(cz));
  const gn_f32 q = gn_max(px, py) + GN_EDGE_SHIFT * z;
  GnEdges edges;
  edges.az = az;
  edges.bz = bz;
  edges.cz = cz;
  edges.u = cx * by - cy * bx;
  edges.v = ax * cy - ay * cx;
  edges.w = bx * ay - by * ax;
  edges.z = z;
  edges.bound = GN_EDGE_ERROR_8 * (8.0f * q * (q + z)) + GN_EDGE_UNDERFLOW;
  return edges;
}

// What the edge functions' signs say: 1 certainly inside, 0 certainly outside, -1 unknown.
GN_INLINE int gn_edges_verdict(const GnEdges* e) {
  const int positive = (e->u > e->bound) + (e->v > e->bound) + (e->w > e->bound);
  const int negative = (e->u < -e->bound) + (e->v < -e->bound) + (e->w < -e->bound);
  if (positive > 0 && negative > 0) return 0;
  if (positive == 3 || negative == 3) return 1;
  return -1;
}

GN_INLINE int gn_triangle_filter(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2) {
  const GnEdges edges = gn_triangle_edges(ray, v0, v1, v2);
  return gn_edges_verdict(&edges);
}

// What floats alone say of a triangle that gn_triangle_filter calls certainly inside (u, v, w are its edge functions, all
// of one sign and beyond bound): where along the ray it is met, and by how much that may be wrong. t is a mean of the
// corners' distances with weights u, v, w. Where T is the mean with the true weights, t - T is the sum of the weights'
// errors, at most bound each, times how far each corner is from T, over u + v + w; T lies between the corners, so those
// three are no farther than two spreads together, and with what rounding adds it is GN_MET_SPREADS. Rounding moves t by
// less than 2^-19 of the largest distance z, underflow by less than 1e-37 before each multiplication.
#define GN_MET_SPREADS 2.0625f
GN_INLINE gn_f32 gn_met_at(gn_f32 az, gn_f32 bz, gn_f32 cz, gn_f32 u, gn_f32 v, gn_f32 w, gn_f32 bound, gn_f32 z,
                           gn_f32 inverse, gn_f32* error) {
  const gn_f32 share = 1.0f / (u + v + w);
  const gn_f32 spread = gn_max(gn_max(az, bz), cz) - gn_min(gn_min(az, bz), cz);
  *error = ((GN_MET_SPREADS * bound * spread + GN_MET_UNDERFLOW) * gn_abs(share) + GN_SLAB_SLACK * z + GN_MET_UNDERFLOW) *
               gn_abs(inverse) +
           GN_MET_UNDERFLOW;
  return (u * share * az + v * share * bz + w * share * cz) * inverse;
}

// det(d, a, b) and its permanent, the same sum of magnitudes.
GN_INLINE GnWide gn_wide_determinant(const gn_f32* d, const GnWide* a, const GnWide* b, GnWide* permanent) {
  GnWide sum = gn_wide_of(0.0f);
  int i;
  *permanent = sum;
  for (i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = i == 0 ? 2 : i - 1;
    const GnWide plus = gn_wide_multiply(a[j], b[k]);
    const GnWide minus = gn_wide_multiply(a[k], b[j]);
    const GnWide sizes = gn_wide_add(gn_wide_abs(plus), gn_wide_abs(minus));
    sum = gn_wide_add(sum, gn_wide_scale(gn_wide_subtract(plus, minus), d[i]));
    *permanent = gn_wide_add(*permanent, gn_wide_scale(sizes, gn_abs(d[i])));
  }
  return sum;
}

// Sign of det(d, a - o, b - o) where wide arithmetic cannot tell: found exactly where the device has double. Elsewhere
// 0, which *open marks as "either sign" unless the value itself came out as zero.
GN_INLINE int gn_undecided_edge_sign(const GnRayFrame* ray, const gn_f32* a, const gn_f32* b, GnWide value,
                                     int* open) {
#if GN_HAS_FP64
  (void)value;
  (void)open;
  return gn_exact_edge_sign(ray->direction, ray->origin, a, b);
#else
  (void)ray;
  (void)a;
  (void)b;
  *open |= gn_wide_sign(value) != 0;
  return 0;
#endif
}

// Whether the ray meets the triangle, from the edges' determinants (weights) and their permanents. The three signs
// must agree; zeros (the ray meets an edge or corner) agree with both; a ray in the triangle's plane, where all are
// zero, does not hit.
GN_INLINE int gn_signs_agree(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2,
                             const GnWide* weights, const GnWide* permanents) {
  const gn_f32* corner[3];
  int i, positive = 0, negative = 0, open = 0;
  corner[0] = v0;
  corner[1] = v1;
  corner[2] = v2;
  for (i = 0; i < 3; ++i) {
    const int sign =
        gn_wide_is_certain(weights[i], permanents[i])
            ? gn_wide_sign(weights[i])
            : gn_undecided_edge_sign(ray, corner[i == 2 ? 0 : i + 1], corner[i == 0 ? 2 : i - 1], weights[i], &open);
    positive |= sign > 0;
    negative |= sign < 0;
  }
  return !(positive && negative) && (positive || negative || open);
}

// Whether t, a mean of the corners' distances r by weights with these permanents, may be wrong by more than 2^-28 of
// itself: weights are wrong by 8 x 2^-53 of their permanents, which moves the mean by that share of the distances'
// spread, and sums round by less. So it is for needles and for rays that start in the triangle's plane or next to it.
GN_INLINE int gn_mean_is_doubtful(const GnWide* r, gn_u32 kz, const GnWide* permanents, GnWide distance) {
#if GN_HAS_FP64
  const double a = r[kz], b = r[3 + kz], c = r[6 + kz];
  const double most = a > b ? (a > c ? a : c) : (b > c ? b : c);
  const double least = a < b ? (a < c ? a : c) : (b < c ? b : c);
  return 2.0 * GN_WIDE_EPSILON * (permanents[0] + permanents[1] + permanents[2]) * (most - least) >
         3.7252903e-09 * fabs(distance);
#else
  (void)r;
  (void)kz;
  (void)permanents;
  (void)distance;
  return 0;
#endif
}

// Fills u, v and t / t_unit from the edges' determinants and the corners' distances along axis kz. t is a mean of these
// distances with weights of one sign. True: that mean is not good enough for t.
GN_INLINE int gn_fill_hit(const GnWide* r, gn_u32 kz, gn_f32 direction, gn_f32 t_unit, GnWide* weights,
                          const GnWide* permanents, GnHit* hit) {
  GnWide sum = gn_wide_add(gn_wide_add(weights[0], weights[1]), weights[2]);
  GnWide distance = gn_wide_of(0.0f);
  const int side = gn_wide_sign(sum);
  int i, doubtful = 0;
  for (i = 0; i < 3; ++i) {
    // Rounding may leave a weight with the wrong sign where the ray meets an edge: it is zero there.
    if (gn_wide_sign(weights[i]) * side < 0) weights[i] = gn_wide_of(0.0f);
  }
  sum = gn_wide_add(gn_wide_add(weights[0], weights[1]), weights[2]);
  if (gn_wide_sign(sum) == 0) {  // met, but too thin even for wide arithmetic: its middle
    for (i = 0; i < 3; ++i) weights[i] = gn_wide_of(1.0f);
    sum = gn_wide_of(3.0f);
    doubtful = 1;
  }
  for (i = 0; i < 3; ++i) distance = gn_wide_add(distance, gn_wide_multiply(weights[i], r[3 * i + kz]));
  hit->t = gn_wide_ratio(distance, gn_wide_scale(sum, direction)) * t_unit;
  hit->u = gn_wide_ratio(weights[1], sum);
  hit->v = gn_wide_ratio(weights[2], sum);
  return doubtful || gn_mean_is_doubtful(r, kz, permanents, distance);
}

// The corners seen from the ray's origin; returns the largest distance along an axis.
GN_INLINE gn_f32 gn_corners_from(const gn_f32* origin, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2,
                                 GnWide* r) {
  gn_f32 largest = 0.0f;
  int k;
  for (k = 0; k < 3; ++k) {
    r[k] = gn_wide_difference(v0[k], origin[k]);
    r[3 + k] = gn_wide_difference(v1[k], origin[k]);
    r[6 + k] = gn_wide_difference(v2[k], origin[k]);
    largest = gn_max(largest, gn_abs(v0[k] - origin[k]));
    largest = gn_max(largest, gn_abs(v1[k] - origin[k]));
    largest = gn_max(largest, gn_abs(v2[k] - origin[k]));
  }
  return largest;
}

// The exact part of gn_triangle_hit, for a triangle that gn_triangle_filter gave this verdict, 1 or -1.
GN_INLINE int gn_triangle_resolve(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2,
                                  int verdict, GnHit* hit) {
  GnWide r[9], weights[3], permanents[3];
  gn_f32 direction[3], unit, direction_unit;
  int i;
  unit = gn_wide_unit(gn_corners_from(ray->origin, v0, v1, v2, r));
  direction_unit = gn_wide_unit(ray->direction[ray->kz]);
  for (i = 0; i < 9; ++i) r[i] = gn_wide_times_unit(r[i], unit);
  for (i = 0; i < 3; ++i) direction[i] = ray->direction[i] * direction_unit;
  for (i = 0; i < 3; ++i) {
    const int next = i == 2 ? 0 : i + 1;
    const int previous = i == 0 ? 2 : i - 1;
    weights[i] = gn_wide_determinant(direction, r + 3 * next, r + 3 * previous, permanents + i);
  }
  if (verdict < 0 && !gn_signs_agree(ray, v0, v1, v2, weights, permanents)) return 0;
  if (gn_fill_hit(r, ray->kz, direction[ray->kz], direction_unit / unit, weights, permanents, hit)) {
#if GN_HAS_FP64
    hit->t = gn_exact_t(ray->direction, ray->origin, v0, v1, v2);
#endif
  }
  return 1;
}

// Ray against closed triangle, either side. On a hit fills t, u, v of `hit` (not its primitive) and returns 1.
GN_INLINE int gn_triangle_hit(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2,
                              GnHit* hit) {
  const int verdict = gn_triangle_filter(ray, v0, v1, v2);
  return verdict != 0 && gn_triangle_resolve(ray, v0, v1, v2, verdict, hit);
}

// The same by floats alone, without error bounds: hits at edges may be lost or added, t may be off by any number of
// ulp. For GN_FAST kernels.
GN_INLINE int gn_triangle_by_floats(const GnRayFrame* ray, const gn_f32* v0, const gn_f32* v1, const gn_f32* v2,
                                    GnHit* hit) {
  const GnEdges e = gn_triangle_edges(ray, v0, v1, v2);
  const gn_f32 sum = e.u + e.v + e.w;
  if (gn_min(gn_min(e.u, e.v), e.w) < 0.0f && gn_max(gn_max(e.u, e.v), e.w) > 0.0f) return 0;
  if (!(gn_abs(sum) > 0.0f)) return 0;
  hit->t = (e.u / sum * e.az + e.v / sum * e.bz + e.w / sum * e.cz) / ray->direction[ray->kz];
  hit->u = e.v / sum;
  hit->v = e.w / sum;
  return 1;
}

#define GN_AT_ONCE 7.450580596923828e-09  // 2^-27

// Whether all triangles in the plane across axis k which the ray meets for certain have the same t: where it meets that
// plane is not so close to the middle between two floats that 2^-28 of it, what a t may be wrong by before it is rounded
// (gn_mean_is_doubtful), could part them.
GN_INLINE int gn_plane_has_one_t(const GnRayFrame* ray, gn_u32 k, gn_f32 plane) {
#if GN_HAS_FP64
  const double t = ((double)plane - (double)ray->origin[k]) / (double)ray->direction[k];
  const double size = fabs(t);
  return size > 1e-30 && size < 1e30 && (gn_f32)(t * (1.0 - GN_AT_ONCE)) == (gn_f32)(t * (1.0 + GN_AT_ONCE));
#else
  (void)ray;
  (void)k;
  (void)plane;
  return 0;
#endif
}

// Whether `hit` (range already checked) comes before the best so far: nearer, or as near with a lower index, so that
// the answer does not depend on the order in which a tree offers triangles.
GN_INLINE int gn_hit_is_nearer(const GnHit* hit, const GnHit* best) {
  return hit->t < best->t || (hit->t == best->t && hit->primitive < best->primitive);
}

#endif
