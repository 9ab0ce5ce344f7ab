// One step of a path, for both compilers: what the surface a ray met sends along it, a light to ask, and the way on.
// Solves the rendering equation (Kajiya 1986) with light sampling and scattering weighed by the power heuristic (Veach,
// Guibas 1995) and Russian roulette. Not for tracing. Feeds path.cl and path_reference.cpp.
#ifndef GNOMON_SHARED_PATH_MATH_H
#define GNOMON_SHARED_PATH_MATH_H

#include "light_math.h"

// Where a scene's tables lie.
typedef struct GnPathTables {
  GN_GLOBAL const GnPathFrame* frame;
  GN_GLOBAL const GnTriangle* triangles;
  GN_GLOBAL const gn_u32* surface_ids;  // of each triangle
  GN_GLOBAL const GnSurface* surfaces;
  GN_GLOBAL const GnPathLight* lights;
  GN_GLOBAL const gn_f32* light_rows;
  GN_GLOBAL const GnEmitter* emitters;
  GN_GLOBAL const GnEmitterLink* links;
} GnPathTables;

// What random points are for, at each bounce.
#define GN_PURPOSE_PIXEL 0u
#define GN_PURPOSE_DIRECTION 1u
#define GN_PURPOSE_CHOICE 2u  // of a light, of gloss or matt
#define GN_PURPOSE_LIGHT 3u
#define GN_PURPOSE_ROULETTE 4u
#define GN_PURPOSES 4u  // for each bounce

// Importances of so many lights are worked out once a place, of more each time they are looked at.
#define GN_LIGHTS_HELD 32u

#define GN_SHADOW_REACH 0.9999f  // of the distance to a light: its own surface does not hide it

// A ray that nothing meets stands for none.
GN_INLINE void gn_no_ray(GnRay* ray) {
  int k;
  for (k = 0; k < 3; ++k) ray->origin[k] = ray->direction[k] = 0.0f;
  ray->direction[0] = 1.0f;
  ray->tmin = 1.0f;
  ray->tmax = -1.0f;
}

GN_INLINE void gn_draw(const GnPathTables* tables, const GnPath* path, gn_u32 bounce, gn_u32 purpose, gn_f32* point) {
  const gn_u32 seed[2] = {tables->frame->seed[0], tables->frame->seed[1]};
  gn_sample_point(seed, path->pixel, bounce * GN_PURPOSES + purpose, path->sample, point);
}

// The share of a sample of density `own` when another way would have found the same with density `other` (power
// heuristic).
GN_INLINE gn_f32 gn_weight(gn_f32 own, gn_f32 other) {
  const gn_f32 ratio = gn_min(other * gn_reciprocal(gn_max(own, 1e-30f)), 1e15f);
  return gn_reciprocal(1.0f + ratio * ratio);
}

// The pixel of a place in the walk over tiles, or GN_NONE.
GN_INLINE gn_u32 gn_pixel_of(GN_GLOBAL const GnPathFrame* frame, gn_u32 cell) {
  const gn_u32 tile = cell / 64u;
  const gn_u32 x = tile % frame->tiles_across * 8u + cell % 8u;
  const gn_u32 y = tile / frame->tiles_across * 8u + cell / 8u % 8u;
  return x < frame->width && y < frame->height ? y * frame->width + x : GN_NONE;
}

// A path that begins, and its ray from the camera.
GN_INLINE void gn_begin_path(const GnPathTables* tables, gn_u32 cell, gn_u32 sample, GnPath* path, GnRay* ray) {
  GN_GLOBAL const GnPathFrame* frame = tables->frame;
  gn_f32 point[2], x, y;
  int k;
  path->pixel = gn_pixel_of(frame, cell);
  path->sample = sample;
  path->seen = 0u;
  path->density = path->light_sum = path->cosine = 0.0f;
  for (k = 0; k < 3; ++k) {
    path->throughput[k] = 1.0f;
    path->radiance[k] = 0.0f;
  }
  gn_no_ray(ray);
  if (path->pixel == GN_NONE) return;
  gn_draw(tables, path, 0u, GN_PURPOSE_PIXEL, point);
  x = (gn_f32)(path->pixel % frame->width) + point[0];
  y = (gn_f32)(path->pixel / frame->width) + point[1];
  for (k = 0; k < 3; ++k) {
    ray->origin[k] = frame->eye[k];
    ray->direction[k] = frame->corner[k] + x * frame->right[k] + y * frame->down[k];
  }
  if (!gn_make_unit(ray->direction)) return;
  ray->tmin = 0.0f;
  ray->tmax = GN_INFINITY;
}

