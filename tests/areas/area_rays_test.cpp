// Seeded rays of areas.
#include "gnomon/areas/area_rays.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <tuple>

#include "area_test_tools.h"
#include "gnomon/areas/solid_angle.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr RayMeasure kPointMeasures[] = {RayMeasure::kSolidAngle, RayMeasure::kNearPlane,
                                         RayMeasure::kYawPitch};

Vec3d local_direction(const InfluenceArea& area, const GnRay& ray) {
  AreaFrame turned = area.frame();
  turned.origin = {0, 0, 0};
  return to_local(turned, to_ray3d(ray).direction);
}

// Turns v about a unit axis (Rodrigues).
Vec3d turned(const Vec3d& axis, double angle, const Vec3d& v) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         (1.0 - std::cos(angle)) * dot(axis, v) * axis;
}

// Each of the 8 x 8 equal cells of [-1, 1]^2 gets its share.
void require_even(const std::vector<Vec2d>& points) {
  std::array<std::uint64_t, 64> cells{};
  for (const Vec2d& p : points) {
    CAPTURE(p);
    REQUIRE((std::abs(p[0]) <= 1.0 + 1e-4 && std::abs(p[1]) <= 1.0 + 1e-4));
    const auto cell = [](double x) {
      return static_cast<std::size_t>(std::min(7.0, std::max(0.0, 4.0 * (x + 1.0))));
    };
    ++cells[8 * cell(p[0]) + cell(p[1])];
  }
  for (const std::uint64_t count : cells) require_share(count, points.size(), 1.0 / 64.0);
}

}  // namespace

TEST_CASE("the same seed gives the same rays, another gives others, and a longer batch begins alike") {
  const InfluenceArea area = InfluenceArea::point(PointView{});
  for (const RayMeasure measure : kPointMeasures) {
    const auto rays = area_rays(area, measure, 100, 7);
    const auto longer = area_rays(area, measure, 150, 7);
    CAPTURE(to_string(measure));
    REQUIRE(rays.size() == 100);
    REQUIRE(std::memcmp(rays.data(), longer.data(), 100 * sizeof(GnRay)) == 0);
    REQUIRE(std::memcmp(rays.data(), area_rays(area, measure, 100, 8).data(), 100 * sizeof(GnRay)) != 0);
    REQUIRE(area_rays(area, measure, 0, 7).empty());
  }
}

TEST_CASE("rays from the window start in the region, at its near end, as floats") {
  std::vector<std::pair<InfluenceArea, RayMeasure>> cases;
  for (const Vec3d& offset : {Vec3d{0, 0, 0}, Vec3d{1e3, -2e3, 500}}) {
    for (auto [name, window] : plane_windows()) {
      window.point = window.point + offset;
      cases.emplace_back(InfluenceArea::plane(window), RayMeasure::kParallel);
    }
    for (auto [name, view] : point_views()) {
      view.eye = view.eye + offset;
      cases.emplace_back(InfluenceArea::point(view), RayMeasure::kSolidAngle);
      cases.emplace_back(InfluenceArea::point(view), RayMeasure::kNearPlane);
    }
  }
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto& [area, measure] = cases[c];
    for (const GnRay& ray : area_rays(area, measure, 500, 91)) {
      const Ray3d r = to_ray3d(ray);
      CAPTURE(c, to_string(measure), r.origin, r.direction, area.frame().origin, area.frame().forward);
      REQUIRE(area.contains(r.origin));
      REQUIRE(length(r.direction) == Approx(1.0).epsilon(1e-6));
      REQUIRE((ray.tmin == 0.0F && std::isinf(ray.tmax)));
      const double z = to_local(area.frame(), r.origin)[2];
      const auto* frustum = std::get_if<Frustum>(&area.region());
      const double near = frustum != nullptr ? frustum->near_distance : 0.0;
      REQUIRE(z - near < 1e-6 * 5e3);
      if (frustum == nullptr) REQUIRE(area.is_affine(r, 1e-10));
    }
  }
}

TEST_CASE("rays end where the region does, if asked to") {
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    for (const RayMeasure measure : kPointMeasures) {
      for (const RayStart start : {RayStart::kWindow, RayStart::kEye}) {
        for (const GnRay& ray : area_rays(area, measure, 50, 92, {start, true})) {
          const Ray3d r = to_ray3d(ray);
          const double t = static_cast<double>(ray.tmax);
          CAPTURE(name, to_string(measure), r.origin, r.direction, t);
          const double error = 1e-6 * (t + 10.0);
          REQUIRE(to_local(area.frame(), r.origin + t * r.direction)[2] ==
                  Approx(view.far_distance).margin(error));
          if (start == RayStart::kEye) REQUIRE(length(r.origin - view.eye) < 1e-6);
        }
      }
    }
  }
  const InfluenceArea plane = InfluenceArea::plane(PlaneWindow{});
  for (const GnRay& ray : area_rays(plane, RayMeasure::kParallel, 50, 93, {RayStart::kWindow, true}))
    REQUIRE(ray.origin[2] + ray.tmax == Approx(1.0).epsilon(1e-6));
  const InfluenceArea omni = InfluenceArea::omni({1, 2, 3}, 4.0);
  for (const GnRay& ray : area_rays(omni, RayMeasure::kSolidAngle, 50, 94, {RayStart::kWindow, true})) {
    REQUIRE(ray.tmax == 4.0F);
    REQUIRE(to_ray3d(ray).origin == Vec3d{1, 2, 3});
  }
}

