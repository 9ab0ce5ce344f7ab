#include "gnomon/measure/area_measure.h"

#include <cmath>

#include "gnomon/areas/projection.h"

namespace gnomon {
namespace {

void set_frame(GnMeasure& out, const InfluenceArea& area) {
  const AreaFrame& frame = area.frame();
  for (std::size_t k = 0; k < 3; ++k) {
    out.origin[k] = static_cast<float>(frame.origin[k]);
    out.right[k] = static_cast<float>(frame.right[k]);
    out.up[k] = static_cast<float>(frame.up[k]);
    out.forward[k] = static_cast<float>(frame.forward[k]);
  }
}

std::uint32_t kind_of(RayMeasure measure) {
  switch (measure) {
    case RayMeasure::kParallel:
      return GN_MEASURE_WINDOW;
    case RayMeasure::kSolidAngle:
      return GN_MEASURE_SOLID_ANGLE;
    case RayMeasure::kNearPlane:
      return GN_MEASURE_NEAR_PLANE;
    case RayMeasure::kYawPitch:
      return GN_MEASURE_YAW_PITCH;
  }
  return GN_MEASURE_LINEAR;
}

// In the units of the shared code, which measures near-plane areas at distance 1.
double whole_window(const InfluenceArea& area, RayMeasure measure) {
  const double whole = window_measure(area, measure);
  if (measure != RayMeasure::kNearPlane) return whole;
  const double near = std::get<Frustum>(area.region()).near_distance;
  return whole / (near * near);
}

}  // namespace

GnMeasure area_measure(const InfluenceArea& area, RayMeasure measure) {
  require_measure(area, measure);
  GnMeasure out{};
  set_frame(out, area);
  out.kind = kind_of(measure);
  out.area_scale = static_cast<float>(1.0 / whole_window(area, measure));
  out.area_share = 1.0F;
  out.breaks_ties = 1;
  if (area.kind() == AreaKind::kOmni) return out;
  out.culled = 1;
  if (const auto* frustum = std::get_if<Frustum>(&area.region())) {
    out.half_width = static_cast<float>(frustum->tan_x);
    out.half_height = static_cast<float>(frustum->tan_y);
    out.near_distance = static_cast<float>(frustum->near_distance);
    out.half_pitch = static_cast<float>(area.half_window()[1]);
  } else {
    out.half_width = static_cast<float>(area.half_window()[0]);
    out.half_height = static_cast<float>(area.half_window()[1]);
  }
  return out;
}

GnMeasure framed_surface_measure(const InfluenceArea& area) {
  GnMeasure out = surface_area_measure();
  set_frame(out, area);
  out.area_share = 0.0F;  // relative to the root
  return out;
}

}  // namespace gnomon
