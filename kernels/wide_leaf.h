// One ray of the wide flavours against leaves, eight triangles a step, and what a walk remembers. A hit that floats found
// is an interval; only where intervals overlap, or floats cannot tell inside from outside, is a triangle worked out
// exactly.
// Options: GN_COUNTERS, GN_PORTABLE (eight.h), GN_FAST (1: floats decide and measure, without error bounds; hits may be
// lost), GN_FRAME (1: boxes stand in a frame, shared/box_frame.h). Feeds wide_walk.h and packet_leaf.h.
#ifndef GNOMON_WIDE_LEAF_H
#define GNOMON_WIDE_LEAF_H

#include "shared/box_frame.h"
#include "shared/hit_math.h"
#include "shared/wide_layout.h"
#include "eight.h"
#include "load_ray.h"

// Keeps rare work from taking registers from the loop around it.
#define GN_OUT_OF_LINE __attribute__((noinline))

#ifndef GN_FAST
#define GN_FAST 0
#endif
#ifndef GN_COUNTERS
#define GN_COUNTERS 0
#endif
#ifndef GN_FRAME
#define GN_FRAME 0
#endif

typedef struct GnWideRay {
  GnRayFrame frame;  // what triangles are tested with; all else is for boxes
  float origin[3];
#if GN_FRAME
  float far_origin[3];
#endif
  float inverse[3];
  float far_inverse[3];   // a little larger: far sides are never taken for nearer than they are
  uint near_side[3];      // byte offset of the planes met first, per axis
  float far_margin;       // added to far sides: 0 unless tmin is negative
  float tmin;
  float tmax;
} GnWideRay;

// The nearest hit so far lies between nearest and farthest. Floats found it (pending), and which triangle it is is all
// that counts until another comes as near or the walk ends; or best is exact, and both are its t.
typedef struct GnWideWalk {
  GnHit best;
  float nearest;
  float farthest;
  float limit;  // of box entries still of interest
  uint found;
  uint pending;
  uint seat;  // of the pending triangle
  uint boxes;
  uint triangles;
} GnWideWalk;

