// The measures builders minimise, in float and without division, against the double-precision reference.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/areas/cone_weights.h"
#include "gnomon/areas/measure.h"
#include "gnomon/areas/projection.h"
#include "gnomon/shared/measure_math.h"
#include "measured_boxes.h"

using gnomon::Box3d;
using gnomon::InfluenceArea;
using gnomon::RayMeasure;
using gnomon::Vec3d;
using gnomon::test::Box;
using gnomon::test::Random;
using gnomon::test::random_box;

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Case {
  std::string name;
  InfluenceArea area;
  RayMeasure measure;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const Vec3d& direction : {Vec3d{0, 0, 1}, Vec3d{1, 1, 1}, Vec3d{0, -1, 0}, Vec3d{-0.5, 0.3, 0.8}}) {
    gnomon::PlaneWindow window;
    window.point = {-3 * direction[0], -3 * direction[1], -3 * direction[2]};
    window.direction = direction;
    window.half_width = 5;
    window.half_height = 3;
    window.depth = 40;
    out.push_back({"window", InfluenceArea::plane(window), RayMeasure::kParallel});
    for (const auto& [x, y] :
         {std::pair{90.0, 60.0}, std::pair{130.0, 45.0}, std::pair{5.0, 5.0}, std::pair{160.0, 150.0}}) {
      gnomon::PointView view;
      view.eye = {0.5, -0.25, 0.125};
      view.direction = direction;
      view.fov_x = x * kPi / 180;
      view.fov_y = y * kPi / 180;
      view.near_distance = 0.5;
      view.far_distance = 100;
      for (const RayMeasure measure :
           {RayMeasure::kSolidAngle, RayMeasure::kNearPlane, RayMeasure::kYawPitch}) {
        out.push_back({std::string(gnomon::to_string(measure)) + " " + std::to_string(x),
                       InfluenceArea::point(view), measure});
      }
    }
  }
  return out;
}

// The reference in the float code's unit: near-plane areas at distance 1.
double unit_of(const Case& c) {
  if (c.measure != RayMeasure::kNearPlane) return 1.0;
  const double near = std::get<gnomon::Frustum>(c.area.region()).near_distance;
  return 1.0 / (near * near);
}

}  // namespace

TEST_CASE("elementary functions are right within a few ulp and scale by powers of two") {
  Random random(101);
  for (int i = 0; i < 100000; ++i) {
    const float x = std::ldexp(random.between(1, 2), static_cast<int>(random.below(120)) - 60);
    CAPTURE(x);
    REQUIRE(gn_reciprocal_root(x) * std::sqrt(static_cast<double>(x)) == Approx(1.0).epsilon(3e-7));
    REQUIRE(gn_rough_reciprocal_root(x) * std::sqrt(static_cast<double>(x)) == Approx(1.0).epsilon(5e-6));
    REQUIRE(gn_root(x) == Approx(std::sqrt(static_cast<double>(x))).epsilon(3e-7));
    REQUIRE(gn_reciprocal_root(x * 4.0F) == 0.5F * gn_reciprocal_root(x));
    REQUIRE(x * gn_power_near_reciprocal(x) >= 1.0F);
    REQUIRE(x * gn_power_near_reciprocal(x) < 2.0F);
    const float y = random.between(0, 4) * x;
    const float signed_x = random.below(2) == 0 ? x : -x;
    REQUIRE(gn_angle_of(y, signed_x) ==
            Approx(std::atan2(static_cast<double>(y), static_cast<double>(signed_x))).epsilon(6e-7));
  }
  REQUIRE(gn_angle_of(0.0F, 0.0F) == 0.0F);
  REQUIRE(gn_angle_of(0.0F, -1.0F) == Approx(kPi));
  REQUIRE(gn_root(0.0F) == 0.0F);
}

TEST_CASE(
    "precise measures are the reference's, culled, for boxes anywhere: around, behind and across "
    "everything") {
  Random random(102);
  int partly = 0;
  for (const Case& c : cases()) {
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    const double whole = gnomon::window_measure(c.area, c.measure) * unit_of(c);
    for (int i = 0; i < 300; ++i) {
      const Box box = random_box(random, 0.05F, 30.0F);
      CAPTURE(c.name, i, box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1], box.hi[2]);
      const double exact = gnomon::culled_measure(c.area, box.exact(), c.measure) * unit_of(c);
      const double got = gn_box_measure(&m, 1, box.lo, box.hi);
      // Yaw and pitch: sides are curves, taken in sixteen steps.
      const bool curved = c.measure == RayMeasure::kYawPitch;
      REQUIRE(std::fabs(got - exact) <= (curved ? 1e-2 : 1e-4) * exact + (curved ? 5e-4 : 2e-5) * whole);
      partly += exact > 0.01 * whole && exact < 0.99 * whole ? 1 : 0;
    }
  }
  REQUIRE(partly > 1000);
}