TEST_CASE("parallel and near-plane rays are even over the window") {
  PlaneWindow window;
  window.direction = {1, 2, -2};
  window.half_width = 3.0;
  window.half_height = 0.5;
  const InfluenceArea plane = InfluenceArea::plane(window);
  std::vector<Vec2d> points;
  for (const GnRay& ray : area_rays(plane, RayMeasure::kParallel, 40000, 95)) {
    const Vec3d p = to_local(plane.frame(), to_ray3d(ray).origin);
    points.push_back({p[0] / 3.0, p[1] / 0.5});
  }
  require_even(points);
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    const Frustum& f = std::get<Frustum>(area.region());
    CAPTURE(name);
    points.clear();
    for (const GnRay& ray : area_rays(area, RayMeasure::kNearPlane, 40000, 96)) {
      const Vec3d p = to_local(f.frame, to_ray3d(ray).origin);
      points.push_back({p[0] / (p[2] * f.tan_x), p[1] / (p[2] * f.tan_y)});
    }
    require_even(points);
  }
}

TEST_CASE("yaw and pitch are even, and the direction is Rot_up(yaw) Rot_right(pitch) forward") {
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    const AreaFrame& f = area.frame();
    std::vector<Vec2d> points;
    for (const GnRay& ray : area_rays(area, RayMeasure::kYawPitch, 40000, 97, {RayStart::kEye, false})) {
      const Vec3d d = local_direction(area, ray);
      const double yaw = std::atan2(d[0], d[2]);
      const double pitch = std::asin(std::max(-1.0, std::min(1.0, d[1])));
      // Turning about right by a positive angle looks down.
      const Vec3d expected = turned(f.up, yaw, turned(f.right, -pitch, f.forward));
      CAPTURE(name, yaw, pitch);
      // Near the zenith float directions leave yaw loose.
      REQUIRE(length(to_ray3d(ray).direction - expected) < 1e-5);
      if (view.fov_x < 3.0 || view.fov_y < 3.0)
        points.push_back({2.0 * yaw / view.fov_x, 2.0 * pitch / view.fov_y});
    }
    if (!points.empty()) require_even(points);
  }
}

TEST_CASE("as many yaw-pitch rays start outside the frustum as the thesis' caster had") {
  // 8.6 % at 90 by 60 degrees, 19 % at 130 by 45.
  for (const auto& [x, y, share] : {std::tuple{90.0, 60.0, 0.086}, {130.0, 45.0, 0.19}}) {
    PointView view;
    view.fov_x = x * kDegree;
    view.fov_y = y * kDegree;
    const InfluenceArea area = InfluenceArea::point(view);
    int outside = 0;
    for (const GnRay& ray : area_rays(area, RayMeasure::kYawPitch, 20000, 100))
      outside += area.contains(to_ray3d(ray).origin) ? 0 : 1;
    CAPTURE(x, y);
    REQUIRE(outside / 20000.0 == Approx(share).margin(0.01));
  }
}

TEST_CASE("rays uniform in solid angle give every part of the window its share") {
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    const Frustum& f = std::get<Frustum>(area.region());
    const double half_x = 0.5 * view.fov_x;
    const double half_y = 0.5 * view.fov_y;
    const auto rays = area_rays(area, RayMeasure::kSolidAngle, 40000, 98, {RayStart::kEye, false});
    const double whole = 4.0 * std::asin(std::sin(half_x) * std::sin(half_y));
    for (const double sx : {0.25, 0.6, 0.95}) {
      for (const double sy : {0.3, 0.7, 0.97}) {
        std::uint64_t inside = 0;
        for (const GnRay& ray : rays) {
          const Vec3d d = local_direction(area, ray);
          REQUIRE((std::abs(d[0]) <= d[2] * f.tan_x * 1.0001 && std::abs(d[1]) <= d[2] * f.tan_y * 1.0001));
          inside += std::abs(d[0]) <= d[2] * std::tan(sx * half_x) && d[1] <= d[2] * std::tan(sy * half_y) &&
                            d[1] >= 0.0
                        ? 1
                        : 0;
        }
        CAPTURE(name, sx, sy);
        require_share(inside, rays.size(),
                      2.0 * std::asin(std::sin(sx * half_x) * std::sin(sy * half_y)) / whole);
      }
    }
  }
}

TEST_CASE("omni rays go every way alike") {
  const InfluenceArea area = InfluenceArea::omni({0, 0, 0}, 1.0);
  const auto rays = area_rays(area, RayMeasure::kSolidAngle, 40000, 99);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double least : {-0.5, 0.0, 0.7}) {
      std::uint64_t beyond = 0;
      for (const GnRay& ray : rays) beyond += static_cast<double>(ray.direction[axis]) > least ? 1 : 0;
      CAPTURE(axis, least);
      require_share(beyond, rays.size(), 0.5 * (1.0 - least));
    }
  }
}