// How much of what a scattered ray met counts when the light it belongs to could have been drawn instead. `angle`: the
// reciprocal of the density, by solid angle, with which that light's points are drawn.
GN_INLINE gn_f32 gn_met_weight(const GnPathTables* tables, const GnRay* ray, const GnPath* path, gn_u32 bounce,
                               gn_u32 light_id, gn_f32 angle) {
  GN_GLOBAL const GnPathFrame* frame = tables->frame;
  GnPlace from;
  gn_f32 importance;
  int k;
  if (bounce == 0u || light_id == GN_NONE || frame->strategy == GN_STRATEGY_SURFACES) return 1.0f;
  if (frame->strategy == GN_STRATEGY_LIGHTS) return 0.0f;
  // Not the normal: the ray cannot have met a light that is all behind it.
  for (k = 0; k < 3; ++k) {
    from.position[k] = ray->origin[k];
    from.normal[k] = 0.0f;
  }
  importance = gn_first_lane(gn_importances(tables->light_rows + light_id, gn_light_stride(frame->light_count), &from,
                                            frame->strategy));
  if (!(angle > 0.0f) || !(path->light_sum > 0.0f)) return 1.0f;
  return gn_weight(path->density, importance * gn_reciprocal(gn_max(path->light_sum * angle, 1e-30f)));
}

GN_INLINE void gn_add_light(GnPath* path, const gn_f32* radiance, gn_f32 weight) {
  int k;
  for (k = 0; k < 3; ++k) path->radiance[k] = path->radiance[k] + path->throughput[k] * radiance[k] * weight;
}

GN_INLINE void gn_meet_sky(const GnPathTables* tables, const GnRay* ray, GnPath* path, gn_u32 bounce) {
  gn_f32 radiance[3];
  if (tables->frame->sky_light == GN_NONE) return;
  gn_sky_radiance(tables->frame, ray->direction, radiance);
  // The sky is drawn with density cosine / pi.
  gn_add_light(path, radiance,
               gn_met_weight(tables, ray, path, bounce, tables->frame->sky_light,
                             GN_PI * gn_reciprocal(gn_max(path->cosine, 1e-30f))));
}

// A direction towards a light, drawn, with the radiance that comes from there and the reciprocal of the density by
// solid angle, which of points and suns is 1 and their radiance irradiance. 0: nothing comes.
GN_INLINE int gn_aim_at(const GnPathTables* tables, gn_u32 light_id, const GnPathLight* light, const GnPlace* place,
                        const GnBasis* basis, const gn_f32* point, GnRay* ray, gn_f32* radiance, gn_f32* angle) {
  gn_f32 square = 0.0f;
  int k;
  *angle = 1.0f;
  ray->tmax = GN_INFINITY;
  for (k = 0; k < 3; ++k) radiance[k] = light->color[k];
  if (light->kind == GN_LIGHT_SUN) {
    for (k = 0; k < 3; ++k) ray->direction[k] = -light->direction[k];
  } else if (light->kind == GN_LIGHT_SKY) {
    gn_f32 inside[3];
    gn_cosine_direction(point, inside);
    if (!(inside[2] > 0.0f)) return 0;
    gn_out_of_basis(basis, inside, ray->direction);
    gn_sky_radiance(tables->frame, ray->direction, radiance);
    *angle = GN_PI * gn_reciprocal(inside[2]);
  } else if (light->kind == GN_LIGHT_POINT) {
    GnLights same;
    gn_lanes from[3];
    gn_f32 falloff;
    if (!gn_way_to(place->position, light->position, ray->direction, &square)) return 0;
    gn_lights_at(tables->light_rows + light_id, gn_light_stride(tables->frame->light_count), &same);
    for (k = 0; k < 3; ++k) from[k] = GN_ALL(-ray->direction[k]);
    falloff = gn_first_lane(gn_point_falloffs(&same, GN_ALL(square), from));
    for (k = 0; k < 3; ++k) radiance[k] = light->color[k] * falloff;
    ray->tmax = GN_SHADOW_REACH * gn_root(square);
  } else {
    const gn_f32 wanted = point[0] * light->area;
    const gn_u32 chosen = gn_emitter_at(tables->emitters, light->first, light->count, wanted);
    const gn_u32 id = tables->emitters[chosen].triangle;
    const gn_f32 before = chosen == light->first ? 0.0f : tables->emitters[chosen - 1u].running_area;
    const gn_f32 own = tables->emitters[chosen].running_area - before;
    // What is left of the first number within the chosen triangle is again even.
    const gn_f32 root = gn_root(own > 0.0f ? gn_clamped((wanted - before) * gn_reciprocal(own)) : 0.5f);
    const GnTriangle t = tables->triangles[id];
    const GnSurface surface = tables->surfaces[tables->surface_ids[id]];
    gn_f32 target[3], normal[3];
    for (k = 0; k < 3; ++k) {
      target[k] = (1.0f - root) * t.v0[k] + root * (1.0f - point[1]) * t.v1[k] + root * point[1] * t.v2[k];
      radiance[k] = surface.emission[k];
    }
    if (!gn_way_to(place->position, target, ray->direction, &square)) return 0;
    gn_triangle_normal(&t, normal);
    *angle = gn_area_per_angle(light, square, gn_dot(normal, ray->direction));
    if (!(*angle > 0.0f)) return 0;
    ray->tmax = GN_SHADOW_REACH * gn_root(square);
  }
  return gn_dot(ray->direction, place->normal) > 0.0f;
}

