// Influence areas as regions: frames, containment, affinity and where rays leave.
#include "gnomon/areas/influence_area.h"

#include <catch2/catch.hpp>
#include <functional>

#include "area_test_tools.h"
#include "gnomon/base/error.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

std::vector<std::pair<std::string, InfluenceArea>> all_areas() {
  std::vector<std::pair<std::string, InfluenceArea>> areas;
  for (const auto& [name, view] : point_views())
    areas.emplace_back("point " + name, InfluenceArea::point(view));
  for (const auto& [name, window] : plane_windows())
    areas.emplace_back("plane " + name, InfluenceArea::plane(window));
  areas.emplace_back("omni", InfluenceArea::omni({0.5, -1.0, 2.0}, 3.0));
  return areas;
}

// A point well inside, from uniform numbers in (-1, 1).
Vec3d point_in(const InfluenceArea& area, const Vec3d& s) {
  if (const auto* ball = std::get_if<Ball>(&area.region())) return ball->centre + 0.57 * ball->radius * s;
  if (const auto* f = std::get_if<Frustum>(&area.region())) {
    const double z = f->near_distance + 0.5 * (1.0 + s[2]) * (f->far_distance - f->near_distance);
    return to_world(f->frame, {s[0] * z * f->tan_x, s[1] * z * f->tan_y, z});
  }
  const auto& box = std::get<OrientedBox>(area.region());
  Vec3d p = box.centre;
  for (std::size_t k = 0; k < 3; ++k) p = p + s[k] * box.half[k] * box.axes[k];
  return p;
}

void require_refused(const std::function<void()>& make, const std::string& word) {
  CAPTURE(word);
  try {
    make();
  } catch (const Error& error) {
    REQUIRE(error.code() == ErrorCode::kInvalidArgument);
    CAPTURE(error.what());
    REQUIRE(std::string(error.what()).find(word) != std::string::npos);
    return;
  }
  FAIL("accepted");
}

}  // namespace

TEST_CASE("frames are orthonormal, look along the direction and keep up upwards") {
  Source source(41);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d direction = std::exp2(source.between(-300.0, 300.0)) * source.direction();
    const Vec3d hint =
        i % 3 == 0 ? direction + 1e-5 * magnitude(direction) * source.direction() : source.direction();
    if (length(cross(unit_of(hint), unit_of(direction))) < 1e-6) continue;  // the next test
    const AreaFrame f = look_along({1, 2, 3}, direction, hint);
    CAPTURE(i, direction, hint, f.right, f.up, f.forward);
    REQUIRE(dot(f.forward, unit_of(direction)) == Approx(1.0).epsilon(1e-14));
    for (const auto& [a, b] : {std::pair{f.right, f.up}, {f.up, f.forward}, {f.forward, f.right}}) {
      REQUIRE(std::abs(dot(a, b)) < 1e-14);
      REQUIRE(length(a) == Approx(1.0).epsilon(1e-14));
    }
    REQUIRE(length(cross(f.up, f.forward) - f.right) < 1e-14);
    REQUIRE(dot(f.up, hint) > 0.0);
    const Vec3d p = source.point(-5.0, 5.0);
    REQUIRE(length(to_world(f, to_local(f, p)) - p) < 1e-13);
  }
}

TEST_CASE("an up hint along the direction is replaced; straight up and down look with x to the right") {
  for (const double way : {1.0, -1.0, 3.0}) {
    const AreaFrame f = look_along({0, 0, 0}, {0, way, 0}, kWorldUp);
    CAPTURE(way);
    REQUIRE(f.right == Vec3d{1, 0, 0});
    REQUIRE(f.forward == Vec3d{0, way > 0 ? 1.0 : -1.0, 0});
    REQUIRE(f.up == Vec3d{0, 0, way > 0 ? -1.0 : 1.0});
  }
  for (const Vec3d& d : direction_classes()) {
    for (const double hint : {1.0, -2.0, 1e-200}) {
      const AreaFrame f = look_along({0, 0, 0}, d, hint * d);
      CAPTURE(d, hint, f.right, f.up);
      REQUIRE(std::abs(dot(f.right, f.forward)) < 1e-14);
      REQUIRE(length(f.up) == Approx(1.0));
    }
  }
}

