// Areas that rays run through, with and without depth maps, as optimisation takes them. Feeds tests of it.
#pragma once

#include <vector>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/depth_map.h"

namespace gnomon::test {

// Along z, from a square about the origin.
inline GnMeasure window_measure(float half) {
  GnMeasure m{};
  m.kind = GN_MEASURE_WINDOW;
  m.culled = 1;
  m.right[0] = m.up[1] = m.forward[2] = 1.0F;
  m.half_width = m.half_height = half;
  m.area_scale = m.area_share = 1.0F;
  return m;
}

// From the origin through a square about z = 1.
inline GnMeasure point_measure(float half) {
  GnMeasure m = window_measure(half);
  m.kind = GN_MEASURE_SOLID_ANGLE;
  return m;
}

inline AreaCost area_with_map(const GnMeasure& measure, float near_depth, float far_depth,
                              const std::vector<GnTriangle>& triangles) {
  const auto looks = depth_rays(measure, near_depth, far_depth);
  const auto hits = trace_reference(build_reference(triangles), triangles, looks, false).hits;
  return {measure, depth_map_of(measure, near_depth, far_depth, hits)};
}

// A sun's, a lamp's and, without a map, those of a lamp that shines all ways; for triangles from 0 to 10.
inline std::vector<AreaCost> areas_around(const std::vector<GnTriangle>& triangles) {
  GnMeasure sun = window_measure(7.0F);
  sun.origin[0] = sun.origin[1] = 5.0F;
  sun.origin[2] = -3.0F;
  GnMeasure lamp = point_measure(0.8F);
  lamp.near_distance = 0.5F;
  lamp.origin[0] = lamp.origin[1] = 4.0F;
  lamp.origin[2] = -6.0F;
  GnMeasure bulb = point_measure(0.0F);
  bulb.culled = 0;
  bulb.origin[0] = bulb.origin[1] = bulb.origin[2] = 5.5F;
  std::vector<AreaCost> areas{area_with_map(sun, 0.0F, 20.0F, triangles),
                              area_with_map(lamp, 0.5F, 30.0F, triangles), AreaCost{bulb, {}}};
  areas[0].share = 3.0F;
  areas[1].share = 5.0F;
  return areas;
}

}  // namespace gnomon::test
