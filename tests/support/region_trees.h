// Trees over the triangles that touch regions, and rays that such trees lose first when a region is larger
// than its triangles are: between points on its faces, edges and corners, or next to them. Feeds the tests of
// local trees.
#pragma once

#include <cmath>
#include <vector>

#include "gnomon/areas/grown_area.h"
#include "gnomon/areas/membership.h"
#include "gnomon/areas/shared_area.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/regions.h"
#include "support/area_shapes.h"
#include "support/wide_shapes.h"

namespace gnomon::test {

inline Box3d box_around(const std::vector<GnTriangle>& triangles) {
  Box3d box;
  for (const GnTriangle& t : triangles) {
    for (const float* corner : {t.v0, t.v1, t.v2})
      extend(box, {double{corner[0]}, double{corner[1]}, double{corner[2]}});
  }
  return box;
}

// None where no triangle touches the area, nor for balls, which are no regions.
inline std::vector<RegionTree> region_trees(const std::vector<GnTriangle>& triangles,
                                            const std::vector<InfluenceArea>& areas,
                                            const BuildOptions& options = leaves_of(1)) {
  std::vector<RegionTree> out;
  for (const InfluenceArea& area : areas) {
    if (area.kind() == AreaKind::kOmni) continue;
    std::vector<GnTriangle> own;
    const std::vector<std::uint32_t> inside = members(area, triangles);
    for (const std::uint32_t i : inside) own.push_back(triangles[i]);
    if (own.empty()) continue;
    RegionTree tree{to_region(area, box_around(triangles)), build_reference(own, options)};
    for (std::uint32_t& primitive : tree.bvh.primitives) primitive = inside[primitive];
    out.push_back(std::move(tree));
  }
  return out;
}

// Between two points next to the region's border or inside, or on beyond the second; some backwards, some
// with an end that is the second point or next to it, and with directions of any length.
inline std::vector<GnRay> rays_in(const InfluenceArea& area, std::uint32_t count, std::uint32_t seed) {
  Source source(seed);
  std::vector<GnRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d from = start_near(area, source);
    const Vec3d to = start_near(area, source);
    const double stretch = i % 5 == 0 ? std::exp2(source.between(-60.0, 60.0)) : 1.0;
    GnRay ray{};
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(from[k]);
      ray.direction[k] = static_cast<float>(stretch * (to[k] - from[k]));
    }
    const auto end = static_cast<float>(1.0 / stretch);
    if (i % 7 == 0) ray.tmin = static_cast<float>(source.between(0.0, 0.5)) * end;
    ray.tmax = i % 3 == 0 ? INFINITY : i % 3 == 1 ? end : std::nextafter(end, i % 2 == 0 ? INFINITY : 0.0F);
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace gnomon::test