TEST_CASE("a box around everything measures the whole window, the eye inside or not") {
  const Box all{{-500, -500, -500}, {500, 500, 500}};
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    const double whole = gnomon::window_measure(c.area, c.measure) * unit_of(c);
    REQUIRE(gn_measure_how(&m, all.lo, all.hi) == 1);
    REQUIRE(gn_box_measure(&m, 1, all.lo, all.hi) ==
            Approx(whole).epsilon(c.measure == RayMeasure::kYawPitch ? 1e-2 : 1e-4));
  }
  const GnMeasure lamp =
      gnomon::measure_of(InfluenceArea::omni({1, 2, 3}, 50), RayMeasure::kSolidAngle, false);
  REQUIRE(gn_box_measure(&lamp, 1, all.lo, all.hi) == Approx(4 * kPi).epsilon(1e-5));
}

TEST_CASE("where one step or a few are allowed they are within one per cent of the reference") {
  Random random(103);
  int one = 0;
  int few = 0;
  for (const Case& c : cases()) {
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    for (int i = 0; i < 1000; ++i) {
      const Box box = random_box(random, 0.02F, 6.0F);
      const int how = gn_measure_how(&m, box.lo, box.hi);
      if (how != GN_SEEN_ONE_STEP && how != GN_SEEN_FEW_STEPS) continue;
      CAPTURE(c.name, i, how);
      const double exact = gnomon::culled_measure(c.area, box.exact(), c.measure) * unit_of(c);
      REQUIRE(gn_box_measure(&m, how, box.lo, box.hi) == Approx(exact).epsilon(0.01));
      (how == GN_SEEN_ONE_STEP ? one : few) += 1;
      // Parts of the box, thin ones too, are measured as it is.
      Box part = box;
      const auto axis = static_cast<std::size_t>(random.below(3));
      part.lo[axis] = box.lo[axis] + random.between(0.0F, 0.99F) * (box.hi[axis] - box.lo[axis]);
      const double rest = gnomon::culled_measure(c.area, part.exact(), c.measure) * unit_of(c);
      REQUIRE(gn_box_measure(&m, how, part.lo, part.hi) == Approx(rest).epsilon(0.01));
    }
  }
  REQUIRE(one > 1000);
  REQUIRE(few > 1000);
}

TEST_CASE("a few steps are at least ten times as near as one, and are taken only where they are") {
  Random random(107);
  for (const Case& c : cases()) {
    if (c.measure == RayMeasure::kParallel) continue;
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    double worst_one = 0.0;
    double worst_few = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const Box box = random_box(random, 0.2F, 6.0F);
      if (gn_measure_how(&m, box.lo, box.hi) != GN_SEEN_FEW_STEPS) continue;
      const double exact = gnomon::culled_measure(c.area, box.exact(), c.measure) * unit_of(c);
      const auto error = [&](int how) {
        return std::fabs(gn_box_measure(&m, how, box.lo, box.hi) / exact - 1.0);
      };
      worst_one = std::fmax(worst_one, error(GN_SEEN_ONE_STEP));
      worst_few = std::fmax(worst_few, error(GN_SEEN_FEW_STEPS));
    }
    CAPTURE(c.name, worst_one, worst_few);
    REQUIRE(worst_few * 10.0 <= worst_one);
  }
}

// cos(pitch) is small there, and yaw and pitch grow by one over it.
TEST_CASE("boxes next to the pole measure what the reference says, in yaw and pitch") {
  gnomon::PointView view;
  view.eye = {0.5, -0.25, 0.125};
  view.direction = {0, 0, 1};
  view.fov_x = 175 * kPi / 180;
  view.fov_y = 175 * kPi / 180;
  view.near_distance = 0.125;
  view.far_distance = 100;
  const InfluenceArea area = InfluenceArea::point(view);
  const GnMeasure m = gnomon::measure_of(area, RayMeasure::kYawPitch, true);
  Random random(108);
  int one = 0;
  int few = 0;
  for (int i = 0; i < 400; ++i) {
    // 85 to 86 degrees up or down, the box's size against its distance from the up axis as one step and few
    // allow.
    const double pitch = static_cast<double>(random.between(85.0F, 86.0F)) * kPi / 180;
    const double level = 10.0 / std::tan(pitch);
    const double yaw = static_cast<double>(random.between(-0.8F, 0.8F));
    const double up = i % 2 == 0 ? 10.0 : -10.0;
    const float half_size = static_cast<float>(level) * random.between(0.005F, 0.1F);
    const float centre[3] = {static_cast<float>(view.eye[0] + level * std::sin(yaw)),
                             static_cast<float>(view.eye[1] + up),
                             static_cast<float>(view.eye[2] + level * std::cos(yaw))};
    Box box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = centre[k] - half_size;
      box.hi[k] = centre[k] + half_size;
    }
    const int how = gn_measure_how(&m, box.lo, box.hi);
    if (how != GN_SEEN_ONE_STEP && how != GN_SEEN_FEW_STEPS) continue;
    (how == GN_SEEN_ONE_STEP ? one : few) += 1;
    CAPTURE(i, how, pitch, yaw, half_size);
    const double exact = gnomon::culled_measure(area, box.exact(), RayMeasure::kYawPitch);
    REQUIRE(gn_box_measure(&m, how, box.lo, box.hi) == Approx(exact).epsilon(0.015));
  }
  REQUIRE(one > 30);
  REQUIRE(few > 30);
}

