#include "gnomon/measure/area_measure.h"

#include <algorithm>

#include "gnomon/areas/measure.h"
#include "gnomon/areas/projection.h"
#include "gnomon/tree/build_options.h"

namespace gnomon {
namespace {

// In the units of the shared code, which measures near-plane areas at distance 1.
double whole_window(const InfluenceArea& area, RayMeasure measure) {
  const double whole = window_measure(area, measure);
  if (measure != RayMeasure::kNearPlane) return whole;
  const double near = std::get<Frustum>(area.region()).near_distance;
  return whole / (near * near);
}

}  // namespace

GnMeasure area_measure(const InfluenceArea& area, RayMeasure measure) {
  GnMeasure out = measure_of(area, measure, true);
  out.area_scale = static_cast<float>(1.0 / whole_window(area, measure));
  return out;
}

GnMeasure framed_surface_measure(const InfluenceArea& area) {
  const bool plane = area.kind() == AreaKind::kPlane;
  GnMeasure out = measure_of(area, plane ? RayMeasure::kParallel : RayMeasure::kSolidAngle, false);
  const GnMeasure surface = surface_area_measure();
  out.kind = surface.kind;
  std::copy_n(surface.weights, 3, out.weights);
  out.breaks_ties = surface.breaks_ties;
  out.area_share = 0.0F;  // relative to the root
  return out;
}

}  // namespace gnomon
