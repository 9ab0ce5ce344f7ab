// Areas grown on all sides.
#include "gnomon/areas/grown_area.h"

#include <catch2/catch.hpp>

#include "support/area_shapes.h"

using namespace gnomon;
using namespace gnomon::test;

TEST_CASE(
    "a grown area holds every point within its distance of the area, is turned alike and not much larger") {
  Source source(151);
  for (const auto& [name, area] : areas_of_every_kind()) {
    for (const double distance : {1e-6, 1e-3, 0.3}) {
      CAPTURE(name, distance);
      const InfluenceArea grown = grown_by(area, distance);
      REQUIRE(grown.kind() == area.kind());
      REQUIRE(length(grown.frame().forward - area.frame().forward) < 1e-12);
      REQUIRE(length(grown.frame().up - area.frame().up) < 1e-12);
      for (int i = 0; i < 200; ++i) {
        Vec3d u = source.point(-1.0, 1.0);
        for (double& x : u) x = i % 2 == 0 ? x : (x > 0.0 ? 1.0 : -1.0);
        const Vec3d p = place_in(area, u) + 0.999 * distance * source.direction();
        REQUIRE(grown.contains(p));
      }
      for (std::size_t i = 0; i < area.planes().size(); ++i) {
        const double moved = grown.planes()[i].offset - area.planes()[i].offset;
        REQUIRE(length(grown.planes()[i].normal - area.planes()[i].normal) < 1e-9);
        REQUIRE(moved >= 0.999 * distance);
        // The wider sides of a frustum move by the ratio of their half angles' sines; 179 by 1 degree: 115.
        REQUIRE(moved <= 120.0 * distance);
      }
      if (const auto* ball = std::get_if<Ball>(&grown.region()))
        REQUIRE(ball->radius == std::get<Ball>(area.region()).radius + distance);
    }
    REQUIRE(grown_by(area, 0.0).enclosing_box().lo == area.enclosing_box().lo);
  }
}

TEST_CASE("a view that begins closer than it grows has its eye inside") {
  PointView view;
  view.near_distance = 1e-5;
  REQUIRE_FALSE(InfluenceArea::point(view).contains(view.eye));
  REQUIRE(grown_by(InfluenceArea::point(view), 1e-4).contains(view.eye));
}
