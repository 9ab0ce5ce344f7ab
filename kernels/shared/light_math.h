// Lights as paths see them, for both compilers: how much one could bring to a place, a direction drawn towards it, and
// how likely that direction was. Not for visibility: that is a ray's business. Point lights and spots fall off as
// KHR_lights_punctual says; area lights shine to both sides, evenly; the sky is a gradient from all sides.
#ifndef GNOMON_SHARED_LIGHT_MATH_H
#define GNOMON_SHARED_LIGHT_MATH_H

#include "bsdf_math.h"

// A place lit: where rays start, and the unit normal.
typedef struct GnPlace {
  gn_f32 position[3];
  gn_f32 normal[3];
} GnPlace;

GN_INLINE gn_f32 gn_clamped(gn_f32 x) { return gn_max(0.0f, gn_min(1.0f, x)); }
GN_INLINE gn_lanes gn_lanes_clamped(gn_lanes x) { return gn_lanes_max(GN_ALL(0.0f), gn_lanes_min(GN_ALL(1.0f), x)); }

// Below the horizon the ground's colour comes in over so much of the height.
#define GN_HAZE_RECIPROCAL 4.0f

// The sky along a unit direction.
GN_INLINE void gn_sky_radiance(GN_GLOBAL const GnPathFrame* frame, const gn_f32* direction, gn_f32* radiance) {
  const gn_f32 height = direction[1];
  const gn_f32 share =
      height < 0.0f ? gn_min(1.0f, -height * GN_HAZE_RECIPROCAL) : gn_root(gn_min(1.0f, height));
  int k;
  for (k = 0; k < 3; ++k) {
    const gn_f32 end = height < 0.0f ? frame->ground[k] : frame->zenith[k];
    radiance[k] = frame->horizon[k] + share * (end - frame->horizon[k]);
  }
}

// The way from a place to a point: its square, and the unit direction; 0 where they are the same.
GN_INLINE int gn_way_to(const gn_f32* from, const gn_f32* to, gn_f32* direction, gn_f32* square) {
  int k;
  for (k = 0; k < 3; ++k) direction[k] = to[k] - from[k];
  *square = gn_dot(direction, direction);
  return gn_make_unit(direction);
}

// As many lights as there are lanes, from the one that `rows` stands at (path_layout.h).
typedef struct GnLights {
  gn_lanes kind, strength, range, cone, cone_scale, position[3], direction[3];
} GnLights;

GN_LANES_INLINE void gn_lights_at(GN_GLOBAL const gn_f32* rows, gn_u32 stride, GnLights* lights) {
  int k;
  lights->kind = gn_lanes_at(rows + GN_LIGHT_KINDS * stride);
  lights->strength = gn_lanes_at(rows + GN_LIGHT_STRENGTHS * stride);
  lights->range = gn_lanes_at(rows + GN_LIGHT_RANGES * stride);
  lights->cone = gn_lanes_at(rows + GN_LIGHT_CONES * stride);
  lights->cone_scale = gn_lanes_at(rows + GN_LIGHT_CONE_SCALES * stride);
  for (k = 0; k < 3; ++k) {
    lights->position[k] = gn_lanes_at(rows + (GN_LIGHT_POSITIONS + (gn_u32)k) * stride);
    lights->direction[k] = gn_lanes_at(rows + (GN_LIGHT_DIRECTIONS + (gn_u32)k) * stride);
  }
}

// The share of point lights' intensity that arrives per area across the way, `square` away, as seen from them along
// `from` (unit).
GN_LANES_INLINE gn_lanes gn_point_falloffs(const GnLights* lights, gn_lanes square, const gn_lanes* from) {
  const gn_lanes along = lights->direction[0] * from[0] + lights->direction[1] * from[1] + lights->direction[2] * from[2];
  const gn_lanes cone = gn_lanes_clamped((along - lights->cone) * lights->cone_scale);
  const gn_lanes nearness = square * gn_reciprocals(lights->range * lights->range);
  const gn_lanes window = lights->range > 0.0f ? gn_lanes_clamped(1.0f - nearness * nearness) : GN_ALL(1.0f);
  return window * cone * cone * gn_reciprocals(gn_lanes_max(square, GN_ALL(1e-30f)));
}

