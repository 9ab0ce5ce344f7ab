#include "gnomon/areas/grown_area.h"

#include <cassert>

namespace gnomon {
namespace {

InfluenceArea grown_plane(const InfluenceArea& area, double distance) {
  const AreaFrame& f = area.frame();
  PlaneWindow window;
  window.point = f.origin - distance * f.forward;
  window.direction = f.forward;
  window.up = f.up;
  window.half_width = area.half_window()[0] + distance;
  window.half_height = area.half_window()[1] + distance;
  window.depth = 2.0 * std::get<OrientedBox>(area.region()).half[2] + 2.0 * distance;
  return InfluenceArea::plane(window);
}

InfluenceArea grown_point(const InfluenceArea& area, double distance) {
  const auto& frustum = std::get<Frustum>(area.region());
  const AreaFrame& f = area.frame();
  const double narrower = smaller(frustum.tan_x, frustum.tan_y);
  const double back = distance * std::sqrt(1.0 + narrower * narrower) / narrower;
  PointView view;
  view.eye = f.origin - back * f.forward;
  view.direction = f.forward;
  view.up = f.up;
  view.fov_x = 2.0 * area.half_window()[0];
  view.fov_y = 2.0 * area.half_window()[1];
  view.near_distance = frustum.near_distance + (back - distance);
  view.far_distance = frustum.far_distance + (back + distance);
  return InfluenceArea::point(view);
}

}  // namespace

InfluenceArea grown_by(const InfluenceArea& area, double distance) {
  assert(distance >= 0.0);
  if (distance == 0.0) return area;
  if (area.kind() == AreaKind::kPlane) return grown_plane(area, distance);
  if (area.kind() == AreaKind::kPoint) return grown_point(area, distance);
  const auto& ball = std::get<Ball>(area.region());
  return InfluenceArea::omni(ball.centre, ball.radius + distance);
}

}  // namespace gnomon