// Of as many lights as there are lanes, from `first` on, a multiple of that.
GN_INLINE void gn_hold_importances(const GnPathTables* tables, const GnPlace* place, gn_u32 first, gn_f32* held) {
  GN_GLOBAL const GnPathFrame* frame = tables->frame;
  gn_lanes_to(gn_importances(tables->light_rows + first, gn_light_stride(frame->light_count), place, frame->strategy),
              held + first % GN_LIGHTS_HELD);
}

// Draws a light in proportion to its importance here and a ray to it; lit: what that brings if the ray is free. Leaves
// the sum of importances in the path.
GN_INLINE void gn_ask_light(const GnPathTables* tables, const GnPlace* place, const GnBasis* basis,
                            const GnScatter* scatter, gn_f32 choice, const gn_f32* point, GnPath* path, GnRay* ray,
                            GnLit* lit) {
  GN_GLOBAL const GnPathFrame* frame = tables->frame;
  gn_f32 sum = 0.0f, running = 0.0f, importance = 0.0f, angle, density, weight;
  gn_f32 held[GN_LIGHTS_HELD], radiance[3], inside[3], reflected[3];
  GnPathLight light;
  gn_u32 i, lane;
  int k;
  gn_no_ray(ray);
  for (i = 0u; i < frame->light_count; i += GN_LANES) {
    gn_hold_importances(tables, place, i, held);
    for (lane = 0u; lane < GN_LANES; ++lane) sum = sum + held[i % GN_LIGHTS_HELD + lane];
  }
  path->light_sum = sum;
  if (!(sum > 0.0f)) return;
  // The last light that brings anything stands in where rounding leaves the choice at the very end.
  lit->light = GN_NONE;
  for (i = 0u; i < frame->light_count && !(choice * sum < running); ++i) {
    gn_f32 own;
    if (frame->light_count > GN_LIGHTS_HELD && i % GN_LANES == 0u) gn_hold_importances(tables, place, i, held);
    own = held[i % GN_LIGHTS_HELD];
    running = running + own;
    if (own > 0.0f) {
      lit->light = i;
      importance = own;
    }
  }
  if (lit->light == GN_NONE) return;
  light = tables->lights[lit->light];
  if (!gn_aim_at(tables, lit->light, &light, place, basis, point, ray, radiance, &angle)) {
    gn_no_ray(ray);
    return;
  }
  gn_into_basis(basis, ray->direction, inside);
  gn_reflected(scatter, inside, reflected, &density);
  angle = angle * sum * gn_reciprocal(importance);
  weight = light.kind >= GN_LIGHT_AREA && frame->strategy == GN_STRATEGY_BOTH
               ? gn_weight(gn_reciprocal(gn_max(angle, 1e-30f)), density)
               : 1.0f;
  for (k = 0; k < 3; ++k) {
    lit->radiance[k] = path->throughput[k] * radiance[k] * reflected[k] * (angle * weight);
    ray->origin[k] = place->position[k];
  }
  ray->tmin = 0.0f;
  if (!(gn_largest(lit->radiance) > 0.0f)) gn_no_ray(ray);
}