// Written where it stays: what is made beside it and copied waits until all its parts are stored.
#if GN_FRAME
#define GN_FAR_ORIGIN(ray, k) (ray)->far_origin[k]
static inline void set_wide_ray(GnWideRay* out, const GnRay* ray, __global const GnBoxFrame* boxes) {
  const GnBoxRay turned = gn_box_ray(boxes, ray);
#else
#define GN_FAR_ORIGIN(ray, k) (ray)->origin[k]
static inline void set_wide_ray(GnWideRay* out, const GnRay* ray) {
#endif
  uint k;
  out->frame = gn_ray_frame(ray);
  for (k = 0u; k < 3u; ++k) {
#if GN_FRAME
    const float inverse = turned.inverse[k];
    out->origin[k] = turned.near_origin[k];
    out->far_origin[k] = turned.far_origin[k];
#else
    const float inverse = out->frame.inverse[k];
    out->origin[k] = ray->origin[k];
#endif
    const uint backwards = inverse < 0.0f;
    out->inverse[k] = inverse;
    out->far_inverse[k] = gn_slab_limit(gn_abs(inverse)) * (backwards ? -1.0f : 1.0f);
    out->near_side[k] = 64u * k + 32u * backwards;
  }
  // The larger reciprocal makes a negative distance too small; those that matter are no less than tmin.
  out->far_margin = ray->tmin < 0.0f ? -4.0f * GN_SLAB_SLACK * ray->tmin : 0.0f;
  out->tmin = ray->tmin;
  out->tmax = ray->tmax;
}

// Below infinity, where empty slots begin and gn_box_entry puts boxes that are missed: a tmin of -infinity makes far
// sides bound nothing.
static inline float limit_for(float t) { return gn_min(gn_slab_limit(t), FLT_MAX); }

static inline void take_exact(GnWideWalk* walk, const GnHit* hit) {
  walk->best = *hit;
  walk->found = 1u;
  walk->pending = 0u;
  walk->nearest = hit->t;
  walk->farthest = hit->t;
  walk->limit = limit_for(hit->t);
}

// Decides a triangle exactly.
static GN_OUT_OF_LINE int resolve(const GnRayFrame* frame, __global const uint* leaves, uint seat, int verdict,
                                  GnHit* hit) {
  __global const float* at = (__global const float*)leaves + gn_seat_word(seat);
  const uint stride = gn_seat_stride(seat);
  float v0[3], v1[3], v2[3];
  uint k;
  for (k = 0u; k < 3u; ++k) {
    v0[k] = at[k * stride];
    v1[k] = at[(3u + k) * stride];
    v2[k] = at[(6u + k) * stride];
  }
  hit->primitive = gn_number_at(leaves, seat);
#if GN_FAST
  return gn_triangle_by_floats(frame, v0, v1, v2, hit);
#else
  return gn_triangle_resolve(frame, v0, v1, v2, verdict, hit);
#endif
}

// The exact values of a hit that floats found.
static inline void settle(GnWideWalk* walk, const GnWideRay* ray, __global const uint* leaves) {
  GnHit hit;
  if (!walk->pending) return;
  resolve(&ray->frame, leaves, walk->seat, 1, &hit);
  take_exact(walk, &hit);
}

// Whether a seat holds the triangle of the nearest hit so far: trees of parts have it in several leaves, and it is not
// nearer there.
static inline int is_nearest(const GnWideWalk* walk, __global const uint* leaves, uint seat) {
  const uint primitive = walk->pending ? gn_number_at(leaves, walk->seat) : walk->best.primitive;
  return walk->found && primitive == gn_number_at(leaves, seat);
}

// Whether two triangles that the ray meets for certain have the same t, without working them out: both lie in one plane
// across an axis, as a floor and what stands on it do.
static inline int meet_at_once(const GnRayFrame* frame, __global const uint* leaves, uint seat, uint other) {
#if !GN_FAST
  __global const float* a = (__global const float*)leaves + gn_seat_word(seat);
  __global const float* b = (__global const float*)leaves + gn_seat_word(other);
  const uint step_a = gn_seat_stride(seat), step_b = gn_seat_stride(other);
  uint k;
  for (k = 0u; k < 3u; ++k) {
    const float plane = a[k * step_a];
    if (a[(3u + k) * step_a] != plane || a[(6u + k) * step_a] != plane || b[k * step_b] != plane ||
        b[(3u + k) * step_b] != plane || b[(6u + k) * step_b] != plane)
      continue;
    return gn_plane_has_one_t(frame, k, plane);
  }
#endif
  return 0;
}

// A triangle that floats cannot rank, or not even call met.
static GN_OUT_OF_LINE void test_exactly(GnWideWalk* walk, const GnWideRay* ray, __global const uint* leaves,
                                        uint seat, int verdict) {
  GnHit hit;
  if (is_nearest(walk, leaves, seat)) return;
  if (verdict > 0 && walk->pending && meet_at_once(&ray->frame, leaves, walk->seat, seat)) {
    // Of equals that of the lower number is the hit (gn_hit_is_nearer).
    if (gn_number_at(leaves, seat) < gn_number_at(leaves, walk->seat)) walk->seat = seat;
    return;
  }
  if (!resolve(&ray->frame, leaves, seat, verdict, &hit)) return;
  if (!(hit.t >= ray->tmin && hit.t <= ray->tmax)) return;
  settle(walk, ray, leaves);
  if (!walk->found || gn_hit_is_nearer(&hit, &walk->best)) take_exact(walk, &hit);
}

// A triangle that is met for certain, by floats between nearest and farthest.
static inline void test_met(GnWideWalk* walk, const GnWideRay* ray, __global const uint* leaves, uint seat,
                            float nearest, float farthest) {
  // False where something overflowed: infinities less themselves and NaN compare with nothing.
  const int known = farthest - nearest < INFINITY;
  if (known && (farthest < ray->tmin || nearest > ray->tmax)) return;
  if (known && walk->found && nearest > walk->farthest) return;
  if (known && nearest >= ray->tmin && farthest <= ray->tmax && (!walk->found || farthest < walk->nearest)) {
    walk->found = 1u;
    walk->pending = 1u;
    walk->seat = seat;
    walk->nearest = nearest;
    walk->farthest = farthest;
    walk->limit = limit_for(farthest);
  } else {
    // An edge function that overflowed to NaN hides from the largest and the smallest: nothing is certain then.
    test_exactly(walk, ray, leaves, seat, known ? 1 : -1);
  }
}

// Eight triangles' coordinate k, counted through all corners, of a block of `count` at c; lanes behind them are anything.
#define GN_OF_BLOCK(c, k, count) vload8(0, (c) + (k) * (count))

// Tests a block of `count` triangles from place `first` on: gn_triangle_filter and gn_met_at, eight at a time.
static inline void test_block(GnWideWalk* walk, const GnWideRay* ray, __global const uint* leaves, uint first, uint count,
                              int any_hit) {
  const GnRayFrame* frame = &ray->frame;
  __global const float* c = (__global const float*)leaves + GN_TRIANGLE_WORDS * first;
  const uint kx = frame->kx, ky = frame->ky, kz = frame->kz;
  const float ox = frame->origin[kx], oy = frame->origin[ky], oz = frame->origin[kz];
  const float8 az = GN_OF_BLOCK(c, kz, count) - oz;
  const float8 bz = GN_OF_BLOCK(c, 3u + kz, count) - oz;
  const float8 cz = GN_OF_BLOCK(c, 6u + kz, count) - oz;
  const float8 ax = (GN_OF_BLOCK(c, kx, count) - ox) - frame->shear_x * az;
  const float8 ay = (GN_OF_BLOCK(c, ky, count) - oy) - frame->shear_y * az;
  const float8 bx = (GN_OF_BLOCK(c, 3u + kx, count) - ox) - frame->shear_x * bz;
  const float8 by = (GN_OF_BLOCK(c, 3u + ky, count) - oy) - frame->shear_y * bz;
  const float8 cx = (GN_OF_BLOCK(c, 6u + kx, count) - ox) - frame->shear_x * cz;
  const float8 cy = (GN_OF_BLOCK(c, 6u + ky, count) - oy) - frame->shear_y * cz;
  const float8 u = cx * by - cy * bx;
  const float8 v = ax * cy - ay * cx;
  const float8 w = bx * ay - by * ax;
  const float8 z = GN_MAX8(GN_MAX8(fabs(az), fabs(bz)), fabs(cz));
  const float8 px = GN_MAX8(GN_MAX8(fabs(ax), fabs(bx)), fabs(cx));
  const float8 py = GN_MAX8(GN_MAX8(fabs(ay), fabs(by)), fabs(cy));
  const float8 q = GN_MAX8(px, py) + GN_EDGE_SHIFT * z;
  const float8 bound = GN_FAST ? (float8)0.0f : GN_EDGE_ERROR_8 * (8.0f * q * (q + z)) + GN_EDGE_UNDERFLOW;
  const float8 largest = GN_MAX8(GN_MAX8(u, v), w), smallest = GN_MIN8(GN_MIN8(u, v), w);
  uint met = ~lanes_both_above(largest, bound, -bound, smallest) & (255u >> (8u - count));
  if (met != 0u) {
    const uint inside = lanes_either_above(smallest, bound, -bound, largest);
    const float8 share = 1.0f / (u + v + w);
    const float8 spread = GN_MAX8(GN_MAX8(az, bz), cz) - GN_MIN8(GN_MIN8(az, bz), cz);
    const float8 inverse = (float8)frame->inverse[kz];
    const float8 error = GN_FAST ? (float8)0.0f
                                 : ((GN_MET_SPREADS * bound * spread + GN_MET_UNDERFLOW) * fabs(share) +
                                    GN_SLAB_SLACK * z + GN_MET_UNDERFLOW) *
                                           fabs(inverse) +
                                       GN_MET_UNDERFLOW;
    const float8 t = (u * share * az + v * share * bz + w * share * cz) * inverse;
    float nearest[8], farthest[8];
    vstore8(t - error, 0, nearest);
    vstore8(t + error, 0, farthest);
    do {
      const uint lane = lowest_bit(met), seat = gn_seat(first, count, lane);
      if ((inside >> lane) & 1u) {
        test_met(walk, ray, leaves, seat, nearest[lane], farthest[lane]);
      } else {
        test_exactly(walk, ray, leaves, seat, -1);
      }
      met &= met - 1u;
    } while (met != 0u && !(any_hit && walk->found));
  }
}

// True when an any-hit walk is over.
static inline int test_wide_leaf(GnWideWalk* walk, const GnWideRay* ray, __global const uint* leaves, uint link,
                                 int any_hit) {
  GnLeaf leaf = gn_leaf_at(leaves, link);
#if GN_COUNTERS
  walk->triangles += leaf.count;
#endif
  for (;;) {
    test_block(walk, ray, leaves, leaf.first, min(leaf.count, GN_WIDTH), any_hit);
    if (any_hit && walk->found) return 1;
    if (leaf.count <= GN_WIDTH) return 0;
    leaf.count -= GN_WIDTH;
    leaf.first += GN_WIDTH;
  }
}

#endif
