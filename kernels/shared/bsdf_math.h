// How surfaces scatter light, for both compilers: Lambert's law and GGX microfacets as glTF's metallic-roughness
// materials mix them, in a frame whose z axis is the normal. Lit from one side only; no transmission. Additions,
// multiplications and what elementary_math.h makes of them, so the same bits on every device. Sources: glTF 2.0,
// appendix B; Heitz 2014 (height-correlated masking), Heitz 2018 (sampling visible normals); Duff and others 2017
// (frames).
#ifndef GNOMON_SHARED_BSDF_MATH_H
#define GNOMON_SHARED_BSDF_MATH_H

#include "path_layout.h"
#include "sample_math.h"

#define GN_PI 3.1415927f
#define GN_ONE_OVER_PI 0.31830989f
#define GN_SMOOTHEST 1e-3f  // alpha of a mirror: sharper ones would be light sources of their own to float

GN_INLINE void gn_cross(const gn_f32* a, const gn_f32* b, gn_f32* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

GN_INLINE gn_f32 gn_largest(const gn_f32* v) { return gn_max(gn_abs(v[0]), gn_max(gn_abs(v[1]), gn_abs(v[2]))); }

// Makes a vector of any finite length unit; 0 for one that is zero, or as good as.
GN_INLINE int gn_make_unit(gn_f32* v) {
  const gn_f32 scale = gn_power_near_reciprocal(gn_largest(v));
  gn_f32 square, factor;
  int k;
  for (k = 0; k < 3; ++k) v[k] = v[k] * scale;
  square = gn_dot(v, v);
  if (!(square > 1e-30f)) return 0;
  factor = gn_reciprocal_root(square);
  for (k = 0; k < 3; ++k) v[k] = v[k] * factor;
  return 1;
}

GN_INLINE gn_f32 gn_luminance(const gn_f32* color) {
  return 0.2126f * color[0] + 0.7152f * color[1] + 0.0722f * color[2];
}

// Right-handed and orthonormal, z the normal.
typedef struct GnBasis {
  gn_f32 x[3];
  gn_f32 y[3];
  gn_f32 z[3];
} GnBasis;

GN_INLINE void gn_basis_about(const gn_f32* normal, GnBasis* basis) {
  const gn_f32 sign = normal[2] < 0.0f ? -1.0f : 1.0f;
  const gn_f32 a = -sign * gn_reciprocal(1.0f + gn_abs(normal[2]));
  const gn_f32 b = normal[0] * normal[1] * a;
  int k;
  basis->x[0] = 1.0f + sign * normal[0] * normal[0] * a;
  basis->x[1] = sign * b;
  basis->x[2] = -sign * normal[0];
  basis->y[0] = b;
  basis->y[1] = sign + normal[1] * normal[1] * a;
  basis->y[2] = -normal[1];
  for (k = 0; k < 3; ++k) basis->z[k] = normal[k];
}

GN_INLINE void gn_into_basis(const GnBasis* basis, const gn_f32* v, gn_f32* inside) {
  inside[0] = gn_dot(basis->x, v);
  inside[1] = gn_dot(basis->y, v);
  inside[2] = gn_dot(basis->z, v);
}

GN_INLINE void gn_out_of_basis(const GnBasis* basis, const gn_f32* inside, gn_f32* v) {
  int k;
  for (k = 0; k < 3; ++k) v[k] = inside[0] * basis->x[k] + inside[1] * basis->y[k] + inside[2] * basis->z[k];
}

// Cosine-weighted about z (Malley): a point of the disc, raised. Density cosine / pi.
GN_INLINE void gn_cosine_direction(const gn_f32* point, gn_f32* inside) {
  const gn_f32 radius = gn_root(point[0]);
  gn_f32 turned[2];
  gn_cos_sin(point[1], turned);
  inside[0] = radius * turned[0];
  inside[1] = radius * turned[1];
  inside[2] = gn_root(1.0f - point[0]);
}

// A surface as seen along `view`, which points away from it: unit, in its frame, view[2] > 0. A surface that is no
// metal and entirely rough is matt: Lambert's law alone.
typedef struct GnScatter {
  gn_f32 view[3];
  gn_f32 diffuse[3];  // reflectance without the share that the gloss takes
  gn_f32 mirror[3];   // reflectance head on
  gn_f32 alpha;
  gn_f32 view_root;   // sqrt(alpha^2 + (1 - alpha^2) view_z^2)
  gn_f32 gloss;       // how often a direction is drawn from the gloss; 0: matt
} GnScatter;

// Schlick's: how much of 1 - mirror is reflected on top, at this cosine.
GN_INLINE gn_f32 gn_schlick(gn_f32 cosine) {
  const gn_f32 away = gn_max(0.0f, 1.0f - cosine);
  const gn_f32 square = away * away;
  return square * square * away;
}

GN_INLINE gn_f32 gn_slope_root(gn_f32 alpha, gn_f32 cosine) {
  return gn_root(alpha * alpha + (1.0f - alpha * alpha) * cosine * cosine);
}

GN_INLINE void gn_scatter_of(const GnSurface* surface, const gn_f32* view, GnScatter* scatter) {
  gn_f32 mirror, diffuse, seen;
  int k;
  for (k = 0; k < 3; ++k) {
    scatter->view[k] = view[k];
    scatter->diffuse[k] = surface->base_color[k] * (1.0f - surface->metallic);
    scatter->mirror[k] = 0.04f + (surface->base_color[k] - 0.04f) * surface->metallic;
  }
  scatter->view[2] = gn_max(1e-4f, view[2]);
  scatter->alpha = gn_max(GN_SMOOTHEST, surface->roughness * surface->roughness);
  scatter->view_root = gn_slope_root(scatter->alpha, scatter->view[2]);
  scatter->gloss = 0.0f;
  if (surface->roughness >= 1.0f && surface->metallic <= 0.0f) return;
  seen = gn_schlick(scatter->view[2]);
  mirror = gn_luminance(scatter->mirror);
  mirror = mirror + (1.0f - mirror) * seen + 0.01f;  // never quite 0
  diffuse = gn_luminance(scatter->diffuse) * (1.0f - mirror);
  scatter->gloss = diffuse > 0.0f ? mirror * gn_reciprocal(mirror + diffuse) : 1.0f;
}

// What is reflected from `light` (unit, in the frame) to the view, times the light's cosine; and the density by solid
// angle with which gn_scatter_towards draws that direction. Zeros below the surface.
GN_INLINE void gn_reflected(const GnScatter* scatter, const gn_f32* light, gn_f32* reflected, gn_f32* density) {
  const gn_f32 cosine = light[2];
  int k;
  *density = 0.0f;
  for (k = 0; k < 3; ++k) reflected[k] = 0.0f;
  if (!(cosine > 0.0f)) return;
  *density = GN_ONE_OVER_PI * cosine;
  for (k = 0; k < 3; ++k) reflected[k] = scatter->diffuse[k] * *density;
  if (scatter->gloss > 0.0f) {
    const gn_f32 alpha = scatter->alpha, view_z = scatter->view[2];
    const gn_f32 light_root = gn_slope_root(alpha, cosine);
    gn_f32 half_way[3], along, flat, bell, share, added;
    for (k = 0; k < 3; ++k) half_way[k] = scatter->view[k] + light[k];
    if (!gn_make_unit(half_way)) return;
    along = gn_dot(half_way, scatter->view);
    // Not 1 - z^2, of which nothing is left near the normal.
    flat = half_way[0] * half_way[0] + half_way[1] * half_way[1] + alpha * alpha * half_way[2] * half_way[2];
    bell = GN_ONE_OVER_PI * alpha * alpha * gn_reciprocal(flat * flat);
    share = 0.5f * bell * cosine * gn_reciprocal(view_z * light_root + cosine * scatter->view_root);
    added = gn_schlick(along);
    for (k = 0; k < 3; ++k) {
      const gn_f32 mirrored = scatter->mirror[k] + (1.0f - scatter->mirror[k]) * added;
      reflected[k] = reflected[k] * (1.0f - mirrored) + mirrored * share;
    }
    *density = (1.0f - scatter->gloss) * *density +
               scatter->gloss * 0.5f * bell * gn_reciprocal(view_z + scatter->view_root);
  }
}

// Draws a direction; 0: none, the light is lost in the surface.
GN_INLINE int gn_scatter_towards(const GnScatter* scatter, gn_f32 choice, const gn_f32* point, gn_f32* light) {
  gn_f32 stretched[3], across[3], up[3], facet[3], turned[2];
  gn_f32 radius, a, b, lean, along;
  int k;
  if (!(choice < scatter->gloss)) {
    gn_cosine_direction(point, light);
    return light[2] > 0.0f;
  }
  stretched[0] = scatter->alpha * scatter->view[0];
  stretched[1] = scatter->alpha * scatter->view[1];
  stretched[2] = scatter->view[2];
  gn_make_unit(stretched);
  across[0] = -stretched[1];
  across[1] = stretched[0];
  across[2] = 0.0f;
  if (!gn_make_unit(across)) across[0] = 1.0f;
  gn_cross(stretched, across, up);
  radius = gn_root(point[0]);
  gn_cos_sin(point[1], turned);
  a = radius * turned[0];
  lean = 0.5f * (1.0f + stretched[2]);
  b = (1.0f - lean) * gn_root(gn_max(0.0f, 1.0f - a * a)) + lean * radius * turned[1];
  {
    const gn_f32 rest = gn_root(gn_max(0.0f, 1.0f - a * a - b * b));
    for (k = 0; k < 3; ++k) facet[k] = a * across[k] + b * up[k] + rest * stretched[k];
  }
  facet[0] = scatter->alpha * facet[0];
  facet[1] = scatter->alpha * facet[1];
  facet[2] = gn_max(0.0f, facet[2]);
  if (!gn_make_unit(facet)) return 0;
  along = 2.0f * gn_dot(facet, scatter->view);
  for (k = 0; k < 3; ++k) light[k] = along * facet[k] - scatter->view[k];
  return light[2] > 0.0f;
}

#endif