TEST_CASE("an area contains the points between its planes, and its enclosing box all of them") {
  Source source(42);
  for (const auto& [name, area] : all_areas()) {
    const Box3d around = area.enclosing_box();
    for (int i = 0; i < 500; ++i) {
      const Vec3d inside = point_in(area, source.point(-0.999, 0.999));
      CAPTURE(name, i, inside);
      REQUIRE(area.contains(inside));
      REQUIRE(contains(around, inside));
      for (const Plane& plane : area.planes()) REQUIRE(signed_distance(plane, inside) > 0.0);
      Vec3d s = source.point(-1.0, 1.0);
      s[static_cast<std::size_t>(i) % 3] = i % 2 == 0 ? 1.001 : -1.001;
      const Vec3d outside = point_in(area, s);
      if (area.kind() != AreaKind::kOmni) REQUIRE_FALSE(area.contains(outside));
    }
    REQUIRE(area.planes().size() == (area.kind() == AreaKind::kOmni ? 0U : 6U));
  }
  const InfluenceArea ball = InfluenceArea::omni({1, 2, 3}, 2.0);
  REQUIRE(ball.contains({3, 2, 3}));
  REQUIRE_FALSE(ball.contains({3.0000001, 2, 3}));
  REQUIRE_FALSE(ball.contains({2.5, 3.5, 3}));
}

TEST_CASE("a box is fully contained when its own corners are, not when it holds the region") {
  Source source(43);
  for (const auto& [name, area] : all_areas()) {
    CAPTURE(name);
    REQUIRE_FALSE(area.fully_contains({{-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}}));
    REQUIRE_FALSE(area.fully_contains(area.enclosing_box()));
    REQUIRE_FALSE(area.fully_contains(Box3d{}));
    REQUIRE(area.overlaps({{-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}}));
    int full = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3d centre = point_in(area, source.point(-1.0, 1.0));
      const double h = std::exp2(source.between(-12.0, 0.0));
      const Box3d box{centre - Vec3d{h, h, h}, centre + Vec3d{h, h, h}};
      CAPTURE(i, box.lo, box.hi);
      bool all = true;
      for (int k = 0; k < 200; ++k) {
        // Its corners among them.
        Vec3d p = k < 8 ? corner_of(box, static_cast<unsigned>(k)) : centre + source.point(-h, h);
        all &= area.contains(p);
      }
      REQUIRE(area.fully_contains(box) == all);
      REQUIRE(area.overlaps(box));
      full += all ? 1 : 0;
    }
    REQUIRE(full > 10);
  }
}

TEST_CASE("a ray leaves where bisection on contains says it does") {
  Source source(44);
  for (const auto& [name, area] : all_areas()) {
    for (int i = 0; i < 300; ++i) {
      const Ray3d ray{point_in(area, source.point(-0.999, 0.999)),
                      std::exp2(source.between(-6.0, 6.0)) * source.direction()};
      const auto exit = area.exit_distance(ray);
      CAPTURE(name, i, ray.origin, ray.direction);
      REQUIRE(exit.has_value());
      double inside = 0.0;
      double outside = 1e5 / length(ray.direction);
      REQUIRE_FALSE(area.contains(ray.origin + outside * ray.direction));
      for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (inside + outside);
        (area.contains(ray.origin + middle * ray.direction) ? inside : outside) = middle;
      }
      REQUIRE(*exit == Approx(inside).epsilon(1e-9).margin(1e-9 / length(ray.direction)));
    }
    const Vec3d middle = point_in(area, {0, 0, 0});
    CAPTURE(name);
    REQUIRE(std::isinf(*area.exit_distance({middle, {0, 0, 0}})));
    REQUIRE_FALSE(area.exit_distance({middle + Vec3d{1e4, 0, 0}, {-1, 0, 0}}).has_value());
  }
}

TEST_CASE("an origin on the boundary leaves at once or later, never before it starts") {
  const InfluenceArea plane = InfluenceArea::plane(PlaneWindow{});
  REQUIRE(*plane.exit_distance({{0, 0, 0}, {0, 0, 1}}) == 1.0);
  REQUIRE(*plane.exit_distance({{0, 0, 0}, {0, 0, -1}}) == 0.0);
  REQUIRE(*plane.exit_distance({{1, 0, 0.5}, {0, 0.5, 0}}) == 2.0);  // along a side
  const InfluenceArea ball = InfluenceArea::omni({0, 0, 0}, 2.0);
  REQUIRE(*ball.exit_distance({{2, 0, 0}, {1, 0, 0}}) == 0.0);
  REQUIRE(*ball.exit_distance({{2, 0, 0}, {-0.5, 0, 0}}) == 8.0);
  REQUIRE(*ball.exit_distance({{0, 0, 0}, {0, 3, 0}}) == Approx(2.0 / 3.0));
}