// Draws the way on, or none.
GN_INLINE void gn_go_on(const GnPathTables* tables, const GnPlace* place, const GnBasis* basis,
                        const GnScatter* scatter, gn_f32 choice, gn_u32 bounce, GnPath* path, GnRay* ray) {
  gn_f32 point[2], inside[3], reflected[3], factor, most;
  int k;
  gn_no_ray(ray);
  gn_draw(tables, path, bounce, GN_PURPOSE_DIRECTION, point);
  if (!gn_scatter_towards(scatter, choice, point, inside)) return;
  gn_reflected(scatter, inside, reflected, &path->density);
  if (!(path->density > 0.0f)) return;
  factor = gn_reciprocal(path->density);
  for (k = 0; k < 3; ++k) path->throughput[k] = path->throughput[k] * reflected[k] * factor;
  most = gn_largest(path->throughput);
  if (!(most > 0.0f)) return;
  if (bounce >= tables->frame->first_roulette && most < 1.0f) {
    const gn_f32 survival = gn_max(most, 0.05f);
    gn_draw(tables, path, bounce, GN_PURPOSE_ROULETTE, point);
    if (!(point[0] < survival)) return;
    factor = gn_reciprocal(survival);
    for (k = 0; k < 3; ++k) path->throughput[k] = path->throughput[k] * factor;
  }
  path->cosine = inside[2];
  gn_out_of_basis(basis, inside, ray->direction);
  for (k = 0; k < 3; ++k) ray->origin[k] = place->position[k];
  ray->tmin = 0.0f;
  ray->tmax = GN_INFINITY;
}

// What a path's ray met. next: the ray it goes on with; shadow: one that asks whether `lit` counts; both may be none.
// `bounce`: how many surfaces the path met before.
GN_INLINE void gn_path_step(const GnPathTables* tables, const GnRay* ray, const GnHit* hit, gn_u32 bounce, GnPath* path,
                            GnRay* next, GnRay* shadow, GnLit* lit) {
  gn_f32 view[3], inside[3], point[2], choice[2], emission[3];
  GnTriangle t;
  GnSurface surface;
  GnPlace place;
  GnBasis basis;
  GnScatter scatter;
  int k;
  gn_no_ray(next);
  gn_no_ray(shadow);
  if (path->pixel == GN_NONE) return;
  if (hit->primitive == GN_NONE) {
    gn_meet_sky(tables, ray, path, bounce);
    return;
  }
  path->seen = 1u;
  t = tables->triangles[hit->primitive];
  surface = tables->surfaces[tables->surface_ids[hit->primitive]];
  gn_triangle_normal(&t, place.normal);
  for (k = 0; k < 3; ++k) view[k] = -ray->direction[k];
  for (k = 0; k < 3; ++k) emission[k] = surface.emission[k];
  if (gn_largest(emission) > 0.0f) {
    const gn_u32 light_id = gn_light_of(tables->links, tables->frame->link_count, hit->primitive);
    gn_f32 angle = 0.0f;
    if (light_id != GN_NONE) {
      const GnPathLight light = tables->lights[light_id];
      angle = gn_area_per_angle(&light, hit->t * hit->t, gn_dot(place.normal, view));
    }
    gn_add_light(path, emission, gn_met_weight(tables, ray, path, bounce, light_id, angle));
  }
  // Seen from both sides alike: the normal is the one on the ray's side.
  if (gn_dot(place.normal, view) < 0.0f) {
    for (k = 0; k < 3; ++k) place.normal[k] = -place.normal[k];
  }
  if (!(gn_dot(place.normal, place.normal) > 0.5f)) {
    for (k = 0; k < 3; ++k) place.normal[k] = view[k];
  }
  for (k = 0; k < 3; ++k) {
    place.position[k] = t.v0[k] + hit->u * (t.v1[k] - t.v0[k]) + hit->v * (t.v2[k] - t.v0[k]) +
                        tables->frame->offset * place.normal[k];
  }
  gn_basis_about(place.normal, &basis);
  gn_into_basis(&basis, view, inside);
  gn_scatter_of(&surface, inside, &scatter);
  gn_draw(tables, path, bounce, GN_PURPOSE_CHOICE, choice);
  gn_draw(tables, path, bounce, GN_PURPOSE_LIGHT, point);
  gn_ask_light(tables, &place, &basis, &scatter, choice[0], point, path, shadow, lit);
  gn_go_on(tables, &place, &basis, &scatter, choice[1], bounce, path, next);
}

#endif
