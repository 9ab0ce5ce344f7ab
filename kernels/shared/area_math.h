// Whether a ray starts in an influence area, is meant for it, and how far it stays inside, in float for both compilers.
// The answers are safe: a ray called inside is truly inside from the rounded t = tmin to the rounded t = exit, so the
// area's triangles are all that it can meet there. Not for the regions themselves (host/areas, in double).
// Feeds trace_areas.cl and host/tree/top_level.cpp.
//
// Why safe. Let u = 2^-24, and R the largest number at hand: a coordinate of the region's box or of the origin, plus
// |tmin| times a component of the direction. What may be wrong, as a distance:
//   a plane's value at a point of the box       12.2 u R   normals, products, sums, offset; |n| = 1, |p| <= sqrt(3) R
//   the start point origin + tmin direction      3.5 u R   two roundings a coordinate
//   t = tmin or exit, and a hit's t, rounded     5.2 u R   what is left of it at tmin; along the way see below
// together 21 u R, and the margin is 32 u R = 2^-19 R. A slope n . d / max|d_k| is off by at most 15.6 u: GN_AREA_SLOPE
// = 16 u makes it steeper. Two quotients of 2.5 ulp, the sum with tmin and the hit's rounding take 13 u of the length:
// GN_AREA_SHORTER = 16 u makes it shorter. With that, for every plane, its value is >= 0 at both ends: since the region
// is convex, between them too. A ball needs 14 u R for centre, radius and start; its quadratic has a backward error of
// 94 u in the squared radius, 47 u R; a square root off by 3 ulp takes 4 u more of the length, 14 u R: four margins.
#ifndef GNOMON_SHARED_AREA_MATH_H
#define GNOMON_SHARED_AREA_MATH_H

#include "area_layout.h"
#include "build_layout.h"
#include "elementary_math.h"

#define GN_AREA_MARGIN 1.9073486e-06f   // 2^-19
#define GN_AREA_SLOPE 9.5367432e-07f    // 2^-20
#define GN_AREA_SHORTER 9.9999905e-01f  // 1 - 2^-20

#ifdef __OPENCL_VERSION__
GN_INLINE gn_f32 gn_device_root(gn_f32 x) { return sqrt(x); }
#else
GN_INLINE gn_f32 gn_device_root(gn_f32 x) { return std::sqrt(x); }
#endif

// A ray as areas see it: only the part from tmin on counts.
typedef struct GnRayStart {
  gn_f32 point[3];      // origin + tmin * direction
  gn_f32 reach;         // R above, without the area's share
  gn_f32 direction[3];  // over its largest component
  gn_f32 largest;       // that component's magnitude
  gn_f32 tmin;
} GnRayStart;

GN_INLINE gn_f32 gn_largest_of(const gn_f32* v) { return gn_max(gn_max(gn_abs(v[0]), gn_abs(v[1])), gn_abs(v[2])); }

// Of a valid ray (gn_ray_is_valid). With an infinite tmin the point is in no box.
GN_INLINE GnRayStart gn_ray_start(const GnRay* ray) {
  GnRayStart start;
  int k;
  start.largest = gn_largest_of(ray->direction);
  start.reach = gn_largest_of(ray->origin) + gn_abs(ray->tmin) * start.largest;
  start.tmin = ray->tmin;
  for (k = 0; k < 3; ++k) {
    start.point[k] = ray->origin[k] + ray->tmin * ray->direction[k];
    start.direction[k] = ray->direction[k] / start.largest;
  }
  return start;
}

// False for NaN.
GN_INLINE int gn_box_has(const gn_f32* lo, const gn_f32* hi, const gn_f32* p) {
  return lo[0] <= p[0] && p[0] <= hi[0] && lo[1] <= p[1] && p[1] <= hi[1] && lo[2] <= p[2] && p[2] <= hi[2];
}

