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
  uint pending_lane;
  __global const GnTriangleBlock* pending_block;
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

// Decides a lane of a block exactly.
static GN_OUT_OF_LINE int resolve(const GnRayFrame* frame, __global const GnTriangleBlock* block, uint lane,
                                  int verdict, GnHit* hit) {
  float v0[3], v1[3], v2[3];
  uint k;
  for (k = 0u; k < 3u; ++k) {
    v0[k] = block->corners[k][lane];
    v1[k] = block->corners[3u + k][lane];
    v2[k] = block->corners[6u + k][lane];
  }
  hit->primitive = block->primitives[lane];
#if GN_FAST
  return gn_triangle_by_floats(frame, v0, v1, v2, hit);
#else
  return gn_triangle_resolve(frame, v0, v1, v2, verdict, hit);
#endif
}

// The exact values of a hit that floats found.
static inline void settle(GnWideWalk* walk, const GnWideRay* ray) {
  GnHit hit;
  if (!walk->pending) return;
  resolve(&ray->frame, walk->pending_block, walk->pending_lane, 1, &hit);
  take_exact(walk, &hit);
}

// Whether a lane holds the triangle of the nearest hit so far: trees of parts have it in several leaves, and it is not
// nearer there.
static inline int is_nearest(const GnWideWalk* walk, __global const GnTriangleBlock* block, uint lane) {
  const uint primitive =
      walk->pending ? walk->pending_block->primitives[walk->pending_lane] : walk->best.primitive;
  return walk->found && primitive == block->primitives[lane];
}

// A triangle that floats cannot rank, or not even call met.
static GN_OUT_OF_LINE void test_exactly(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block,
                                        uint lane, int verdict) {
  GnHit hit;
  if (is_nearest(walk, block, lane)) return;
  if (!resolve(&ray->frame, block, lane, verdict, &hit)) return;
  if (!(hit.t >= ray->tmin && hit.t <= ray->tmax)) return;
  settle(walk, ray);
  if (!walk->found || gn_hit_is_nearer(&hit, &walk->best)) take_exact(walk, &hit);
}

// A triangle that is met for certain, by floats between nearest and farthest.
static inline void test_met(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block, uint lane,
                            float nearest, float farthest) {
  // False where something overflowed: infinities less themselves and NaN compare with nothing.
  const int known = farthest - nearest < INFINITY;
  if (known && (farthest < ray->tmin || nearest > ray->tmax)) return;
  if (known && walk->found && nearest > walk->farthest) return;
  if (known && nearest >= ray->tmin && farthest <= ray->tmax && (!walk->found || farthest < walk->nearest)) {
    walk->found = 1u;
    walk->pending = 1u;
    walk->pending_block = block;
    walk->pending_lane = lane;
    walk->nearest = nearest;
    walk->farthest = farthest;
    walk->limit = limit_for(farthest);
  } else {
    // An edge function that overflowed to NaN hides from the largest and the smallest: nothing is certain then.
    test_exactly(walk, ray, block, lane, known ? 1 : -1);
  }
}

// Tests the first `count` triangles of a block: gn_triangle_filter and gn_met_at, eight at a time.
static inline void test_block(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* block, uint count,
                              int any_hit) {
  const GnRayFrame* frame = &ray->frame;
  __global const float8* c = (__global const float8*)block->corners;
  const uint kx = frame->kx, ky = frame->ky, kz = frame->kz;
  const float ox = frame->origin[kx], oy = frame->origin[ky], oz = frame->origin[kz];
  const float8 az = c[kz] - oz, bz = c[3u + kz] - oz, cz = c[6u + kz] - oz;
  const float8 ax = (c[kx] - ox) - frame->shear_x * az;
  const float8 ay = (c[ky] - oy) - frame->shear_y * az;
  const float8 bx = (c[3u + kx] - ox) - frame->shear_x * bz;
  const float8 by = (c[3u + ky] - oy) - frame->shear_y * bz;
  const float8 cx = (c[6u + kx] - ox) - frame->shear_x * cz;
  const float8 cy = (c[6u + ky] - oy) - frame->shear_y * cz;
  const float8 u = cx * by - cy * bx;
  const float8 v = ax * cy - ay * cx;
  const float8 w = bx * ay - by * ax;
  const float8 z = GN_MAX8(GN_MAX8(fabs(az), fabs(bz)), fabs(cz));
  const float8 px = GN_MAX8(GN_MAX8(fabs(ax), fabs(bx)), fabs(cx));
  const float8 py = GN_MAX8(GN_MAX8(fabs(ay), fabs(by)), fabs(cy));
  const float8 q = GN_MAX8(px, py) + GN_EDGE_SHIFT * z;
  const float8 bound = GN_FAST ? (float8)0.0f : GN_EDGE_ERROR_8 * (8.0f * q * (q + z)) + GN_EDGE_UNDERFLOW;
  const float8 largest = GN_MAX8(GN_MAX8(u, v), w), smallest = GN_MIN8(GN_MIN8(u, v), w);
  uint met = ~(lanes_above(largest, bound) & lanes_above(-bound, smallest)) & (255u >> (8u - count));
  if (met != 0u) {
    const uint inside = lanes_above(smallest, bound) | lanes_above(-bound, largest);
    const float8 share = 1.0f / (u + v + w);
    const float8 spread = GN_MAX8(GN_MAX8(az, bz), cz) - GN_MIN8(GN_MIN8(az, bz), cz);
    const float8 inverse = (float8)frame->inverse[kz];
    const float8 error = GN_FAST ? (float8)0.0f
                                 : ((4.0f * bound * spread + GN_MET_UNDERFLOW) * fabs(share) + GN_SLAB_SLACK * z +
                                    GN_MET_UNDERFLOW) *
                                           fabs(inverse) +
                                       GN_MET_UNDERFLOW;
    const float8 t = (u * share * az + v * share * bz + w * share * cz) * inverse;
    float nearest[8], farthest[8];
    vstore8(t - error, 0, nearest);
    vstore8(t + error, 0, farthest);
    do {
      const uint lane = lowest_bit(met);
      if ((inside >> lane) & 1u) {
        test_met(walk, ray, block, lane, nearest[lane], farthest[lane]);
      } else {
        test_exactly(walk, ray, block, lane, -1);
      }
      met &= met - 1u;
    } while (met != 0u && !(any_hit && walk->found));
  }
}

// True when an any-hit walk is over.
static inline int test_wide_leaf(GnWideWalk* walk, const GnWideRay* ray, __global const GnTriangleBlock* blocks,
                                 uint link, int any_hit) {
  uint left = gn_link_triangles(link);
  __global const GnTriangleBlock* block = blocks + gn_link_block(link);
#if GN_COUNTERS
  walk->triangles += left;
#endif
  for (;;) {
    test_block(walk, ray, block, min(left, GN_WIDTH), any_hit);
    if (any_hit && walk->found) return 1;
    if (left <= GN_WIDTH) return 0;
    left -= GN_WIDTH;
    block += 1;
  }
}

#endif
