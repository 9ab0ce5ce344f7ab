// Oriented boxes, frusta and balls against axis-aligned boxes.
#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/solids.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

OrientedBox random_oriented_box(Source& source) {
  const AreaFrame frame = look_along(source.point(-1.0, 1.0), source.direction(), source.direction());
  return {frame.origin,
          {frame.right, frame.up, frame.forward},
          {std::exp2(source.between(-5.0, 1.0)), std::exp2(source.between(-5.0, 1.0)),
           std::exp2(source.between(-5.0, 1.0))}};
}

Frustum random_frustum(Source& source) {
  const AreaFrame frame = look_along(source.point(-1.0, 1.0), source.direction(), source.direction());
  const double near = std::exp2(source.between(-5.0, 0.0));
  return {frame, std::exp2(source.between(-4.0, 1.5)), std::exp2(source.between(-4.0, 1.5)), near,
          near + std::exp2(source.between(-4.0, 2.0))};
}

// Holds overlap() against cutting, for pairs of a random distance about touching.
template <typename Make>
void require_same_as_cutting(Source& source, const Make& make, int pairs) {
  int together = 0;
  int apart = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto body = make(source);
    const Box3d box = source.box(-2.5, 2.5);
    const auto planes = planes_of(body);
    const auto corners = corners_of(body);
    CAPTURE(i, box.lo, box.hi, corners);
    if (meet_by_cutting(planes, corners, box, -1e-9)) {
      REQUIRE(overlap(body, box));
      ++together;
    } else if (!meet_by_cutting(planes, corners, box, 1e-9)) {
      REQUIRE_FALSE(overlap(body, box));
      ++apart;
    }
  }
  REQUIRE(together > pairs / 20);
  REQUIRE(apart > pairs / 20);
}

// A point of the body, from uniform numbers in [-1, 1].
Vec3d point_in(const OrientedBox& body, const Vec3d& s) {
  Vec3d p = body.centre;
  for (std::size_t k = 0; k < 3; ++k) p = p + s[k] * body.half[k] * body.axes[k];
  return p;
}
Vec3d point_in(const Frustum& body, const Vec3d& s) {
  const double z = body.near_distance + 0.5 * (1.0 + s[2]) * (body.far_distance - body.near_distance);
  return to_world(body.frame, {s[0] * z * body.tan_x, s[1] * z * body.tan_y, z});
}

// Boxes that reach a body in one point only, from every side, are never called apart.
template <typename Make>
void require_touch(Source& source, const Make& make) {
  for (int i = 0; i < 20000; ++i) {
    const auto body = make(source);
    Vec3d s = source.point(-1.0, 1.0);
    for (double& x : s) {
      if (source.raw().chance(0.5)) x = x < 0.0 ? -1.0 : 1.0;
    }
    const Vec3d p = point_in(body, s);
    Box3d box{p, p};
    for (std::size_t k = 0; k < 3; ++k) {
      const double size = source.raw().chance(0.2) ? 0.0 : std::exp2(source.between(-20.0, 3.0));
      (source.raw().chance(0.5) ? box.lo[k] : box.hi[k]) += source.raw().chance(0.5) ? 0.0 : size;
      if (box.lo[k] > box.hi[k]) std::swap(box.lo[k], box.hi[k]);
    }
    CAPTURE(i, p, box.lo, box.hi, corners_of(body));
    REQUIRE(overlap(body, box));
  }
}

}  // namespace

TEST_CASE("an oriented box overlaps a box exactly when cutting leaves something") {
  Source source(31);
  require_same_as_cutting(source, random_oriented_box, 40000);
}

TEST_CASE("a frustum overlaps a box exactly when cutting leaves something") {
  Source source(32);
  require_same_as_cutting(source, random_frustum, 40000);
}

TEST_CASE("bodies that touch a box in a point are never called apart") {
  Source source(33);
  require_touch(source, random_oriented_box);
  require_touch(source, random_frustum);
}