TEST_CASE("affine rays start inside and run with or against the area's, within the tolerance") {
  Source source(45);
  const double widest = std::acos(0.99);
  for (const auto& [name, area] : all_areas()) {
    for (int i = 0; i < 200; ++i) {
      const Vec3d origin = point_in(area, source.point(-0.99, 0.99));
      const Vec3d along = area.direction_at(origin);
      const Vec3d across = unit_of(cross(along, source.direction()));
      CAPTURE(name, i, origin, along);
      if (area.kind() == AreaKind::kPlane) {
        REQUIRE(along == area.frame().forward);
      } else {
        REQUIRE(length(cross(along, origin - area.frame().origin)) < 1e-12);
      }
      for (const double sense : {1.0, -3.0}) {
        const auto at_angle = [&](double angle) {
          return Ray3d{origin, sense * (std::cos(angle) * along + std::sin(angle) * across)};
        };
        REQUIRE(area.is_affine(at_angle(0.0)));
        REQUIRE(area.is_affine(at_angle(widest - 1e-6)));
        REQUIRE_FALSE(area.is_affine(at_angle(widest + 1e-6)));
        REQUIRE(area.is_affine(at_angle(widest + 1e-6), 0.02));
        REQUIRE_FALSE(area.is_affine(at_angle(0.01), 1e-5));
        REQUIRE_FALSE(area.is_affine({origin + Vec3d{1e4, 0, 0}, along}));
      }
      REQUIRE_FALSE(area.is_affine({origin, {0, 0, 0}}));
    }
  }
  const InfluenceArea omni = InfluenceArea::omni({1, 2, 3}, 1.0);
  REQUIRE(omni.is_affine({{1, 2, 3}, {0.3, -0.2, 0.1}}));
}

TEST_CASE("what an area cannot be made of is refused with its name") {
  const double nan = std::nan("");
  const auto plane = [](auto change) {
    return [change] {
      PlaneWindow window;
      change(window);
      static_cast<void>(InfluenceArea::plane(window));
    };
  };
  const auto point = [](auto change) {
    return [change] {
      PointView view;
      change(view);
      static_cast<void>(InfluenceArea::point(view));
    };
  };
  require_refused(plane([&](auto& w) { w.point[1] = nan; }), "plane area: point ");
  require_refused(plane([&](auto& w) { w.direction = {0, 0, 0}; }), "plane area: direction ");
  require_refused(plane([&](auto& w) { w.direction[2] = INFINITY; }), "plane area: direction ");
  require_refused(plane([&](auto& w) { w.up = {0, 0, 0}; }), "plane area: up ");
  for (const double bad : {0.0, -1.0, nan, static_cast<double>(INFINITY)}) {
    require_refused(plane([&](auto& w) { w.half_width = bad; }), "plane area: half_width ");
    require_refused(plane([&](auto& w) { w.half_height = bad; }), "plane area: half_height ");
    require_refused(plane([&](auto& w) { w.depth = bad; }), "plane area: depth ");
    require_refused(point([&](auto& v) { v.fov_x = bad; }), "point area: fov_x ");
    require_refused(point([&](auto& v) { v.near_distance = bad; }), "point area: near_distance ");
    require_refused(point([&](auto& v) { v.far_distance = bad; }), "point area: far_distance ");
    require_refused([&] { static_cast<void>(InfluenceArea::omni({0, 0, 0}, bad)); }, "omni area: radius ");
  }
  require_refused(point([&](auto& v) { v.fov_y = kPiD; }), "point area: fov_y ");
  require_refused(point([&](auto& v) { v.fov_y = 60.0; }), "radians");  // degrees by mistake
  require_refused(point([&](auto& v) { v.far_distance = v.near_distance; }), "greater than near_distance");
  require_refused(point([&](auto& v) { v.eye[0] = nan; }), "point area: eye ");
  require_refused(point([&](auto& v) { v.direction = {0, 0, 0}; }), "point area: direction ");
  require_refused(point([&](auto& v) { v.up[0] = nan; }), "point area: up ");
  require_refused([&] { static_cast<void>(InfluenceArea::omni({nan, 0, 0}, 1.0)); }, "omni area: centre ");
  plane([](auto&) {})();
  point([](auto& v) { v.fov_x = v.fov_y = 179.0 * kDegree; })();
}
