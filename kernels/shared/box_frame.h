// Boxes that stand in a frame of their own, turned towards a light, say, while triangles stay where they are and are tested
// there: rays are turned for box tests alone, so hits are those of any other tree, bit for bit. Not for choosing a frame
// (gnomon/tree/box_frame.h). Feeds the wide tracer, its reference, trees of plans.
#ifndef GNOMON_SHARED_BOX_FRAME_H
#define GNOMON_SHARED_BOX_FRAME_H

#include "ray_math.h"

// rows: half of a rotation, row by row: |rows| <= 1/2, and no row's sum of magnitudes is above 7/8, so that what is turned
// is no larger than it was. Being a rotation matters to no hit: any linear map keeps a ray's t.
typedef struct GnBoxFrame {
  gn_f32 rows[9];
  gn_f32 size;  // no coordinate of a triangle is larger in magnitude
  gn_f32 pad[2];
} GnBoxFrame;
GN_SIZE_IS(GnBoxFrame, 48);

GN_INLINE void gn_turn(GN_GLOBAL const GnBoxFrame* frame, const gn_f32* v, gn_f32* out) {
  gn_u32 k;
  for (k = 0u; k < 3u; ++k)
    out[k] = frame->rows[3u * k] * v[0] + frame->rows[3u * k + 1u] * v[1] + frame->rows[3u * k + 2u] * v[2];
}

// A ray as boxes in a frame meet it. Planes met first are seen from an origin further on, the others from one further back:
// that widens every box by the margin.
typedef struct GnBoxRay {
  gn_f32 near_origin[3];
  gn_f32 far_origin[3];
  gn_f32 inverse[3];
} GnBoxRay;

// 2^-21, and what flushed denormals may lose.
#define GN_FRAME_MARGIN 4.7683716e-07f
#define GN_FRAME_UNDERFLOW 7.5231638e-37f

// The margin: with u = 2^-24, s the size, o and d the ray, and R the rows as they are, a turned vector v is off by
// 3u sum |R_j v_j|. So are
//   corners, in boxes:  3u 7/8 s
//   the origin:         3u 1/2 |o|, |.| being the sum of magnitudes
//   t times the direction, where the ray is in a triangle, and so |t d_j| <= s + |o_j|:  3u (7/8 s + 1/2 |o|)
//   the direction where a device flushes denormals: 9 2^-126 t, and |t| 2^-100 <= s + |o|:  2.3u (s + |o|)
//   the origin again, once the margin is added:  u (1/2 |o| + margin)
// together less than 7.6u s + 5.8u |o|, of which 8u (s + |o|) leaves enough for rounding the margin. Within it the ray as
// it is computed passes every box that the exact ray meets a triangle of, at the same t; from there on ray_math.h's slack
// holds as it does for other rays. |o| may overflow, its terms' shares do not.
GN_INLINE GnBoxRay gn_box_ray(GN_GLOBAL const GnBoxFrame* frame, const GnRay* ray) {
  GnBoxRay out;
  gn_f32 origin[3], direction[3], margin = GN_FRAME_MARGIN * frame->size + GN_FRAME_UNDERFLOW;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) margin += GN_FRAME_MARGIN * gn_abs(ray->origin[k]);
  gn_turn(frame, ray->origin, origin);
  gn_turn(frame, ray->direction, direction);
  for (k = 0u; k < 3u; ++k) {
    const gn_f32 inverse = gn_slab_inverse(direction[k]);
    const gn_f32 ahead = inverse < 0.0f ? -margin : margin;
    out.near_origin[k] = origin[k] + ahead;
    out.far_origin[k] = origin[k] - ahead;
    out.inverse[k] = inverse;
  }
  return out;
}

// gn_box_entry for a box in the frame.
GN_INLINE gn_f32 gn_framed_box_entry(const GnBoxRay* ray, const gn_f32* lo, const gn_f32* hi, gn_f32 tmin, gn_f32 limit) {
  gn_f32 near = tmin, far = GN_INFINITY;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) {
    const int backwards = ray->inverse[k] < 0.0f;
    const gn_f32 a = ((backwards ? hi[k] : lo[k]) - ray->near_origin[k]) * ray->inverse[k];
    const gn_f32 b = ((backwards ? lo[k] : hi[k]) - ray->far_origin[k]) * ray->inverse[k];
    near = gn_max(a, near);
    far = gn_min(b, far);
  }
  far = gn_min(gn_slab_limit(far), limit);
  return near <= far ? near : GN_INFINITY;
}

#endif