TEST_CASE("bodies turned by very little, whose edges are nearly parallel, are judged right") {
  Source source(34);
  for (const double turn : {0.0, 1e-16, 1e-12, 1e-9, 1e-6}) {
    const auto nearly_straight = [turn](Source& s) {
      const Vec3d tilt = turn * s.direction();
      const AreaFrame frame = look_along(s.point(-1.0, 1.0), Vec3d{0, 0, 1} + tilt, Vec3d{0, 1, 0});
      return OrientedBox{frame.origin, {frame.right, frame.up, frame.forward}, {0.5, 1.0, 0.75}};
    };
    CAPTURE(turn);
    require_same_as_cutting(source, nearly_straight, 4000);
  }
}

TEST_CASE("boxes one side of a face touch it at equality and not beyond") {
  const OrientedBox straight{{1, 2, 3}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {1, 1, 1}};
  REQUIRE(overlap(straight, Box3d{{2, 0, 0}, {3, 9, 9}}));
  REQUIRE_FALSE(overlap(straight, Box3d{{2.0 + 1e-12, 0, 0}, {3, 9, 9}}));
  const Frustum ahead{AreaFrame{}, 1.0, 0.5, 1.0, 4.0};
  REQUIRE(overlap(ahead, Box3d{{-1, -1, 4}, {1, 1, 5}}));
  REQUIRE_FALSE(overlap(ahead, Box3d{{-1, -1, 4.0 + 1e-12}, {1, 1, 5}}));
  REQUIRE(overlap(ahead, Box3d{{-1, -1, 0}, {1, 1, 1}}));
  REQUIRE_FALSE(overlap(ahead, Box3d{{-1, -1, -1}, {1, 1, 1.0 - 1e-12}}));
  REQUIRE(overlap(ahead, Box3d{{2, -1, 2}, {3, 1, 2}}));  // on the slanted side
  REQUIRE_FALSE(overlap(ahead, Box3d{{2.0 + 1e-12, -1, 2}, {3, 1, 2}}));
  REQUIRE(overlap(ahead, Box3d{{-50, -50, -50}, {50, 50, 50}}));  // around it all
  REQUIRE_FALSE(overlap(ahead, Box3d{}));
  REQUIRE_FALSE(overlap(straight, Box3d{}));
}

TEST_CASE("a ball overlaps a box when the box's nearest point is in it") {
  Source source(35);
  int together = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ball ball{source.point(-1.0, 1.0), std::exp2(source.between(-4.0, 1.0))};
    const Box3d box = source.box(-2.5, 2.5);
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double out = std::max({box.lo[k] - ball.centre[k], 0.0, ball.centre[k] - box.hi[k]});
      squared += out * out;
    }
    CAPTURE(i, ball.centre, ball.radius, box.lo, box.hi);
    REQUIRE(overlap(ball, box) == (squared <= ball.radius * ball.radius));
    together += overlap(ball, box) ? 1 : 0;
  }
  REQUIRE(together > 500);
  REQUIRE(overlap(Ball{{0, 0, 0}, 1.0}, Box3d{{1, -1, -1}, {2, 1, 1}}));
  REQUIRE_FALSE(overlap(Ball{{0, 0, 0}, 1.0}, Box3d{{0.8, 0.8, 0.8}, {2, 2, 2}}));
}

TEST_CASE("a point is in a body when it is on the inner side of all planes") {
  Source source(36);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const OrientedBox box = random_oriented_box(source);
    const Frustum frustum = random_frustum(source);
    const Vec3d p = source.point(-2.0, 2.0);
    const auto nearest_side = [&p](const auto& planes) {
      double least = 1e9;
      for (const Plane& plane : planes) {
        REQUIRE(length(plane.normal) == Approx(1.0).epsilon(1e-12));
        least = std::min(least, signed_distance(plane, p));
      }
      return least;
    };
    CAPTURE(i, p, corners_of(box), corners_of(frustum));
    for (const Vec3d& corner : corners_of(frustum)) {
      for (const Plane& plane : planes_of(frustum)) REQUIRE(signed_distance(plane, corner) > -1e-12);
    }
    if (std::abs(nearest_side(planes_of(box))) > 1e-12)
      REQUIRE(contains(box, p) == (nearest_side(planes_of(box)) > 0.0));
    if (std::abs(nearest_side(planes_of(frustum))) > 1e-12)
      REQUIRE(contains(frustum, p) == (nearest_side(planes_of(frustum)) > 0.0));
    inside += contains(frustum, p) ? 1 : 0;
  }
  REQUIRE(inside > 200);
}
