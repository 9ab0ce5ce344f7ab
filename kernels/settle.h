// The last step of closest hits: the exact t, u and v of what floats found. Where the device has double,
// eight at once: rays hand in theirs, and every eighth works them out, with the operations of gn_triangle_resolve in
// its order, so bit for bit as one by one. Feeds wide_walk.h, trace_packet.cl.
#ifndef GNOMON_SETTLE_H
#define GNOMON_SETTLE_H

#include "wide_leaf.h"

// Hits found but not worked out: which ray met which triangle (its seat, shared/wide_layout.h).
typedef struct GnFound {
  uint ray[8];
  uint seat[8];
  uint count;
} GnFound;

// Before a loop over loads from anywhere: vectors of such loads are an instruction, but a slow one.
#if defined(__clang__)
#define GN_ONE_BY_ONE _Pragma("clang loop vectorize(disable)")
#else
#define GN_ONE_BY_ONE
#endif

#if GN_HAS_FP64 && !GN_FAST

// Of three vectors that of axis k, lane by lane.
static inline double8 of_axis(long8 is_y, long8 is_z, double8 x, double8 y, double8 z) {
  return is_z ? z : is_y ? y : x;
}

// True wherever gn_mean_is_doubtful is: a permanent is no more than twice the direction's sum times the square of the
// largest corner. NaN counts as doubt.
static inline long8 mean_may_be_doubtful(const double8* r, double8 direction, long8 is_y, long8 is_z,
                                         double8 distance) {
  const double8 a = of_axis(is_y, is_z, r[0], r[1], r[2]), b = of_axis(is_y, is_z, r[3], r[4], r[5]);
  const double8 c = of_axis(is_y, is_z, r[6], r[7], r[8]);
  const double8 spread = GN_MAX8(GN_MAX8(a, b), c) - GN_MIN8(GN_MIN8(a, b), c);
  double8 most = fabs(r[0]);
  uint k;
  for (k = 1u; k < 9u; ++k) most = GN_MAX8(fabs(r[k]), most);
  return !(12.1 * GN_WIDE_EPSILON * direction * most * most * spread <= 3.7252903e-09 * fabs(distance));
}

// det(d, a, b) as gn_wide_determinant sums it.
static inline double8 determinant_of_eight(const double8* d, const double8* a, const double8* b) {
  double8 sum = (double8)(0.0);
  sum = sum + (a[1] * b[2] - a[2] * b[1]) * d[0];
  sum = sum + (a[2] * b[0] - a[0] * b[2]) * d[1];
  return sum + (a[0] * b[1] - a[1] * b[0]) * d[2];
}

#endif

static inline GnHit settle_one(const GnFound* found, uint i, __global const uint* leaves,
                               __global const float8* rays) {
  const GnRay ray = load_ray(rays, found->ray[i]);
  const GnRayFrame frame = gn_ray_frame(&ray);
  GnHit hit;
  resolve(&frame, leaves, found->seat[i], 1, &hit);
  return hit;
}

#if GN_HAS_FP64 && !GN_FAST

// Works out the hits in `found` and writes them.
static GN_OUT_OF_LINE void settle_found(GnFound* found, __global const uint* leaves,
                                        __global const float8* rays, __global float4* hits) {
  float corner[72], line[48];
  long doubtful[8];
  double8 r[9], d[3];
  uint i, k;
  GN_ONE_BY_ONE
  for (i = 0u; i < 8u; ++i) {
    const uint from = i < found->count ? i : 0u;
    __global const float* triangle = (__global const float*)leaves + gn_seat_word(found->seat[from]);
    __global const float* ray = (__global const float*)(rays + found->ray[from]);
    const uint stride = gn_seat_stride(found->seat[from]);
    GN_ONE_BY_ONE
    for (k = 0u; k < 9u; ++k) corner[8u * k + i] = triangle[k * stride];
    for (k = 0u; k < 3u; ++k) {
      line[8u * k + i] = ray[k];
      line[24u + 8u * k + i] = ray[4u + k];
    }
  }
  for (k = 0u; k < 3u; ++k) {
    const double8 origin = convert_double8(vload8(k, line));
    d[k] = convert_double8(vload8(3u + k, line));
    r[k] = convert_double8(vload8(k, corner)) - origin;
    r[3u + k] = convert_double8(vload8(3u + k, corner)) - origin;
    r[6u + k] = convert_double8(vload8(6u + k, corner)) - origin;
  }
  {
    const double8 ax = fabs(d[0]), ay = fabs(d[1]), az = fabs(d[2]);
    const long8 y_over_x = ay > ax;
    const long8 is_z = az > (y_over_x ? ay : ax);
    double8 w0 = determinant_of_eight(d, r + 3, r + 6);
    double8 w1 = determinant_of_eight(d, r + 6, r);
    double8 w2 = determinant_of_eight(d, r, r + 3);
    double8 sum = w0 + w1 + w2;
    double8 distance = (double8)(0.0);
    long8 flat;
    // Rounding may leave a weight with the wrong sign where the ray meets an edge: it is zero there.
    const long8 front = sum > 0.0, back = sum < 0.0;
    w0 = (front && w0 < 0.0) || (back && w0 > 0.0) ? (double8)(0.0) : w0;
    w1 = (front && w1 < 0.0) || (back && w1 > 0.0) ? (double8)(0.0) : w1;
    w2 = (front && w2 < 0.0) || (back && w2 > 0.0) ? (double8)(0.0) : w2;
    sum = w0 + w1 + w2;
    flat = !(sum > 0.0 || sum < 0.0);
    w0 = flat ? (double8)(1.0) : w0;
    w1 = flat ? (double8)(1.0) : w1;
    w2 = flat ? (double8)(1.0) : w2;
    sum = flat ? (double8)(3.0) : sum;
    distance = distance + w0 * of_axis(y_over_x, is_z, r[0], r[1], r[2]);
    distance = distance + w1 * of_axis(y_over_x, is_z, r[3], r[4], r[5]);
    distance = distance + w2 * of_axis(y_over_x, is_z, r[6], r[7], r[8]);
    vstore8(flat | mean_may_be_doubtful(r, ax + ay + az, y_over_x, is_z, distance), 0, doubtful);
    vstore8(convert_float8(distance / (sum * of_axis(y_over_x, is_z, d[0], d[1], d[2]))), 0, corner);
    vstore8(convert_float8(w1 / sum), 1, corner);
    vstore8(convert_float8(w2 / sum), 2, corner);
  }
  for (i = 0u; i < found->count; ++i) {
    const uint primitive = gn_number_at(leaves, found->seat[i]);
    const float t = doubtful[i] != 0 ? settle_one(found, i, leaves, rays).t : corner[i];
    hits[found->ray[i]] = (float4)(t, corner[8u + i], corner[16u + i], as_float(primitive));
  }
  found->count = 0u;
}

#else

static GN_OUT_OF_LINE void settle_found(GnFound* found, __global const uint* leaves,
                                        __global const float8* rays, __global float4* hits) {
  uint i;
  for (i = 0u; i < found->count; ++i) {
    const GnHit hit = settle_one(found, i, leaves, rays);
    hits[found->ray[i]] = (float4)(hit.t, hit.u, hit.v, as_float(hit.primitive));
  }
  found->count = 0u;
}

#endif

static inline void hand_in(GnFound* found, uint ray, uint seat, __global const uint* leaves,
                           __global const float8* rays, __global float4* hits) {
  found->ray[found->count] = ray;
  found->seat[found->count] = seat;
  found->count += 1u;
  if (found->count == 8u) settle_found(found, leaves, rays, hits);
}

#endif
