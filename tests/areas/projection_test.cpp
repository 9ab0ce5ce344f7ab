// Projected measures of boxes, held against rays of the measure and against closed forms.
#include "gnomon/areas/projection.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/area_rays.h"
#include "gnomon/areas/cone_weights.h"
#include "gnomon/areas/solid_angle.h"
#include "gnomon/base/error.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr std::uint64_t kRays = 8000;
constexpr RayMeasure kPointMeasures[] = {RayMeasure::kSolidAngle, RayMeasure::kNearPlane,
                                         RayMeasure::kYawPitch};
constexpr RayStart kStarts[] = {RayStart::kWindow, RayStart::kEye};

void require_share_of_rays(const InfluenceArea& area, const Box3d& box, RayMeasure measure, RayStart start,
                           const std::vector<GnRay>& rays) {
  std::uint64_t hits = 0;
  for (const GnRay& ray : rays) hits += intersect(to_ray3d(ray), box) ? 1 : 0;
  CAPTURE(to_string(measure), start == RayStart::kEye, box.lo, box.hi);
  require_share(hits, rays.size(), culled_measure(area, box, measure, start) / window_measure(area, measure));
}

// Boxes all over the region and around it: in front, beside, behind, across the near plane, around the eye.
std::vector<Box3d> boxes_about(const InfluenceArea& area, Source& source, int count) {
  const Vec3d origin = area.frame().origin;
  std::vector<Box3d> boxes;
  for (int i = 0; i < count; ++i) {
    Box3d box = source.box(-3.0, 3.0);
    if (i % 4 == 0) {  // about the eye or the window's middle
      const Vec3d shift = origin + source.point(-0.5, 0.5) - 0.5 * (box.lo + box.hi);
      box = {box.lo + shift, box.hi + shift};
    } else if (i % 4 == 1) {  // right ahead
      const double far = std::exp2(source.between(-2.0, 3.0));
      const Vec3d shift = origin + far * area.frame().forward - 0.5 * (box.lo + box.hi);
      box = {box.lo + shift, box.hi + shift};
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

TEST_CASE(
    "the closed form, the silhouette and the hull of eight corners agree for all 26 classes of direction") {
  Source source(51);
  for (const auto& [name, window] : plane_windows()) {
    const InfluenceArea area = InfluenceArea::plane(window);
    for (int i = 0; i < 50; ++i) {
      const Box3d box = source.box(-3.0, 3.0);
      CAPTURE(name, window.direction, box.lo, box.hi);
      Polygon2d corners;
      for (unsigned k = 0; k < 8; ++k) {
        const Vec3d p = to_local(area.frame(), corner_of(box, k));
        corners.push_back({p[0], p[1]});
      }
      const double by_hull = area_of(convex_hull_of(corners));
      REQUIRE(projected_measure(area, box, RayMeasure::kParallel) == Approx(by_hull).epsilon(1e-12));
      REQUIRE(area_of(projected_hull(area, box, RayMeasure::kParallel)) == Approx(by_hull).epsilon(1e-12));
      REQUIRE(projected_hull(area, box, RayMeasure::kParallel).size() == 6);
    }
  }
}

TEST_CASE(
    "a box inside the window is not cut, one that covers it fills it, one beside or behind it is nothing") {
  Source source(52);
  for (const auto& [name, window] : plane_windows()) {
    const InfluenceArea area = InfluenceArea::plane(window);
    CAPTURE(name, window.direction);
    const double whole = window_measure(area, RayMeasure::kParallel);
    REQUIRE(whole == 4.0 * window.half_width * window.half_height);
    const auto box_at = [&](double x, double y, double z, double h) {
      const Vec3d centre = to_world(area.frame(), {x, y, z});
      return Box3d{centre - Vec3d{h, h, h}, centre + Vec3d{h, h, h}};
    };
    const double h = 0.2 * std::min(window.half_width, window.half_height);
    const Box3d inside = box_at(0.5 * (window.half_width - 2.0 * h), 0.0, 3.0, h);
    const double uncut = projected_measure(area, inside, RayMeasure::kParallel);
    REQUIRE(culled_measure(area, inside, RayMeasure::kParallel) == Approx(uncut).epsilon(1e-9));
    REQUIRE(culled_measure(area, box_at(0, 0, 0, 50), RayMeasure::kParallel) == Approx(whole).epsilon(1e-12));
    REQUIRE(culled_measure(area, box_at(0, 0, -9, 5), RayMeasure::kParallel) == 0.0);
    REQUIRE(culled_measure(area, box_at(20, 0, 3, 5), RayMeasure::kParallel) == 0.0);
    REQUIRE(culled_measure(area, Box3d{}, RayMeasure::kParallel) == 0.0);
    REQUIRE(projected_measure(area, Box3d{}, RayMeasure::kParallel) == 0.0);
  }
}

TEST_CASE("the culled measure of a plane area is the share of its rays that meet the box") {
  Source source(53);
  for (const auto& [name, window] : plane_windows()) {
    const InfluenceArea area = InfluenceArea::plane(window);
    CAPTURE(name, window.direction);
    const auto rays = area_rays(area, RayMeasure::kParallel, kRays, 53);
    for (const Box3d& box : boxes_about(area, source, 16))
      require_share_of_rays(area, box, RayMeasure::kParallel, RayStart::kWindow, rays);
  }
}

TEST_CASE("the culled measures of a point area are the shares of its rays that meet the box") {
  Source source(54);
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    const auto boxes = boxes_about(area, source, 40);
    CAPTURE(name);
    for (const RayMeasure measure : kPointMeasures) {
      for (const RayStart start : kStarts) {
        const auto rays = area_rays(area, measure, kRays, 54, {start, false});
        for (const Box3d& box : boxes) require_share_of_rays(area, box, measure, start, rays);
      }
    }
  }
}

TEST_CASE("the culled measure of an omni area is its solid angle, and the share of its rays") {
  Source source(55);
  const InfluenceArea area = InfluenceArea::omni({0.5, -0.25, 1.0}, 4.0);
  const auto rays = area_rays(area, RayMeasure::kSolidAngle, kRays, 55);
  REQUIRE(window_measure(area, RayMeasure::kSolidAngle) == Approx(4.0 * kPiD));
  for (const Box3d& box : boxes_about(area, source, 60)) {
    require_share_of_rays(area, box, RayMeasure::kSolidAngle, RayStart::kWindow, rays);
    REQUIRE(projected_measure(area, box, RayMeasure::kSolidAngle) ==
            culled_measure(area, box, RayMeasure::kSolidAngle));
  }
}

TEST_CASE("windows are as large as they should be, and the box around everything fills them") {
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    CAPTURE(name);
    const double tx = std::tan(view.fov_x / 2.0);
    const double ty = std::tan(view.fov_y / 2.0);
    const double near = view.near_distance;
    REQUIRE(window_measure(area, RayMeasure::kNearPlane) ==
            Approx(4.0 * tx * ty * near * near).epsilon(1e-9));
    REQUIRE(window_measure(area, RayMeasure::kYawPitch) == Approx(view.fov_x * view.fov_y).epsilon(1e-12));
    // The frustum's mouth as a polygon.
    const Polygon3d mouth{{-tx, -ty, 1}, {tx, -ty, 1}, {tx, ty, 1}, {-tx, ty, 1}};
    REQUIRE(window_measure(area, RayMeasure::kSolidAngle) ==
            Approx(solid_angle_of({0, 0, 0}, mouth)).epsilon(1e-9));
    const Box3d all{{-1e5, -1e5, -1e5}, {1e5, 1e5, 1e5}};
    for (const RayMeasure measure : kPointMeasures) {
      for (const RayStart start : kStarts) {
        CAPTURE(to_string(measure));
        REQUIRE(culled_measure(area, all, measure, start) ==
                Approx(window_measure(area, measure)).epsilon(1e-7));
        REQUIRE(culled_measure(area, Box3d{}, measure, start) == 0.0);
      }
    }
  }
}

TEST_CASE(
    "a box about the eye is met by all rays that start in the eye, and only beyond the window by the "
    "others") {
  PointView view;  // at the origin along z, near plane at 1
  view.fov_x = view.fov_y = 90.0 * kDegree;
  const InfluenceArea area = InfluenceArea::point(view);
  const Box3d small{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  const Box3d longer{{-0.5, -0.5, -0.5}, {0.5, 0.5, 1.5}};
  const Box3d behind{{-0.5, -0.5, -1.5}, {0.5, 0.5, -0.5}};
  const Box3d on_eye{{-0.5, -0.5, 0.0}, {0.5, 0.5, 0.5}};    // the eye in its lower face
  const Box3d off_eye{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.0}};  // and in its upper face
  const Box3d beside{{0.0, -0.5, -0.5}, {0.5, 0.5, 1.5}};    // and in the face to its left
  for (const RayMeasure measure : kPointMeasures) {
    const double whole = window_measure(area, measure);
    CAPTURE(to_string(measure));
    REQUIRE(culled_measure(area, small, measure, RayStart::kEye) == Approx(whole).epsilon(1e-9));
    REQUIRE(culled_measure(area, small, measure, RayStart::kWindow) == 0.0);
    REQUIRE(culled_measure(area, longer, measure, RayStart::kEye) == Approx(whole).epsilon(1e-9));
    const double through = culled_measure(area, longer, measure, RayStart::kWindow);
    REQUIRE(through > 0.0);
    REQUIRE(through < 0.5 * whole);
    REQUIRE(culled_measure(area, on_eye, measure, RayStart::kEye) == Approx(whole).epsilon(1e-9));
    REQUIRE(culled_measure(area, off_eye, measure, RayStart::kEye) == 0.0);
    REQUIRE(culled_measure(area, beside, measure, RayStart::kEye) == Approx(0.5 * whole).epsilon(1e-9));
    for (const RayStart start : kStarts) REQUIRE(culled_measure(area, behind, measure, start) == 0.0);
  }
  REQUIRE(culled_measure(area, longer, RayMeasure::kNearPlane) == Approx(1.0).epsilon(1e-12));
  REQUIRE(projected_measure(area, longer, RayMeasure::kNearPlane) == Approx(1.0).epsilon(1e-12));
  REQUIRE(projected_measure(area, small, RayMeasure::kNearPlane) == 0.0);
  REQUIRE(projected_measure(area, behind, RayMeasure::kNearPlane) == 0.0);
}

TEST_CASE("on the near plane a face ahead is its area scaled, and a wide window cuts nothing") {
  PointView narrow;
  narrow.eye = {1, 2, 3};
  narrow.near_distance = 0.5;
  narrow.far_distance = 50.0;
  const InfluenceArea area = InfluenceArea::point(narrow);
  const Box3d wall{{0.5, 1.5, 8.0}, {1.25, 2.5, 9.0}};
  REQUIRE(projected_measure(area, wall, RayMeasure::kNearPlane) == Approx(0.75 * 1.0 * 0.01).epsilon(1e-12));
  Source source(56);
  int cut = 0;
  for (int i = 0; i < 2000; ++i) {
    PointView view = narrow;
    view.direction = source.direction();
    view.eye = source.point(-4.0, 4.0);
    const InfluenceArea some = InfluenceArea::point(view);
    view.fov_x = view.fov_y = kPiD - 1e-7;
    const InfluenceArea wide = InfluenceArea::point(view);
    const Box3d box = source.box(-3.0, 3.0);
    CAPTURE(i, view.direction, view.eye, box.lo, box.hi);
    const double uncut = projected_measure(wide, box, RayMeasure::kNearPlane);
    REQUIRE(uncut == projected_measure(some, box, RayMeasure::kNearPlane));
    REQUIRE(culled_measure(wide, box, RayMeasure::kNearPlane) == Approx(uncut).epsilon(1e-6));
    const double culled = culled_measure(some, box, RayMeasure::kNearPlane);
    REQUIRE(culled <= uncut * (1.0 + 1e-9));
    const double half = view.near_distance * std::tan(0.5);
    const Polygon2d window{{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    const Polygon2d hull = projected_hull(some, box, RayMeasure::kNearPlane);
    REQUIRE(culled == Approx(area_of(intersection_of(hull, window))).epsilon(1e-7).margin(1e-12));
    cut += culled < 0.99 * uncut ? 1 : 0;
  }
  REQUIRE(cut > 100);
}

TEST_CASE("measures grow with the box and never exceed the window") {
  Source source(57);
  for (const auto& [name, view] : point_views()) {
    const InfluenceArea area = InfluenceArea::point(view);
    for (int i = 0; i < 60; ++i) {
      const Box3d box = source.box(-3.0, 3.0);
      Box3d larger_box = box;
      extend(larger_box, source.point(-4.0, 4.0));
      for (const RayMeasure measure : kPointMeasures) {
        for (const RayStart start : kStarts) {
          CAPTURE(name, i, to_string(measure), start == RayStart::kEye, box.lo, box.hi, larger_box.lo,
                  larger_box.hi);
          const double whole = window_measure(area, measure);
          const double small = culled_measure(area, box, measure, start);
          const double large = culled_measure(area, larger_box, measure, start);
          REQUIRE(small >= 0.0);
          REQUIRE(small <= large + 1e-7 * whole);
          REQUIRE(large <= whole * (1.0 + 1e-7));
        }
      }
    }
  }
}

TEST_CASE("hulls are counter-clockwise or clockwise outlines within the window") {
  Source source(58);
  for (const auto& [name, window] : plane_windows()) {
    const InfluenceArea area = InfluenceArea::plane(window);
    for (const Box3d& box : boxes_about(area, source, 20)) {
      const Polygon2d hull = culled_hull(area, box, RayMeasure::kParallel);
      CAPTURE(name, window.direction, box.lo, box.hi, hull);
      for (const Vec2d& p : hull) {
        REQUIRE(std::abs(p[0]) <= window.half_width * (1.0 + 1e-12));
        REQUIRE(std::abs(p[1]) <= window.half_height * (1.0 + 1e-12));
      }
    }
  }
}

TEST_CASE("measures that an area does not have are refused by name") {
  const InfluenceArea plane = InfluenceArea::plane(PlaneWindow{});
  const InfluenceArea point = InfluenceArea::point(PointView{});
  const InfluenceArea omni = InfluenceArea::omni({0, 0, 0}, 1.0);
  const Box3d box{{0, 0, 0}, {1, 1, 1}};
  for (const RayMeasure measure : kPointMeasures) {
    CAPTURE(to_string(measure));
    REQUIRE_THROWS_AS(window_measure(plane, measure), Error);
    REQUIRE_THROWS_AS(culled_measure(plane, box, measure), Error);
    REQUIRE_THROWS_AS(projected_measure(plane, Box3d{}, measure), Error);
    REQUIRE_THROWS_AS(culled_hull(plane, box, measure), Error);
    REQUIRE_THROWS_AS(area_rays(plane, measure, 1, 1), Error);
  }
  for (const RayMeasure measure : {RayMeasure::kParallel, RayMeasure::kNearPlane, RayMeasure::kYawPitch})
    REQUIRE_THROWS_AS(window_measure(omni, measure), Error);
  REQUIRE_THROWS_AS(window_measure(point, RayMeasure::kParallel), Error);
  REQUIRE_THROWS_AS(projected_measure(point, box, RayMeasure::kYawPitch), Error);
  REQUIRE_THROWS_AS(culled_hull(point, box, RayMeasure::kSolidAngle), Error);
  REQUIRE_THROWS_AS(projected_hull(point, box, RayMeasure::kYawPitch), Error);
  REQUIRE_THROWS_WITH(window_measure(plane, RayMeasure::kYawPitch),
                      "plane areas have no rays uniform in yaw and pitch");
}
