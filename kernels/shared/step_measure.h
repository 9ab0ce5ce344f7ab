// Measures of boxes that rays from a point see whole, no side of a window cutting them, in every lane at once: in one step
// where the box is small as seen from the eye, in a few where it is not large. Not for parallel rays, whose measure is
// linear then (measure_math.h), nor for large boxes or ones that a window cuts (seen_measure.h). Feeds seen_measure.h.
#ifndef GNOMON_SHARED_STEP_MEASURE_H
#define GNOMON_SHARED_STEP_MEASURE_H

#include "build_layout.h"
#include "elementary_math.h"

// A patch of surface of some area at p, its plane at height h from the eye, measures area * h * distance^-3: d omega = n .
// p dA / |p|^3. Near-plane areas have forward . p for the distance |p|; in yaw and pitch one of the three factors is the
// distance from the up axis instead: dyaw dpitch = d omega / cos(pitch).
typedef struct GnNearness {
  gn_lanes twice;  // 1 / distance, two factors
  gn_lanes once;   // the third
} GnNearness;

// square: p . p; along: forward . p; above: up . p.
GN_LANES_INLINE GnNearness gn_nearness(const GnMeasure* m, gn_lanes square, gn_lanes along, gn_lanes above) {
  const gn_lanes smallest = GN_ALL(1e-30f);
  const gn_u32 kind = gn_kind_of(m);
  GnNearness near;
  near.twice = kind == GN_MEASURE_NEAR_PLANE ? gn_reciprocals(gn_lanes_max(along, smallest))
                                             : gn_rough_reciprocal_roots(gn_lanes_max(square, smallest));
  near.once = near.twice;
  if (kind == GN_MEASURE_YAW_PITCH) {
    const gn_lanes level = gn_lanes_max(square - above * above, 1e-12f * square);
    near.once = gn_rough_reciprocal_roots(gn_lanes_max(level, smallest));
  }
  return near;
}

// The one-step measure: the box's area as seen along the ray through its middle. Faces on both sides of an axis average to
// |p_k| where the eye is beyond them, and to half the size where it is between them.
GN_LANES_INLINE gn_lanes gn_one_step_measures(const GnMeasure* m, const GnBoxes* box) {
  const gn_lanes dx = box->hi[0] - box->lo[0], dy = box->hi[1] - box->lo[1], dz = box->hi[2] - box->lo[2];
  gn_lanes p[3];
  GnNearness near;
  p[0] = 0.5f * (box->lo[0] + box->hi[0]) - m->origin[0];
  p[1] = 0.5f * (box->lo[1] + box->hi[1]) - m->origin[1];
  p[2] = 0.5f * (box->lo[2] + box->hi[2]) - m->origin[2];
  near = gn_nearness(m, p[0] * p[0] + p[1] * p[1] + p[2] * p[2], gn_lanes_dot(p, m->forward), gn_lanes_dot(p, m->up));
  p[0] = gn_lanes_max(gn_lanes_abs(p[0]), 0.5f * dx) * near.once;
  p[1] = gn_lanes_max(gn_lanes_abs(p[1]), 0.5f * dy) * near.once;
  p[2] = gn_lanes_max(gn_lanes_abs(p[2]), 0.5f * dz) * near.once;
  return (p[0] * dy * dz + dx * (p[1] * dz + p[2] * dy)) * near.twice * near.twice;
}

// What a place on one axis adds to the numbers above.
typedef struct GnPlaces {
  gn_lanes square;
  gn_lanes along;
  gn_lanes above;
} GnPlaces;

GN_LANES_INLINE GnPlaces gn_places(const GnMeasure* m, gn_u32 axis, gn_lanes at) {
  GnPlaces places;
  places.square = at * at;
  places.along = at * m->forward[axis];
  places.above = at * m->up[axis];
  return places;
}

// The measure of a patch at places a, b, c of the three axes.
GN_LANES_INLINE gn_lanes gn_patches(const GnMeasure* m, gn_lanes area, gn_lanes height, const GnPlaces* a, const GnPlaces* b,
                                    const GnPlaces* c) {
  const GnNearness near =
      gn_nearness(m, a->square + b->square + c->square, a->along + b->along + c->along, a->above + b->above + c->above);
  return area * near.twice * near.twice * (height * near.once);
}

// The few-step measure: Gauss's rule of two by two points on each face that rays enter by: the lower one where that is
// ahead of the eye, the upper one where that is behind, neither between the two.
GN_LANES_INLINE gn_lanes gn_few_step_measures(const GnMeasure* m, const GnBoxes* box) {
  GnPlaces points[6], entry[3];
  gn_lanes d[3], height[3], sum = GN_ALL(0.0f);
  gn_u32 k, i;
  for (k = 0u; k < 3u; ++k) {
    const gn_lanes lower = box->lo[k] - m->origin[k], upper = box->hi[k] - m->origin[k];
    const gn_lanes middle = 0.5f * (lower + upper), nearer = lower > 0.0f ? lower : upper;
    d[k] = box->hi[k] - box->lo[k];
    height[k] = ((lower > 0.0f) | (upper < 0.0f)) ? gn_lanes_abs(nearer) : GN_ALL(0.0f);
    entry[k] = gn_places(m, k, nearer);
    points[2u * k] = gn_places(m, k, middle - 0.28867513f * d[k]);  // half of 1 / sqrt(3)
    points[2u * k + 1u] = gn_places(m, k, middle + 0.28867513f * d[k]);
  }
  for (k = 0u; k < 3u; ++k) {
    const gn_u32 u = k == 2u ? 0u : k + 1u, v = u == 2u ? 0u : u + 1u;
    const gn_lanes area = 0.25f * d[u] * d[v];
    for (i = 0u; i < 4u; ++i) {
      sum = sum + gn_patches(m, area, height[k], &entry[k], &points[2u * u + (i & 1u)], &points[2u * v + (i >> 1)]);
    }
  }
  return sum;
}

#endif
