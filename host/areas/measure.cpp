#include "gnomon/areas/measure.h"

#include <cmath>

#include "gnomon/areas/cone_weights.h"

namespace gnomon {

namespace {

void copy(const Vec3d& from, float* to) {
  for (std::size_t k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

GnMeasure in_frame(const AreaFrame& frame, std::uint32_t kind) {
  GnMeasure m{};
  m.kind = kind;
  copy(frame.origin, m.origin);
  copy(frame.right, m.right);
  copy(frame.up, m.up);
  copy(frame.forward, m.forward);
  m.area_scale = 1.0F;
  m.area_share = 1.0F;
  m.breaks_ties = 1;
  return m;
}

std::uint32_t kind_of(RayMeasure measure, bool culled) {
  switch (measure) {
    case RayMeasure::kParallel:
      return culled ? GN_MEASURE_WINDOW : GN_MEASURE_LINEAR;
    case RayMeasure::kSolidAngle:
      return GN_MEASURE_SOLID_ANGLE;
    case RayMeasure::kNearPlane:
      return GN_MEASURE_NEAR_PLANE;
    case RayMeasure::kYawPitch:
      break;
  }
  return GN_MEASURE_YAW_PITCH;
}

}  // namespace

GnMeasure measure_of(const InfluenceArea& area, RayMeasure measure, bool culled) {
  require_measure(area, measure);
  GnMeasure m = in_frame(area.frame(), kind_of(measure, culled));
  m.culled = culled || measure == RayMeasure::kYawPitch ? 1 : 0;
  if (m.kind == GN_MEASURE_LINEAR) {
    for (std::size_t k = 0; k < 3; ++k) m.weights[k] = std::fabs(m.forward[k]);
  }
  if (area.kind() == AreaKind::kPlane) {
    m.half_width = static_cast<float>(area.half_window()[0]);
    m.half_height = static_cast<float>(area.half_window()[1]);
  } else if (area.kind() == AreaKind::kPoint) {
    m.half_width = static_cast<float>(std::tan(area.half_window()[0]));
    m.half_height = static_cast<float>(std::tan(area.half_window()[1]));
    m.half_pitch = static_cast<float>(area.half_window()[1]);
    m.near_distance = static_cast<float>(std::get<Frustum>(area.region()).near_distance);
  } else {
    m.culled = 0;  // all directions
  }
  return m;
}

GnMeasure cone_measure(const Vec3d& direction, double half_angle) {
  GnMeasure m = in_frame(look_along({0.0, 0.0, 0.0}, direction, kWorldUp), GN_MEASURE_LINEAR);
  copy(cone_weights(direction, half_angle), m.weights);
  return m;
}

}  // namespace gnomon
