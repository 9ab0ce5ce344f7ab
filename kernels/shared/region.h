// Whether a ray is within a convex region whole, from its begin to where it ends or leaves the scene, in float for both
// compilers. Whoever is meets no triangle but those that touch the region, so a tree over these alone has its answer. Not
// for rays that leave a region on their way (area_math.h), nor for regions themselves (host/areas, in double).
// Feeds wide_walk.h, packet_walk.h and host/tree/regions.h.
//
// Why safe. Terms and R as in area_math.h, whose margin covers the begin. A slope n . d is off by 4u |n|_1 max|d_k| for
// rounding n, products and sums, and by 2u max|d_k| for what is taken off: GN_AREA_SLOPE times max|d_k| is 16u of it, so
// the slope used is below the true one. The way is too long by GN_REGION_LONGER, 16u, for its difference, two products
// and a hit's t, rounded; so where the slope is negative the value at the end is too small. A sum of floats has the sign of
// the true sum. Where the ray leaves the scene is as wrong as any slab's distance (ray_math.h), and moved out by as much.
#ifndef GNOMON_SHARED_REGION_H
#define GNOMON_SHARED_REGION_H

#include "area_math.h"
#include "ray_math.h"

#define GN_REGION_LONGER 1.00000095f  // 1 + 2^-20

// A region and the tree for it. planes: of up to eight half-spaces the unit normals' x side by side, inwards, then y, z,
// offsets; those behind the last hold all that there is.
typedef struct GnRegion {
  gn_f32 planes[4][8];
  gn_f32 lo[3];  // of the box around all triangles of the scene, the same in all its regions
  gn_f32 size;   // no coordinate of the region is larger in magnitude
  gn_f32 hi[3];
  gn_u32 root;  // node where its tree begins
} GnRegion;
GN_SIZE_IS(GnRegion, 160);

// Offset of a half-space that is none.
#define GN_EVERYWHERE 1e30f

// A ray as regions see it.
typedef struct GnRegionRay {
  gn_f32 point[3];  // where it begins
  gn_f32 direction[3];
  gn_f32 steeper;  // what slopes are too large by at most
  gn_f32 reach;    // R above, without the region's share
  gn_f32 length;   // t from its begin to its end, or more
} GnRegionRay;

// Of a valid ray; inverse: gn_slab_inverse of its direction's components.
GN_INLINE GnRegionRay gn_region_ray(const GnRay* ray, const gn_f32* inverse, GN_GLOBAL const GnRegion* region) {
  const gn_f32 largest = gn_largest_of(ray->direction);
  gn_f32 end = GN_INFINITY;
  GnRegionRay out;
  int k;
  for (k = 0; k < 3; ++k) {
    const gn_f32 side = inverse[k] < 0.0f ? region->lo[k] : region->hi[k];
    end = gn_min((side - ray->origin[k]) * inverse[k], end);
    out.point[k] = ray->origin[k] + ray->tmin * ray->direction[k];
    out.direction[k] = ray->direction[k];
  }
  end = gn_min(gn_slab_limit(end), ray->tmax);
  out.steeper = GN_AREA_SLOPE * largest;
  out.reach = gn_largest_of(ray->origin) + gn_abs(ray->tmin) * largest;
  out.length = (end - ray->tmin) * GN_REGION_LONGER;
  return out;
}

// False for NaN.
GN_INLINE int gn_is_within(GN_GLOBAL const GnRegion* region, const GnRegionRay* ray) {
  const gn_f32 margin = GN_AREA_MARGIN * gn_max(region->size, ray->reach);
  int i, inside = 1;
  for (i = 0; i < 8; ++i) {
    const gn_f32 x = region->planes[0][i], y = region->planes[1][i], z = region->planes[2][i];
    const gn_f32 at = x * ray->point[0] + y * ray->point[1] + z * ray->point[2] + region->planes[3][i] - margin;
    const gn_f32 slope =
        x * ray->direction[0] + y * ray->direction[1] + z * ray->direction[2] - ray->steeper;
    inside &= at >= 0.0f && at + slope * ray->length >= 0.0f;
  }
  return inside;
}

// The first region that has the ray whole, or GN_NONE.
GN_INLINE gn_u32 gn_region_of(const GnRay* ray, const gn_f32* inverse, GN_GLOBAL const GnRegion* regions, gn_u32 count) {
  gn_u32 i;
  for (i = 0u; i < count; ++i) {
    const GnRegionRay seen = gn_region_ray(ray, inverse, regions + i);
    if (gn_is_within(regions + i, &seen)) return i;
  }
  return GN_NONE;
}

#endif
