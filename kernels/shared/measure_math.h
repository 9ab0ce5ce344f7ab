// How likely rays are to hit a box, up to a constant: the surface area (rays from everywhere) or the area as the rays
// of a light see it (the projected area heuristic). Compiled by both compilers, without division, square root or a
// library call: the same bits on every device. Not exact references (host/areas/projection.h is, in double).
// A measure is monotone under inclusion and additive over candidates, so builders may treat all alike.
// Sources: Goldsmith & Salmon 1987 (surface area); Havran & Bittner 1999 (preferred directions); Van Oosterom &
// Strackee 1983 (solid angle of a triangle). Feeds cost_math.h.
#ifndef GNOMON_SHARED_MEASURE_MATH_H
#define GNOMON_SHARED_MEASURE_MATH_H

#include "custom_measure.h"
#include "seen_measure.h"

// w . (dy dz, dx dz, dx dy) of boxes with these extents. Weights 1: half the surface area (SAH). Weights |n|: the area
// parallel rays along n see (PAH). Means over a cone of directions, and mixtures of all these, are other weights and cost
// the same.
GN_INLINE gn_lanes gn_weighed_faces(const gn_f32* w, gn_lanes dx, gn_lanes dy, gn_lanes dz) {
  return dx * (w[1] * dz + w[2] * dy) + w[0] * dy * dz;
}

// Half the surface area, which settles ties whatever the measure.
GN_INLINE gn_lanes gn_half_surface(gn_lanes dx, gn_lanes dy, gn_lanes dz) { return dx * (dy + dz) + dy * dz; }

// Of one box, by its extents: a box in another address space need not be copied for it.
GN_INLINE gn_f32 gn_linear_extents(const gn_f32* w, gn_f32 dx, gn_f32 dy, gn_f32 dz) {
  return gn_first_lane(gn_weighed_faces(w, GN_ALL(dx), GN_ALL(dy), GN_ALL(dz)));
}

GN_INLINE gn_f32 gn_linear_measure(const gn_f32* w, const gn_f32* lo, const gn_f32* hi) {
  return gn_linear_extents(w, hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
}

GN_INLINE gn_f32 gn_surface_measure(const gn_f32* lo, const gn_f32* hi) {
  return gn_first_lane(gn_half_surface(GN_ALL(hi[0] - lo[0]), GN_ALL(hi[1] - lo[1]), GN_ALL(hi[2] - lo[2])));
}

// How the parts of a node with this box are to be measured: GN_SEEN_*, 0 where there is nothing to choose.
GN_INLINE int gn_measure_how(const GnMeasure* measure, const gn_f32* lo, const gn_f32* hi) {
  if (gn_kind_of(measure) == GN_MEASURE_LINEAR || gn_kind_of(measure) == GN_MEASURE_CUSTOM) return 0;
  return gn_seen_how(measure, lo, hi);
}

// The same of a node whose parent's parts were measured `before` (GN_SEEN_PRECISE where there is none). What
// one step serves, or no ray meets, is not looked at again: its parts are no larger, and no less inside the
// window.
GN_INLINE int gn_measure_how_below(const GnMeasure* measure, int before, const gn_f32* lo, const gn_f32* hi) {
  if (before == GN_SEEN_ONE_STEP || before == GN_SEEN_NOTHING) return before;
  return gn_measure_how(measure, lo, hi);
}

// Whether the measure takes steps (step_measure.h) where `how` says so.
GN_INLINE int gn_has_steps(const GnMeasure* measure) {
  const gn_u32 kind = gn_kind_of(measure);
  return kind == GN_MEASURE_SOLID_ANGLE || kind == GN_MEASURE_NEAR_PLANE || kind == GN_MEASURE_YAW_PITCH;
}

// Whether boxes measured this way need no more than three face weights, which are w then: linear measures always, the
// others where no ray meets the node, parallel rays also where the window holds all of it.
GN_INLINE int gn_linear_part(const GnMeasure* measure, int how, gn_f32* w) {
  const gn_u32 kind = gn_kind_of(measure);
  const int linear = kind == GN_MEASURE_LINEAR;
  const int aside = !linear && kind != GN_MEASURE_CUSTOM && how == GN_SEEN_NOTHING;
  const int inside = kind == GN_MEASURE_WINDOW && how == GN_SEEN_ONE_STEP;
  gn_u32 k;
  for (k = 0u; k < 3u; ++k) {
    w[k] = measure->weights[k];
    if (inside) w[k] += measure->area_scale * gn_abs(measure->forward[k]);
  }
  return linear || aside || inside;
}

// The measure of boxes that need more than that.
GN_INLINE gn_f32 gn_curved_measure(const GnMeasure* measure, int how, const gn_f32* lo, const gn_f32* hi) {
  const gn_f32 seen = gn_kind_of(measure) == GN_MEASURE_CUSTOM ? gn_custom_measure(measure, lo, hi)
                                                                  : gn_seen_measure(measure, how, lo, hi);
  return measure->area_scale * seen + gn_linear_measure(measure->weights, lo, hi);
}

// The heuristic seam: what a builder minimises. how: gn_measure_how of the node whose parts are measured, so that
// all its candidates are compared by one formula.
GN_INLINE gn_f32 gn_box_measure(const GnMeasure* measure, int how, const gn_f32* lo, const gn_f32* hi) {
  gn_f32 w[3];
  if (gn_linear_part(measure, how, w)) return gn_linear_measure(w, lo, hi);
  return gn_curved_measure(measure, how, lo, hi);
}

#endif
