// Where a ray belongs when a batch is sorted by the lights that its rays go to, for both compilers: first by its light, then
// by where it lies among that light's rays, so that those that follow each other make packets (packet_rays.h). Rays of a
// point are told apart by their directions: by octant and largest component, then by cells of the other two over that one,
// along a curve. Those of a sun, and at last those of no light, by their origins' cells (host/notes/ray-sorting.md). In
// lanes: a ray in each. Feeds ray_sort.cl.
#ifndef GNOMON_SHARED_LIGHT_KEY_H
#define GNOMON_SHARED_LIGHT_KEY_H

#include "elementary_math.h"

// Three passes of nine bits. Five are the light's.
#define GN_LIGHT_KEY_BITS 27u
#define GN_LIGHT_PLACE_BITS 22u
#define GN_MOST_RAY_LIGHTS 31u  // one more stands for none

#define GN_PLACE_CELLS 128u      // of origins, along the scene's longest side
#define GN_DIRECTION_CELLS 256u  // from 0 to 1 of a component over the largest one

// A point that rays go to or come from, or the way, in either sense, of a sun's parallel ones.
typedef struct GnRayLight {
  gn_f32 place[3];
  gn_u32 is_sun;
} GnRayLight;
GN_SIZE_IS(GnRayLight, 16);

// How far a ray may be off its light's way: rounding and then some. A ray too many costs little.
#define GN_OFF_LIGHT 0.001f

GN_INLINE gn_lanes gn_largest_lanes(const gn_lanes* v) {
  return gn_lanes_max(gn_lanes_abs(v[0]), gn_lanes_max(gn_lanes_abs(v[1]), gn_lanes_abs(v[2])));
}

// False where something is NaN.
GN_INLINE gn_lane_mask gn_goes_with_light(GnRayLight light, const gn_lanes* origin, const gn_lanes* direction) {
  gn_lanes way[3], off[3];
  int k;
  for (k = 0; k < 3; ++k) way[k] = light.is_sun ? GN_ALL(light.place[k]) : light.place[k] - origin[k];
  off[0] = way[1] * direction[2] - way[2] * direction[1];
  off[1] = way[2] * direction[0] - way[0] * direction[2];
  off[2] = way[0] * direction[1] - way[1] * direction[0];
  return gn_largest_lanes(off) <= GN_OFF_LIGHT * (gn_largest_lanes(way) * gn_largest_lanes(direction));
}

// The first of `count` lights that each ray goes with, or GN_MOST_RAY_LIGHTS. pencil: 1 where that is a point.
GN_INLINE gn_lane_bits gn_lights_of(GN_GLOBAL const GnRayLight* lights, gn_u32 count, const gn_lanes* origin,
                                    const gn_lanes* direction, gn_lane_bits* pencil) {
  gn_lane_bits found = GN_ALL_BITS(GN_MOST_RAY_LIGHTS);
  gn_u32 i;
  *pencil = GN_ALL_BITS(0u);
  for (i = 0u; i < count; ++i) {
    const GnRayLight light = lights[i];
    const gn_lane_mask first = gn_goes_with_light(light, origin, direction) & (found == GN_ALL_BITS(GN_MOST_RAY_LIGHTS));
    found = first ? GN_ALL_BITS(i) : found;
    *pencil = first ? GN_ALL_BITS(1u - light.is_sun) : *pencil;
  }
  return found;
}

// In [0, cells); NaN goes to 0.
GN_INLINE gn_lane_bits gn_cells_of(gn_lanes x, gn_u32 cells) {
  return gn_whole_lanes(gn_lanes_min(gn_lanes_max(x, GN_ALL(0.0f)), GN_ALL((gn_f32)(cells - 1u))));
}

// Eight bits, a zero above each, and two zeros above each.
GN_INLINE gn_lane_bits gn_spread_by_two(gn_lane_bits x) {
  x = (x | (x << 4)) & 0x0f0fu;
  x = (x | (x << 2)) & 0x3333u;
  return (x | (x << 1)) & 0x5555u;
}
GN_INLINE gn_lane_bits gn_spread_by_three(gn_lane_bits x) {
  x = (x | (x << 8)) & 0x00f00fu;
  x = (x | (x << 4)) & 0x0c30c3u;
  return (x | (x << 2)) & 0x249249u;
}

// Where the direction of a ray through a point lies: main axis, octant, cell.
GN_INLINE gn_lane_bits gn_pencil_places(const gn_lanes* direction) {
  const gn_lanes x = gn_lanes_abs(direction[0]), y = gn_lanes_abs(direction[1]), z = gn_lanes_abs(direction[2]);
  const gn_lane_mask along_z = z > gn_lanes_max(x, y), along_y = y > x;
  const gn_lanes cells = (gn_f32)GN_DIRECTION_CELLS * gn_reciprocals(along_z ? z : along_y ? y : x);
  const gn_lane_bits i = gn_cells_of((along_z ? x : along_y ? z : y) * cells, GN_DIRECTION_CELLS);
  const gn_lane_bits j = gn_cells_of((along_z ? y : along_y ? x : z) * cells, GN_DIRECTION_CELLS);
  const gn_lane_bits axis = along_z ? GN_ALL_BITS(2u) : along_y ? GN_ALL_BITS(1u) : GN_ALL_BITS(0u);
  const gn_lane_bits signs = (gn_bits_of_lanes(direction[0]) >> 31) << 2 | (gn_bits_of_lanes(direction[1]) >> 31) << 1 |
                             gn_bits_of_lanes(direction[2]) >> 31;
  return axis << 19 | signs << 16 | gn_spread_by_two(i) << 1 | gn_spread_by_two(j);
}

// lo, scale: of the scene; cells per unit.
GN_INLINE gn_lane_bits gn_light_keys(GN_GLOBAL const GnRayLight* lights, gn_u32 count, const gn_f32* lo, gn_f32 scale,
                                     const gn_lanes* origin, const gn_lanes* direction) {
  gn_lane_bits pencil, place;
  const gn_lane_bits light = gn_lights_of(lights, count, origin, direction, &pencil);
  place = gn_spread_by_three(gn_cells_of((origin[0] - lo[0]) * scale, GN_PLACE_CELLS)) << 2 |
          gn_spread_by_three(gn_cells_of((origin[1] - lo[1]) * scale, GN_PLACE_CELLS)) << 1 |
          gn_spread_by_three(gn_cells_of((origin[2] - lo[2]) * scale, GN_PLACE_CELLS));
  return light << GN_LIGHT_PLACE_BITS | (pencil != GN_ALL_BITS(0u) ? gn_pencil_places(direction) : place);
}

#endif
