// Measures that are taken in lanes and however large the box is, solid angles and what a window leaves of
// parallel rays, against the double-precision reference.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/areas/measure.h"
#include "gnomon/areas/projection.h"
#include "gnomon/shared/measure_math.h"
#include "measured_boxes.h"

using gnomon::InfluenceArea;
using gnomon::RayMeasure;
using gnomon::Vec3d;
using gnomon::test::Box;
using gnomon::test::Random;
using gnomon::test::random_box;

namespace {

// Moves the box until a corner of it lies on the window's upper side, but for rounding.
void move_to_side(Box& box, const GnMeasure& window) {
  std::size_t axis = 0;
  double height = -static_cast<double>(window.half_height);
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::fabs(window.up[k]) > std::fabs(window.up[axis])) axis = k;
    height += static_cast<double>(window.up[k]) * (static_cast<double>(box.lo[k]) - window.origin[k]);
  }
  const auto step = static_cast<float>(height / window.up[axis]);
  box.lo[axis] -= step;
  box.hi[axis] -= step;
}

}  // namespace

TEST_CASE("large boxes around a lamp are measured in lanes as the reference measures them") {
  const InfluenceArea lamp = InfluenceArea::omni({0.5, -0.25, 0.125}, 50);
  const GnMeasure m = gnomon::measure_of(lamp, RayMeasure::kSolidAngle, false);
  Random random(109);
  int whole = 0;
  int around = 0;
  int thin = 0;
  for (int i = 0; i < 4000; ++i) {
    const Box box = random_box(random, 0.5F, 20.0F);
    if (gn_measure_how(&m, box.lo, box.hi) != GN_SEEN_WHOLE) continue;
    CAPTURE(i, box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]);
    const double exact = gnomon::projected_measure(lamp, box.exact(), RayMeasure::kSolidAngle);
    const double got = gn_box_measure(&m, GN_SEEN_WHOLE, box.lo, box.hi);
    REQUIRE(got == Approx(exact).epsilon(2e-5).margin(2e-6));
    REQUIRE(gn_box_measure(&m, GN_SEEN_PRECISE, box.lo, box.hi) == Approx(exact).epsilon(2e-5).margin(2e-6));
    whole += 1;
    around += got > 12.5 ? 1 : 0;
    // Parts, thin and flat ones too, are measured as it is.
    Box part = box;
    const auto axis = static_cast<std::size_t>(random.below(3));
    part.lo[axis] = part.hi[axis] - random.between(0.0F, 0.01F) * (box.hi[axis] - box.lo[axis]);
    if (i % 4 == 0) part.lo[axis] = part.hi[axis];
    const double rest = gnomon::projected_measure(lamp, part.exact(), RayMeasure::kSolidAngle);
    REQUIRE(gn_box_measure(&m, GN_SEEN_WHOLE, part.lo, part.hi) == Approx(rest).epsilon(1e-4).margin(2e-6));
    thin += rest > 0.01 ? 1 : 0;
  }
  REQUIRE(whole > 500);
  REQUIRE(around > 20);
  REQUIRE(thin > 300);
  // On a face, rays of one half space meet the box; it counts as inside, which is more than they are, never
  // less.
  const Box on_face{{0.5F, -1, -1}, {2, 1, 1}};
  REQUIRE(gn_box_measure(&m, GN_SEEN_WHOLE, on_face.lo, on_face.hi) >= 6.2F);
}

TEST_CASE(
    "what a window of parallel rays leaves of a box is measured in lanes as the reference measures it") {
  Random random(110);
  int cut = 0;
  int parts = 0;
  int aside = 0;
  // Along axes, in their planes, almost so, and aslant; windows wider than high and higher than wide.
  const Vec3d directions[] = {{0, 0, 1},         {-1, 0, 0},        {0, -1, 0}, {1, 1, 0},
                              {0, -0.6, 0.8},    {1, 1e-4, -1e-7},  {1, 1, 1},  {-0.5, 0.3, 0.8},
                              {0.4, -0.8, -0.3}, {-0.2, -0.1, -0.9}};
  for (const Vec3d& direction : directions) {
    for (const double width : {2.0, 6.0}) {
      gnomon::PlaneWindow window;
      window.point = {-30 * direction[0] + 1, -30 * direction[1] - 2, -30 * direction[2] + 0.5};
      window.direction = direction;
      window.half_width = width;
      window.half_height = 12.0 / width;
      window.depth = 100;
      const InfluenceArea area = InfluenceArea::plane(window);
      const GnMeasure m = gnomon::measure_of(area, RayMeasure::kParallel, true);
      for (int i = 0; i < 2500; ++i) {
        Box box = random_box(random, 0.05F, 20.0F);
        if (i % 5 == 0) move_to_side(box, m);
        if (gn_measure_how(&m, box.lo, box.hi) != GN_SEEN_CUT) continue;
        cut += 1;
        // Parts, thin and flat ones too, are measured as it is; they may lie inside the window or beside it.
        Box part = box;
        for (int turn = 0; turn < 3; ++turn) {
          CAPTURE(direction[0], direction[1], direction[2], width, i, turn);
          const double exact = gnomon::culled_measure(area, part.exact(), RayMeasure::kParallel);
          const double across = gnomon::projected_measure(area, part.exact(), RayMeasure::kParallel);
          // The window's sides are where float has them, 30 units away, along all of the box.
          const double length = part.hi[0] - part.lo[0] + part.hi[1] - part.lo[1] + part.hi[2] - part.lo[2];
          REQUIRE(gn_box_measure(&m, GN_SEEN_CUT, part.lo, part.hi) ==
                  Approx(exact).epsilon(1e-5).margin(5e-6 * length));
          parts += turn > 0 && exact > 0.0 && exact < 0.99 * across ? 1 : 0;
          aside += exact == 0.0 ? 1 : 0;
          const auto axis = static_cast<std::size_t>(random.below(3));
          part.lo[axis] = part.hi[axis] - random.between(0.0F, 0.5F) * (part.hi[axis] - part.lo[axis]);
          if (turn == 1 && i % 4 == 0) part.lo[axis] = part.hi[axis];
        }
      }
    }
  }
  REQUIRE(cut > 4000);
  REQUIRE(parts > 4000);
  REQUIRE(aside > 300);
  // A level edge whose ends differ by rounding is above a line between them along no more than its length.
  REQUIRE(gn_areas_above(1.0F, 1.0000002F, 1.0000001F, 2.0F, 1e30F) <= 2.0F * 1.2e-7F);
}
