// Regions that rays are tested against, eight planes at a time: shared/region.h with vectors, and for packets sixteen
// rays at a time. A ray by itself has the answer that the plain code has. Feeds wide_walk.h and packet_walk.h.
#ifndef GNOMON_WITHIN_H
#define GNOMON_WITHIN_H

#include "shared/region.h"
#include "eight.h"

static inline uint is_within(__global const GnRegion* region, const GnRegionRay* ray) {
  const float8 x = vload8(0, region->planes[0]), y = vload8(0, region->planes[1]), z = vload8(0, region->planes[2]);
  const float margin = GN_AREA_MARGIN * gn_max(region->size, ray->reach);
  const float8 at = x * ray->point[0] + y * ray->point[1] + z * ray->point[2] + vload8(0, region->planes[3]) - margin;
  const float8 slope = x * ray->direction[0] + y * ray->direction[1] + z * ray->direction[2] - ray->steeper;
  const float8 none = (float8)(0.0f);
  return (lanes_not_above(none, at) & lanes_not_above(none, at + slope * ray->length)) == 255u;
}

// Where a ray begins: at the root of the first region's tree that has it whole, or at that of the tree of all.
static inline uint root_of(const GnRay* ray, const float* inverse, __global const GnRegion* regions, uint count) {
  const GnRegionRay seen = gn_region_ray(ray, inverse, regions);  // they are all of one scene
  uint i;
  for (i = 0u; i < count; ++i) {
    if (is_within(regions + i, &seen)) return regions[i].root;
  }
  return 0u;
}

#endif