// What points and spots bring a place that nothing hides from them; the way there by gn_way_to, side by side.
GN_LANES_INLINE gn_lanes gn_open_points(const GnLights* lights, const GnPlace* place, const gn_lanes* way,
                                        gn_lanes square) {
  const gn_lanes longest =
      gn_lanes_max(gn_lanes_abs(way[0]), gn_lanes_max(gn_lanes_abs(way[1]), gn_lanes_abs(way[2])));
  const gn_lanes scale = gn_powers_near_reciprocal(longest);
  gn_lanes unit[3], from[3], unit_square, factor, facing;
  int k;
  for (k = 0; k < 3; ++k) unit[k] = way[k] * scale;
  unit_square = unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2];
  factor = gn_reciprocal_roots(unit_square);
  for (k = 0; k < 3; ++k) {
    unit[k] = unit[k] * factor;
    from[k] = -unit[k];
  }
  facing = gn_lanes_max(GN_ALL(0.0f), gn_lanes_dot(unit, place->normal));
  return unit_square > 1e-30f ? facing * lights->strength * gn_point_falloffs(lights, square, from) : GN_ALL(0.0f);
}

// About what lights would bring a place if nothing were in between: exactly so for points and suns, and never 0 where
// an area light brings something.
GN_LANES_INLINE gn_lanes gn_open_lights(const GnLights* lights, const GnPlace* place, gn_u32 strategy) {
  const gn_lanes none = GN_ALL(0.0f);
  gn_lanes way[3], square, sun, point, area, sky, brought;
  int k;
  for (k = 0; k < 3; ++k) way[k] = lights->position[k] - place->position[k];
  square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
  sun = gn_lanes_max(none, -gn_lanes_dot(lights->direction, place->normal)) * lights->strength;
  point = gn_open_points(lights, place, way, square);
  area = lights->strength *
         gn_reciprocals(gn_lanes_max(gn_lanes_max(square, lights->range * lights->range), GN_ALL(1e-30f)));
  // All of it behind the surface.
  area = gn_lanes_dot(way, place->normal) < -1.001f * lights->range ? none : area;
  if (strategy == GN_STRATEGY_SURFACES) area = none;
  // Scattered rays find the sky as well as drawn ones would, so it is drawn only where they do not count.
  sky = none;
  if (strategy == GN_STRATEGY_LIGHTS) sky = lights->strength;
  brought = lights->kind == (gn_f32)GN_LIGHT_SKY ? sky : area;
  brought = lights->kind == (gn_f32)GN_LIGHT_SUN ? sun : brought;
  return lights->kind == (gn_f32)GN_LIGHT_POINT ? point : brought;
}

// What choosing between lights goes by: the root of that. The strongest light is hidden in many places, and what others
// bring there would be noise if they were asked seldom. rows: at the first of the lights.
GN_LANES_INLINE gn_lanes gn_importances(GN_GLOBAL const gn_f32* rows, gn_u32 stride, const GnPlace* place,
                                        gn_u32 strategy) {
  GnLights lights;
  gn_lights_at(rows, stride, &lights);
  return gn_roots(gn_open_lights(&lights, place, strategy));
}

// The emitter that holds this much of its light's running area.
GN_INLINE gn_u32 gn_emitter_at(GN_GLOBAL const GnEmitter* emitters, gn_u32 first, gn_u32 count, gn_f32 area) {
  gn_u32 low = first, high = first + count - 1u;
  while (low < high) {
    const gn_u32 middle = low + (high - low) / 2u;
    if (area < emitters[middle].running_area) {
      high = middle;
    } else {
      low = middle + 1u;
    }
  }
  return low;
}

// The light of a triangle, or GN_NONE.
GN_INLINE gn_u32 gn_light_of(GN_GLOBAL const GnEmitterLink* links, gn_u32 count, gn_u32 triangle) {
  gn_u32 low = 0u, high = count;
  while (low < high) {
    const gn_u32 middle = low + (high - low) / 2u;
    if (links[middle].triangle < triangle) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  return low < count && links[low].triangle == triangle ? links[low].light : GN_NONE;
}

// A triangle's unit normal, or zeros for one without area. Scaled first: products of large coordinates would overflow.
GN_INLINE void gn_triangle_normal(const GnTriangle* t, gn_f32* normal) {
  gn_f32 a[3], b[3], scale;
  int k;
  for (k = 0; k < 3; ++k) {
    a[k] = t->v1[k] - t->v0[k];
    b[k] = t->v2[k] - t->v0[k];
  }
  scale = gn_power_near_reciprocal(gn_max(gn_largest(a), gn_largest(b)));
  for (k = 0; k < 3; ++k) {
    a[k] = a[k] * scale;
    b[k] = b[k] * scale;
  }
  gn_cross(a, b, normal);
  if (!gn_make_unit(normal)) normal[0] = normal[1] = normal[2] = 0.0f;
}

// By solid angle, the reciprocal density of an even choice of a light's points, for one `square` away seen at this
// cosine.
GN_INLINE gn_f32 gn_area_per_angle(const GnPathLight* light, gn_f32 square, gn_f32 cosine) {
  return light->area * gn_abs(cosine) * gn_reciprocal(gn_max(square, 1e-30f));
}

#endif