TEST_CASE("unculled measures are the reference's") {
  Random random(104);
  for (const Case& c : cases()) {
    if (c.measure == RayMeasure::kYawPitch) continue;
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, false);
    for (int i = 0; i < 200; ++i) {
      const Box box = random_box(random, 0.05F, 10.0F);
      CAPTURE(c.name, i);
      const double exact = gnomon::projected_measure(c.area, box.exact(), c.measure) * unit_of(c);
      REQUIRE(gn_box_measure(&m, gn_measure_how(&m, box.lo, box.hi), box.lo, box.hi) ==
              Approx(exact).epsilon(0.011).margin(1e-5));
      REQUIRE(gn_box_measure(&m, 1, box.lo, box.hi) == Approx(exact).epsilon(2e-4).margin(1e-5));
    }
  }
}

TEST_CASE("what one step serves, or no ray meets, is not looked at again further down") {
  const GnMeasure m =
      gnomon::measure_of(InfluenceArea::omni({0.5, -0.25, 0.125}, 50), RayMeasure::kSolidAngle, false);
  const Box near{{0, 0, 0}, {1, 1, 1}};
  for (const int before : {GN_SEEN_ONE_STEP, GN_SEEN_NOTHING})
    REQUIRE(gn_measure_how_below(&m, before, near.lo, near.hi) == before);
  for (const int before : {GN_SEEN_PRECISE, GN_SEEN_FEW_STEPS, GN_SEEN_WHOLE})
    REQUIRE(gn_measure_how_below(&m, before, near.lo, near.hi) == GN_SEEN_WHOLE);
}

TEST_CASE("measures scale by powers of two as areas do, bit for bit") {
  Random random(105);
  for (const Case& c : cases()) {
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    for (const int exponent : {-40, 40}) {
      GnMeasure scaled = m;
      for (std::size_t k = 0; k < 3; ++k) scaled.origin[k] = std::ldexp(m.origin[k], exponent);
      scaled.near_distance = std::ldexp(m.near_distance, exponent);
      if (m.kind == GN_MEASURE_WINDOW) {
        scaled.half_width = std::ldexp(m.half_width, exponent);
        scaled.half_height = std::ldexp(m.half_height, exponent);
      }
      for (int i = 0; i < 40; ++i) {
        const Box box = random_box(random, 0.05F, 10.0F);
        Box large = box;
        for (std::size_t k = 0; k < 3; ++k) {
          large.lo[k] = std::ldexp(box.lo[k], exponent);
          large.hi[k] = std::ldexp(box.hi[k], exponent);
        }
        CAPTURE(c.name, exponent, i);
        const int how = gn_measure_how(&m, box.lo, box.hi);
        REQUIRE(gn_measure_how(&scaled, large.lo, large.hi) == how);
        const float got = gn_box_measure(&scaled, how, large.lo, large.hi);
        const float expected = gn_box_measure(&m, how, box.lo, box.hi);
        REQUIRE(got == (m.kind == GN_MEASURE_WINDOW ? std::ldexp(expected, 2 * exponent) : expected));
      }
    }
  }
}

TEST_CASE("a cone's measure has the reference's weights") {
  const GnMeasure m = gnomon::cone_measure({0.3, -0.9, 0.2}, 0.2);
  const Vec3d weights = gnomon::cone_weights({0.3, -0.9, 0.2}, 0.2);
  const Box box{{1, 2, 3}, {2, 5, 7}};
  REQUIRE(gn_box_measure(&m, 0, box.lo, box.hi) ==
          Approx(gnomon::weighted_measure(weights, box.exact())).epsilon(1e-6));
}

TEST_CASE("boxes called out of sight measure nothing, and most that measure nothing are called so") {
  Random random(106);
  int called = 0;
  int nothing = 0;
  for (const Case& c : cases()) {
    const GnMeasure m = gnomon::measure_of(c.area, c.measure, true);
    for (int i = 0; i < 300; ++i) {
      const Box box = random_box(random, 0.05F, 5.0F);
      CAPTURE(c.name, i);
      // The reference's faces cancel to a last bit or so where pitch is clamped all round.
      const bool unseen = gnomon::culled_measure(c.area, box.exact(), c.measure) <=
                          1e-15 * gnomon::window_measure(c.area, c.measure);
      const bool out = gn_measure_how(&m, box.lo, box.hi) == GN_SEEN_NOTHING;
      if (out) REQUIRE(unseen);
      called += out ? 1 : 0;
      nothing += unseen ? 1 : 0;
    }
  }
  REQUIRE(called > 0.8 * nothing);
}
