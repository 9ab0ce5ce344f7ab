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

// The share of a point light's intensity that arrives per area across the way, `square` away, as seen from it along
// `from` (unit).
GN_INLINE gn_f32 gn_point_falloff(const GnPathLight* light, gn_f32 square, const gn_f32* from) {
  const gn_f32 cone = gn_clamped((gn_dot(light->direction, from) - light->cos_outer) * light->cone_scale);
  gn_f32 window = 1.0f;
  if (light->range > 0.0f) {
    const gn_f32 nearness = square * gn_reciprocal(light->range * light->range);
    window = gn_clamped(1.0f - nearness * nearness);
  }
  return window * cone * cone * gn_reciprocal(gn_max(square, 1e-30f));
}

// The way from a place to a point: its square, and the unit direction; 0 where they are the same.
GN_INLINE int gn_way_to(const gn_f32* from, const gn_f32* to, gn_f32* direction, gn_f32* square) {
  int k;
  for (k = 0; k < 3; ++k) direction[k] = to[k] - from[k];
  *square = gn_dot(direction, direction);
  return gn_make_unit(direction);
}

// About what a light would bring a place if nothing were in between: exactly so for points and suns, and never 0 where
// an area light brings something.
GN_INLINE gn_f32 gn_open_light(const GnPathLight* light, const GnPlace* place, gn_u32 strategy) {
  gn_f32 direction[3], square, facing;
  int k;
  if (light->kind == GN_LIGHT_SUN) return gn_max(0.0f, -gn_dot(light->direction, place->normal)) * light->strength;
  // Scattered rays find the sky as well as drawn ones would, so it is drawn only where they do not count.
  if (light->kind == GN_LIGHT_SKY) return strategy == GN_STRATEGY_LIGHTS ? light->strength : 0.0f;
  if (light->kind == GN_LIGHT_AREA && strategy == GN_STRATEGY_SURFACES) return 0.0f;
  if (light->kind == GN_LIGHT_POINT) {
    if (!gn_way_to(place->position, light->position, direction, &square)) return 0.0f;
    facing = gn_max(0.0f, gn_dot(direction, place->normal));
    for (k = 0; k < 3; ++k) direction[k] = -direction[k];
    return facing * light->strength * gn_point_falloff(light, square, direction);
  }
  for (k = 0; k < 3; ++k) direction[k] = light->position[k] - place->position[k];
  square = gn_dot(direction, direction);
  // All of it behind the surface.
  if (gn_dot(direction, place->normal) < -1.001f * light->range) return 0.0f;
  return light->strength * gn_reciprocal(gn_max(gn_max(square, light->range * light->range), 1e-30f));
}

// What choosing between lights goes by: the root of that. The strongest light is hidden in many places, and what others
// bring there would be noise if they were asked seldom.
GN_INLINE gn_f32 gn_importance(const GnPathLight* light, const GnPlace* place, gn_u32 strategy) {
  return gn_root(gn_open_light(light, place, strategy));
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
