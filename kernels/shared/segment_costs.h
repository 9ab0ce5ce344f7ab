// How many sampled segments of rays meet a box: what it costs the rays that they stand for, with where these begin, end and
// are stopped. Ours; a box is weighed by what is traced in Bittner, Havran 2009 (RDH), there while a tree is built.
// Feeds box_costs.h.
#ifndef GNOMON_SHARED_SEGMENT_COSTS_H
#define GNOMON_SHARED_SEGMENT_COSTS_H

#include "ray_math.h"

// Numbers of a segment, each in a plane of its own with those of all others, so that vectors of them are loaded at once:
// three of the origin, three slab reciprocals of the direction, and between which parameters the segment lies.
#define GN_SEGMENT_PLANES 8u

// Segments [0, count) that meet a box. Cost, not proof: a segment along a face may count or not.
GN_INLINE gn_u32 gn_segments_met(GN_GLOBAL const gn_f32* segments, gn_u32 count, const gn_f32* lo, const gn_f32* hi) {
  GN_GLOBAL const gn_f32* x = segments;
  GN_GLOBAL const gn_f32* y = x + count;
  GN_GLOBAL const gn_f32* z = y + count;
  GN_GLOBAL const gn_f32* inverse_x = z + count;
  GN_GLOBAL const gn_f32* inverse_y = inverse_x + count;
  GN_GLOBAL const gn_f32* inverse_z = inverse_y + count;
  GN_GLOBAL const gn_f32* least = inverse_z + count;
  GN_GLOBAL const gn_f32* most = least + count;
  gn_u32 i, met = 0u;
  for (i = 0u; i < count; ++i) {
    const gn_f32 ax = (lo[0] - x[i]) * inverse_x[i], bx = (hi[0] - x[i]) * inverse_x[i];
    const gn_f32 ay = (lo[1] - y[i]) * inverse_y[i], by = (hi[1] - y[i]) * inverse_y[i];
    const gn_f32 az = (lo[2] - z[i]) * inverse_z[i], bz = (hi[2] - z[i]) * inverse_z[i];
    const gn_f32 near = gn_max(gn_max(gn_min(ax, bx), gn_min(ay, by)), gn_max(gn_min(az, bz), least[i]));
    const gn_f32 far = gn_min(gn_min(gn_max(ax, bx), gn_max(ay, by)), gn_min(gn_max(az, bz), most[i]));
    met += near <= far ? 1u : 0u;
  }
  return met;
}

#endif
