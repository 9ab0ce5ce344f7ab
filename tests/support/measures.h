// Measures of every kind over the cube of side 10 that test scenes fill. Made by hand, with no room's help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gnomon/tree/build_options.h"

namespace gnomon::test {

// The frame of an area looking along (0.6, 0, 0.8) from `origin`.
inline GnMeasure framed(std::uint32_t kind, std::array<float, 3> origin, float half_width,
                        float half_height) {
  GnMeasure m{};
  m.kind = kind;
  const float frame[3][3] = {{0.8F, 0.0F, -0.6F}, {0.0F, 1.0F, 0.0F}, {0.6F, 0.0F, 0.8F}};
  for (std::size_t k = 0; k < 3; ++k) {
    m.origin[k] = origin[k];
    m.right[k] = frame[0][k];
    m.up[k] = frame[1][k];
    m.forward[k] = frame[2][k];
  }
  m.half_width = half_width;
  m.half_height = half_height;
  m.area_scale = 1.0F;
  m.area_share = 1.0F;
  m.breaks_ties = 1;
  return m;
}

inline std::vector<std::pair<std::string, GnMeasure>> every_measure() {
  std::vector<std::pair<std::string, GnMeasure>> out;
  out.emplace_back("surface area", surface_area_measure());
  GnMeasure plane = framed(GN_MEASURE_LINEAR, {0, 0, 0}, 0, 0);
  plane.weights[0] = 0.6F;
  plane.weights[2] = 0.8F;
  out.emplace_back("parallel rays", plane);
  GnMeasure window = framed(GN_MEASURE_WINDOW, {2, 5, -1}, 4, 3);
  window.culled = 1;
  out.emplace_back("window", window);
  GnMeasure far_point = framed(GN_MEASURE_SOLID_ANGLE, {-60, 5, -80}, 0, 0);
  out.emplace_back("far point", far_point);
  out.emplace_back("lamp", framed(GN_MEASURE_SOLID_ANGLE, {5, 4, 6}, 0, 0));
  for (const std::uint32_t kind : {GN_MEASURE_SOLID_ANGLE, GN_MEASURE_NEAR_PLANE, GN_MEASURE_YAW_PITCH}) {
    GnMeasure near_point = framed(kind, {2, 4, 1}, 0.5F, 0.4F);  // inside the scene
    near_point.culled = 1;
    near_point.near_distance = 0.5F;
    near_point.half_pitch = 0.38F;
    out.emplace_back("point measure " + std::to_string(kind), near_point);
    near_point.area_share = 0.75F;
    out.emplace_back("mixed point measure " + std::to_string(kind), near_point);
  }
  GnMeasure thick = framed(GN_MEASURE_CUSTOM, {0, 0, 0}, 0.3F, 0);
  out.emplace_back("custom: thick rays", thick);
  plane.area_share = 0.5F;
  out.emplace_back("mixed parallel rays", plane);
  return out;
}

}  // namespace gnomon::test