// The octree's cell of eight that holds the point, as whose box lo and hi are left.
GN_INLINE gn_u32 gn_octree_step(gn_f32* lo, gn_f32* hi, const gn_f32* p) {
  gn_u32 number = 0u;
  int k;
  for (k = 0; k < 3; ++k) {
    const gn_f32 middle = 0.5f * (lo[k] + hi[k]);
    if (p[k] >= middle) {
      lo[k] = middle;
      number |= 1u << k;
    } else {
      hi[k] = middle;
    }
  }
  return number;
}

GN_INLINE gn_f32 gn_area_margin(const GnArea* area, const GnRayStart* start) {
  return GN_AREA_MARGIN * gn_max(area->size, start->reach);
}

// The ball's radius less its margin; negative when nothing is left of it.
GN_INLINE gn_f32 gn_ball_radius(const GnArea* area, gn_f32 margin) { return area->radius - 4.0f * margin; }

// Whether the ray starts inside for certain.
GN_INLINE int gn_area_contains(const GnArea* area, const GnRayStart* start) {
  const gn_f32 margin = gn_area_margin(area, start);
  int i, inside = gn_box_has(area->lo, area->hi, start->point);
  if (area->kind == GN_AREA_OMNI) {
    const gn_f32 radius = gn_ball_radius(area, margin);
    gn_f32 q[3];
    for (i = 0; i < 3; ++i) q[i] = start->point[i] - area->focus[i];
    return inside && radius >= 0.0f && gn_dot(q, q) <= radius * radius;
  }
  for (i = 0; i < GN_AREA_PLANES; ++i) {
    inside &= gn_dot(area->planes + 4 * i, start->point) + area->planes[4 * i + 3] >= margin;
  }
  return inside;
}

// Whether the area's tree is meant for the ray's direction, either sense. Decides speed only, so it may round.
GN_INLINE int gn_area_is_affine(const GnArea* area, const GnRayStart* start) {
  gn_f32 v[3], along;
  int k;
  for (k = 0; k < 3; ++k) {
    v[k] = area->kind == GN_AREA_PLANE ? area->focus[k] : start->point[k] - area->focus[k];
  }
  along = gn_dot(v, start->direction);
  return along * along >= area->affinity * gn_dot(v, v) * gn_dot(start->direction, start->direction);
}

// How far along start->direction the ball reaches: the root of |q + x d|^2 = radius^2 in the form that does not cancel.
GN_INLINE gn_f32 gn_ball_exit(const GnArea* area, const GnRayStart* start, gn_f32 margin) {
  const gn_f32 radius = gn_ball_radius(area, margin);
  gn_f32 q[3], a, b, c, root;
  int k;
  for (k = 0; k < 3; ++k) q[k] = start->point[k] - area->focus[k];
  a = gn_dot(start->direction, start->direction);
  b = gn_dot(q, start->direction);
  c = gn_min(gn_dot(q, q) - radius * radius, 0.0f);
  root = gn_device_root(b * b - a * c);
  if (b > 0.0f) return -c / (b + root);
  return (root - b) / a;
}

// A parameter up to which the ray is inside, given gn_area_contains: at least tmin.
GN_INLINE gn_f32 gn_area_exit(const GnArea* area, const GnRayStart* start) {
  const gn_f32 margin = gn_area_margin(area, start);
  gn_f32 length = GN_INFINITY;
  int i;
  if (area->kind == GN_AREA_OMNI) {
    length = gn_ball_exit(area, start, margin);
  } else {
    for (i = 0; i < GN_AREA_PLANES; ++i) {
      const gn_f32 distance = gn_dot(area->planes + 4 * i, start->point) + area->planes[4 * i + 3] - margin;
      const gn_f32 slope = gn_dot(area->planes + 4 * i, start->direction) - GN_AREA_SLOPE;
      if (slope < 0.0f) length = gn_min(distance / -slope, length);
    }
  }
  return start->tmin + length / start->largest * GN_AREA_SHORTER;
}

#endif
