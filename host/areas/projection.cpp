#include "gnomon/areas/projection.h"

#include <numbers>
#include <string>

#include "gnomon/areas/cone_weights.h"
#include "gnomon/areas/solid_angle.h"
#include "gnomon/areas/visible_surface.h"
#include "gnomon/areas/yaw_pitch.h"
#include "gnomon/base/error.h"

namespace gnomon {
namespace {

const Frustum& frustum_of(const InfluenceArea& area) {
  return std::get<Frustum>(area.region());
}

[[noreturn]] void refuse(const std::string& what, RayMeasure measure) {
  throw Error(ErrorCode::kInvalidArgument, what + " is not defined for " + std::string(to_string(measure)));
}

// The corners of the box's part with local z >= least, in local coordinates and no order: its own, and where
// its edges cross.
std::vector<Vec3d> corners_beyond(const AreaFrame& frame, const Box3d& box, double least) {
  std::vector<Vec3d> kept;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3d p = to_local(frame, corner_of(box, i));
    if (p[2] >= least) kept.push_back(p);
    for (unsigned bit = 1; bit < 8; bit *= 2) {
      if ((i & bit) != 0) continue;
      const Vec3d q = to_local(frame, corner_of(box, i | bit));
      if ((p[2] < least) == (q[2] < least)) continue;
      kept.push_back(p + (least - p[2]) / (q[2] - p[2]) * (q - p));
    }
  }
  return kept;
}

// The six corners left after the nearest and the farthest, in ring order: each differs from the next on one
// axis.
Polygon2d parallel_silhouette(const AreaFrame& frame, const Box3d& box) {
  unsigned nearest = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (frame.forward[axis] < 0.0) nearest |= 1U << axis;
  }
  Polygon2d hull;
  for (const unsigned ring : {1U, 3U, 2U, 6U, 4U, 5U}) {
    const Vec3d p = to_local(frame, corner_of(box, nearest ^ ring));
    hull.push_back({p[0], p[1]});
  }
  return hull;
}

// Rays start in the window, so what lies behind it is cut off first.
Polygon2d parallel_culled(const InfluenceArea& area, const Box3d& box) {
  Polygon2d beyond;
  for (const Vec3d& p : corners_beyond(area.frame(), box, 0.0)) beyond.push_back({p[0], p[1]});
  const auto [w, h] = area.half_window();
  const Polygon2d window{{-w, -h}, {w, -h}, {w, h}, {-w, h}};
  return intersection_of(convex_hull_of(beyond), window);
}

Polygon2d on_near_plane(const Frustum& frustum, const std::vector<Vec3d>& points) {
  Polygon2d projected;
  for (const Vec3d& p : points) {
    if (!(p[2] > 0.0)) continue;  // only the eye itself, as a piece's corner
    const double scale = frustum.near_distance / p[2];
    projected.push_back({scale * p[0], scale * p[1]});
  }
  return convex_hull_of(projected);
}

std::vector<Polygon3d> pieces_of(const InfluenceArea& area, const Box3d& box, RayStart start) {
  const Frustum& frustum = frustum_of(area);
  return visible_surface(frustum, box, start, {frustum.tan_x, frustum.tan_y});
}

double solid_angle_culled(const InfluenceArea& area, const Box3d& box, RayStart start) {
  if (area.kind() == AreaKind::kOmni) return solid_angle_of(area.frame().origin, box);
  double sum = 0.0;
  for (const Polygon3d& piece : pieces_of(area, box, start)) sum += solid_angle_of({0.0, 0.0, 0.0}, piece);
  return sum;
}

double yaw_pitch_culled(const InfluenceArea& area, const Box3d& box, RayStart start) {
  const Frustum& frustum = frustum_of(area);
  const auto [half_yaw, half_pitch] = area.half_window();
  // The flat-sided window around the one in yaw and pitch: at yaw y the cone is at y/z = tan(half_pitch) /
  // cos(y). Without this cut edges could touch the zenith, which has no yaw.
  const double slope_y = frustum.tan_y * std::sqrt(1.0 + frustum.tan_x * frustum.tan_x);
  double sum = 0.0;
  for (const Polygon3d& piece : visible_surface(frustum, box, start, {frustum.tan_x, slope_y}))
    sum += yaw_pitch_area_of(piece, half_pitch);
  return sum;
}

}  // namespace

