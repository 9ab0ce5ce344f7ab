// Influence areas and rays that start in or near them, for tests of the float arithmetic and of the top
// level: seeded, with starts on faces, at rounding distance of them and far along the ray.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "areas/area_test_tools.h"
#include "gnomon/areas/influence_area.h"
#include "support/shapes.h"

namespace gnomon::test {

// Every shape of area_test_tools.h and two balls, moved by `offset` and scaled.
inline std::vector<std::pair<std::string, InfluenceArea>> areas_of_every_kind(const Vec3d& offset = {0, 0, 0},
                                                                              double scale = 1.0) {
  std::vector<std::pair<std::string, InfluenceArea>> areas;
  for (auto [name, view] : point_views()) {
    view.eye = offset + scale * view.eye;
    view.near_distance *= scale;
    view.far_distance *= scale;
    areas.emplace_back("point, " + name, InfluenceArea::point(view));
  }
  for (auto [name, window] : plane_windows()) {
    window.point = offset + scale * window.point;
    window.half_width *= scale;
    window.half_height *= scale;
    window.depth *= scale;
    areas.emplace_back("plane, " + name, InfluenceArea::plane(window));
  }
  areas.emplace_back("ball", InfluenceArea::omni(offset + scale * Vec3d{0.5, -1.0, 2.0}, 1.5 * scale));
  areas.emplace_back("large ball", InfluenceArea::omni(offset + scale * Vec3d{-3.0, 1.0, 0.0}, 9.0 * scale));
  return areas;
}

// The region's point at u in [-1, 1]^3: a cube for boxes and frusta, for balls a direction and a share.
inline Vec3d place_in(const InfluenceArea& area, const Vec3d& u) {
  if (const auto* box = std::get_if<OrientedBox>(&area.region())) {
    Vec3d p = box->centre;
    for (std::size_t k = 0; k < 3; ++k) p = p + u[k] * box->half[k] * box->axes[k];
    return p;
  }
  if (const auto* f = std::get_if<Frustum>(&area.region())) {
    const double z = f->near_distance + 0.5 * (1.0 + u[2]) * (f->far_distance - f->near_distance);
    return to_world(f->frame, {u[0] * f->tan_x * z, u[1] * f->tan_y * z, z});
  }
  const auto& ball = std::get<Ball>(area.region());
  const double length_of_u = length(u);
  if (!(length_of_u > 0.0)) return ball.centre;
  return ball.centre + ball.radius * magnitude(u) / length_of_u * u;
}

// Inside, or (one in two) on a face, edge or corner, then moved by 2^-32 to 2^-12 of the region's size.
inline Vec3d start_near(const InfluenceArea& area, Source& source) {
  Vec3d u = source.point(-1.0, 1.0);
  if (source.between(0.0, 1.0) < 0.5) return place_in(area, u);
  for (double& x : u) x = source.between(0.0, 1.0) < 0.6 ? (x > 0.0 ? 1.0 : -1.0) : x;
  const Box3d box = area.enclosing_box();
  const double size = larger(magnitude(box.lo), magnitude(box.hi));
  return place_in(area, u) + size * std::exp2(source.between(-32.0, -12.0)) * source.direction();
}

// Any direction, or (one in two) one along the area's axes or its own rays, turned by a little.
inline Vec3d direction_for(const InfluenceArea& area, const Vec3d& start, Source& source) {
  const double choice = source.between(0.0, 8.0);
  if (choice < 4.0) return source.direction();
  const AreaFrame& f = area.frame();
  const Vec3d along = choice < 5.0 ? f.right : choice < 6.0 ? f.up : area.direction_at(start);
  const Vec3d sense = source.between(0.0, 1.0) < 0.3 ? -along : along;
  return sense + std::exp2(source.between(-40.0, -3.0)) * source.direction();
}

// A ray whose start at tmin is `start` but for rounding. `back`: how far behind it the origin lies.
inline GnRay ray_through(const Vec3d& start, const Vec3d& direction, double back) {
  GnRay r{};
  for (std::size_t k = 0; k < 3; ++k) {
    r.direction[k] = static_cast<float>(direction[k]);
    r.origin[k] = static_cast<float>(start[k] - back * static_cast<double>(r.direction[k]));
  }
  r.tmin = static_cast<float>(back);
  r.tmax = std::numeric_limits<float>::infinity();
  return r;
}

// For an area: starts near its faces, directions of all kinds and lengths, one ray in four with its tmin far
// off.
inline GnRay ray_near(const InfluenceArea& area, Source& source) {
  const Vec3d start = start_near(area, source);
  const double back = source.between(0.0, 4.0) < 1.0 ? std::exp2(source.between(-6.0, 12.0)) : 0.0;
  // Half of the directions are shorter or longer than 1.
  const double stretch =
      std::exp2(larger(source.between(-6.0, 6.0), 0.0) - larger(source.between(-6.0, 6.0), 0.0));
  return ray_through(start, stretch * direction_for(area, start, source), back);
}

inline Vec3d point_at(const GnRay& r, double t) {
  const Ray3d exact = to_ray3d(r);
  return exact.origin + t * exact.direction;
}

}  // namespace gnomon::test
