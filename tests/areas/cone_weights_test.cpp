// Projected areas averaged over cones of directions.
#include "gnomon/areas/cone_weights.h"

#include <catch2/catch.hpp>

#include "area_test_tools.h"
#include "gnomon/areas/solids.h"
#include "gnomon/base/error.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// The mean of |d_axis| over the cap by rings: the mean over a circle about n is elementary only as a sum.
double by_rings(const Vec3d& n, double half_angle, std::size_t axis) {
  const double c = unit_of(n)[axis];
  const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
  double sum = 0.0;
  constexpr int kRings = 1000;
  constexpr int kSteps = 1000;
  for (int r = 0; r < kRings; ++r) {
    // Rings of equal area.
    const double z = 1.0 - (1.0 - std::cos(half_angle)) * (r + 0.5) / kRings;
    const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    for (int k = 0; k < kSteps; ++k)
      sum += std::abs(z * c + radius * s * std::cos(kPiD * (k + 0.5) / kSteps)) / (1.0 * kRings * kSteps);
  }
  return sum;
}

}  // namespace

TEST_CASE("without spread the weights are the direction's, with all directions they are a half") {
  for (const Vec3d& d : direction_classes()) {
    const Vec3d n = unit_of(d);
    const Vec3d none = cone_weights(7.0 * d, 0.0);
    const Vec3d all = cone_weights(d, kPiD);
    for (std::size_t k = 0; k < 3; ++k) {
      CAPTURE(d, k);
      REQUIRE(none[k] == Approx(std::abs(n[k])).margin(1e-15));
      REQUIRE(all[k] == Approx(0.5).epsilon(1e-12));
    }
  }
}

TEST_CASE("half of all directions are a half too, by symmetry") {
  for (const Vec3d& d : direction_classes()) {
    for (const double w : cone_weights(d, kPiD / 2.0)) {
      CAPTURE(d);
      REQUIRE(w == Approx(0.5).epsilon(1e-12));
    }
  }
}

TEST_CASE("weights agree with a fine sum over the cap, where it crosses the plane and where it does not") {
  for (const Vec3d& d : {Vec3d{1, 0, 0}, Vec3d{0.9, 0.5, 0.7}, Vec3d{-0.05, 0.02, 1}, Vec3d{1, -1, 0}}) {
    for (const double degrees : {0.02, 1.0, 10.0, 37.0, 60.0, 89.0, 95.0, 130.0, 175.0}) {
      const Vec3d weights = cone_weights(d, degrees * kDegree);
      for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(d, degrees, k);
        REQUIRE(weights[k] == Approx(by_rings(d, degrees * kDegree, k)).epsilon(1e-4).margin(1e-9));
      }
    }
  }
}

TEST_CASE("weights agree with random directions in the cone") {
  Source source(71);
  for (int i = 0; i < 60; ++i) {
    const Vec3d n = source.direction();
    const double half_angle = source.between(0.0, kPiD);
    const AreaFrame frame = look_along({0, 0, 0}, n, source.direction());
    Vec3d sum{};
    Vec3d squares{};
    constexpr int kSamples = 20000;
    for (int s = 0; s < kSamples; ++s) {
      const double z = 1.0 - (1.0 - std::cos(half_angle)) * source.between(0.0, 1.0);
      const double turn = source.between(0.0, 2.0 * kPiD);
      const double r = std::sqrt(1.0 - z * z);
      const Vec3d d = to_world(frame, {r * std::cos(turn), r * std::sin(turn), z});
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += std::abs(d[k]) / kSamples;
        squares[k] += d[k] * d[k] / kSamples;
      }
    }
    const Vec3d weights = cone_weights(n, half_angle);
    for (std::size_t k = 0; k < 3; ++k) {
      const double sigma = std::sqrt(std::max(0.0, squares[k] - sum[k] * sum[k]) / kSamples);
      CAPTURE(i, n, half_angle, k);
      REQUIRE(std::abs(weights[k] - sum[k]) <= 5.0 * sigma + 1e-12);
    }
  }
}

TEST_CASE("weights are smooth in the angle: the forms for flat, crossing and one-sided caps meet") {
  for (const Vec3d& d : direction_classes()) {
    for (double angle = 1e-6; angle < kPiD; angle *= 1.01) {
      const Vec3d a = cone_weights(d, angle);
      const Vec3d b = cone_weights(d, std::min(angle * (1.0 + 1e-9), kPiD));
      for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(d, angle, k);
        REQUIRE(std::abs(a[k] - b[k]) < 1e-11 + 2e-9 * angle);
        REQUIRE(a[k] >= 0.0);
        REQUIRE(a[k] <= 1.0 + 1e-15);
      }
    }
    for (const double angle : {0.99999999e-4, 1.00000001e-4}) {
      CAPTURE(d, angle);
      // An axis across the cone: a disc's mean distance from its diameter.
      REQUIRE(cone_weights({0, 0, 1}, angle)[0] == Approx(4.0 / (3.0 * kPiD) * angle).epsilon(1e-6));
    }
  }
}

TEST_CASE("weights of a cap on one side are the mean direction's") {
  const Vec3d n = unit_of({1, 2, 3});
  const double half_angle = 10.0 * kDegree;
  const Vec3d weights = cone_weights(n, half_angle);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    REQUIRE(weights[k] == Approx(n[k] * (1.0 + std::cos(half_angle)) / 2.0).epsilon(1e-12));
  }
}

TEST_CASE(
    "the weighted measure of a box is its projected area, and a quarter of its surface for all directions") {
  const Box3d box{{0, 0, 0}, {1, 2, 3}};
  REQUIRE(weighted_measure(cone_weights({0, 0, -5}, 0.0), box) == Approx(2.0));
  REQUIRE(weighted_measure(cone_weights({0, -1, 0}, 0.0), box) == Approx(3.0));
  REQUIRE(weighted_measure(cone_weights({2, 0, 0}, 0.0), box) == Approx(6.0));
  REQUIRE(weighted_measure(cone_weights({2, 0, 0}, kPiD), box) == Approx(22.0 / 4.0));
  REQUIRE(weighted_measure({1, 1, 1}, Box3d{}) == 0.0);
}

TEST_CASE("angles out of range and directions without one are refused") {
  for (const double angle : {-0.1, 3.2, std::nan("")}) {
    CAPTURE(angle);
    REQUIRE_THROWS_AS(cone_weights({0, 0, 1}, angle), Error);
  }
  REQUIRE_THROWS_AS(cone_weights({0, 0, 0}, 0.1), Error);
  REQUIRE_THROWS_AS(cone_weights({0, std::nan(""), 0}, 0.1), Error);
}