std::string_view to_string(RayMeasure measure) {
  switch (measure) {
    case RayMeasure::kParallel:
      return "parallel rays";
    case RayMeasure::kSolidAngle:
      return "rays uniform in solid angle";
    case RayMeasure::kNearPlane:
      return "rays uniform over the near plane";
    case RayMeasure::kYawPitch:
      return "rays uniform in yaw and pitch";
  }
  return "unknown rays";
}

void require_measure(const InfluenceArea& area, RayMeasure measure) {
  const AreaKind kind = area.kind();
  const bool fits = measure == RayMeasure::kParallel     ? kind == AreaKind::kPlane
                    : measure == RayMeasure::kSolidAngle ? kind != AreaKind::kPlane
                                                         : kind == AreaKind::kPoint;
  if (fits) return;
  const std::string name = kind == AreaKind::kPlane ? "plane" : kind == AreaKind::kPoint ? "point" : "omni";
  throw Error(ErrorCode::kInvalidArgument, name + " areas have no " + std::string(to_string(measure)));
}

double window_measure(const InfluenceArea& area, RayMeasure measure) {
  require_measure(area, measure);
  if (area.kind() == AreaKind::kOmni) return 4.0 * std::numbers::pi;
  const auto [x, y] = area.half_window();
  if (measure == RayMeasure::kParallel || measure == RayMeasure::kYawPitch) return 4.0 * x * y;
  if (measure == RayMeasure::kSolidAngle) return 4.0 * std::asin(std::sin(x) * std::sin(y));
  const Frustum& frustum = frustum_of(area);
  return 4.0 * frustum.near_distance * frustum.tan_x * frustum.near_distance * frustum.tan_y;
}

double culled_measure(const InfluenceArea& area, const Box3d& box, RayMeasure measure, RayStart start) {
  require_measure(area, measure);
  if (is_empty(box)) return 0.0;
  if (measure == RayMeasure::kSolidAngle) return solid_angle_culled(area, box, start);
  if (measure == RayMeasure::kYawPitch) return yaw_pitch_culled(area, box, start);
  return area_of(culled_hull(area, box, measure, start));
}

double projected_measure(const InfluenceArea& area, const Box3d& box, RayMeasure measure) {
  require_measure(area, measure);
  if (is_empty(box)) return 0.0;
  if (measure == RayMeasure::kSolidAngle) return solid_angle_of(area.frame().origin, box);
  if (measure == RayMeasure::kYawPitch) refuse("a measure without a window", measure);
  if (measure == RayMeasure::kParallel) return weighted_measure(cone_weights(area.frame().forward, 0.0), box);
  return area_of(projected_hull(area, box, measure));
}

Polygon2d culled_hull(const InfluenceArea& area, const Box3d& box, RayMeasure measure, RayStart start) {
  require_measure(area, measure);
  if (measure == RayMeasure::kSolidAngle || measure == RayMeasure::kYawPitch) refuse("a hull", measure);
  if (is_empty(box)) return {};
  if (measure == RayMeasure::kParallel) return parallel_culled(area, box);
  std::vector<Vec3d> corners;
  for (const Polygon3d& piece : pieces_of(area, box, start))
    corners.insert(corners.end(), piece.begin(), piece.end());
  return on_near_plane(frustum_of(area), corners);
}

Polygon2d projected_hull(const InfluenceArea& area, const Box3d& box, RayMeasure measure) {
  require_measure(area, measure);
  if (measure == RayMeasure::kSolidAngle || measure == RayMeasure::kYawPitch) refuse("a hull", measure);
  if (is_empty(box)) return {};
  if (measure == RayMeasure::kParallel) return parallel_silhouette(area.frame(), box);
  const Frustum& frustum = frustum_of(area);
  return on_near_plane(frustum, corners_beyond(frustum.frame, box, frustum.near_distance));
}

}  // namespace gnomon
