// The thesis' cost, what measures predict of it, and how siblings overlap: by hand, and against one another.
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "gnomon/areas/area_rays.h"
#include "gnomon/measure/all_pierced.h"
#include "gnomon/measure/overlap.h"
#include "gnomon/measure/prediction.h"
#include "gnomon/tree/build_reference.h"
#include "support/shapes.h"

using gnomon::Bvh;
using gnomon::InfluenceArea;
using gnomon::RayMeasure;

namespace {

GnNode node(std::array<float, 3> lo, std::array<float, 3> hi, std::uint32_t first, std::uint32_t count) {
  GnNode n{};
  std::copy(lo.begin(), lo.end(), n.lo);
  std::copy(hi.begin(), hi.end(), n.hi);
  n.first = first;
  n.count = count;
  return n;
}

// A root over two leaves, side by side along x: two triangles on the left, three on the right.
Bvh two_leaves() {
  return {
      {node({0, 0, 0}, {4, 1, 1}, 1, 0), node({0, 0, 0}, {1, 1, 1}, 0, 2), node({2, 0, 0}, {4, 1, 1}, 2, 3)},
      {0, 1, 2, 3, 4}};
}

InfluenceArea window_over(double half_width, double half_height) {
  gnomon::PlaneWindow window;
  window.point = {2, 0.5, -1};
  window.direction = {0, 0, 1};
  window.half_width = half_width;
  window.half_height = half_height;
  window.depth = 10;
  return InfluenceArea::plane(window);
}

}  // namespace

TEST_CASE("a ray pays for the nodes it pierces, whatever it hits") {
  const Bvh bvh = two_leaves();
  const auto cost = [&](gnomon::Vec3d origin, gnomon::Vec3d direction) {
    return gnomon::all_pierced_cost(bvh, {origin, direction});
  };
  REQUIRE(cost({0.5, 0.5, -1}, {0, 0, 1}) == Approx(2.0 + 2 * 1.2));
  REQUIRE(cost({3.0, 0.5, -1}, {0, 0, 1}) == Approx(2.0 + 3 * 1.2));
  REQUIRE(cost({1.5, 0.5, -1}, {0, 0, 1}) == Approx(2.0));  // the gap between them
  REQUIRE(cost({-1, 0.5, 0.5}, {1, 0, 0}) == Approx(2.0 + 5 * 1.2));
  REQUIRE(cost({0.5, 2.5, -1}, {0, 0, 1}) == 0.0);
  REQUIRE(cost({0.5, 0.5, -1}, {0, 0, -1}) == 0.0);  // it looks away
  REQUIRE(gnomon::all_pierced_cost({}, {{0, 0, 0}, {0, 0, 1}}) == 0.0);
}

TEST_CASE("the mean and its standard error are those of a sample") {
  const std::vector<double> values = {1, 2, 3, 4};
  const auto mean = gnomon::mean_of(values);
  REQUIRE(mean.mean == Approx(2.5));
  REQUIRE(mean.standard_error == Approx(std::sqrt(5.0 / 3.0) / 2.0));
  REQUIRE(gnomon::mean_of({}).mean == 0.0);
  REQUIRE(gnomon::mean_of(std::vector<double>{7}).mean == 7.0);
  REQUIRE(gnomon::mean_of(std::vector<double>{7}).standard_error == 0.0);
}

TEST_CASE("predictions by hand: shares of the window, and surfaces over the root's") {
  const Bvh bvh = two_leaves();
  // A window of 8 by 2 before them: boxes cover 4, 1 and 2 of 16.
  REQUIRE(gnomon::predicted_cost(bvh, window_over(4, 1), RayMeasure::kParallel) ==
          Approx(4.0 / 16 * 2.0 + 1.0 / 16 * 2.4 + 2.0 / 16 * 3.6));
  REQUIRE(gnomon::predicted_surface_cost(bvh) == Approx(2.0 + 6.0 / 18 * 2.4 + 10.0 / 18 * 3.6));
  REQUIRE(gnomon::prediction_error(11.0, 10.0) == Approx(0.1));
  REQUIRE(gnomon::prediction_error(0.0, 0.0) == 0.0);
  REQUIRE(gnomon::prediction_error(9.0, 10.0) == Approx(0.1));
  REQUIRE(std::isinf(gnomon::prediction_error(1.0, 0.0)));
  // A child larger than its root, which no builder makes, is met by every ray at most; and a root that is a
  // point is met always.
  Bvh odd = bvh;
  odd.nodes[1].hi[0] = 40;
  REQUIRE(gnomon::predicted_surface_cost(odd) == Approx(2.0 + 2.4 + 10.0 / 18 * 3.6));
  const Bvh dot{{node({1, 1, 1}, {1, 1, 1}, 0, 2)}, {0, 1}};
  REQUIRE(gnomon::predicted_surface_cost(dot) == Approx(2.4));
  REQUIRE(gnomon::predicted_surface_cost({}) == 0.0);
}

TEST_CASE("a prediction is the mean cost of rays drawn by the same measure, within its error bar") {
  const auto triangles = gnomon::test::soup(400, 111);
  const Bvh bvh = gnomon::build_reference(triangles);
  gnomon::PlaneWindow window;
  window.point = {5, 5, -3};
  window.direction = {0.2, -0.1, 1};
  window.half_width = 3;
  window.half_height = 4;
  window.depth = 20;
  gnomon::PointView view;
  view.eye = {5, 4, -6};
  view.direction = {0.1, 0, 1};
  view.fov_x = 1.2;
  view.fov_y = 0.9;
  view.far_distance = 30;
  const InfluenceArea plane = InfluenceArea::plane(window);
  const InfluenceArea point = InfluenceArea::point(view);
  for (const RayMeasure measure :
       {RayMeasure::kParallel, RayMeasure::kSolidAngle, RayMeasure::kNearPlane, RayMeasure::kYawPitch}) {
    const InfluenceArea& area = measure == RayMeasure::kParallel ? plane : point;
    CAPTURE(gnomon::to_string(measure));
    const auto rays = gnomon::area_rays(area, measure, 20000, 112);
    const auto mean = gnomon::mean_of(gnomon::all_pierced_costs(bvh, rays));
    const double predicted = gnomon::predicted_cost(bvh, area, measure);
    REQUIRE(predicted > 5.0);
    REQUIRE(std::fabs(mean.mean - predicted) <= 4.5 * mean.standard_error);
    // Surface area is off by far more for parallel rays: the check above is not vacuous.
    const double by_surface = std::fabs(mean.mean - gnomon::predicted_surface_cost(bvh));
    if (measure == RayMeasure::kParallel) REQUIRE(by_surface > 10 * mean.standard_error);
  }
}

TEST_CASE("siblings side by side do not overlap, one behind the other they do, all of it") {
  REQUIRE(gnomon::sibling_overlap(two_leaves(), window_over(4, 1), RayMeasure::kParallel) ==
          Approx(0.0).margin(1e-12));
  const Bvh stacked{
      {node({0, 0, 0}, {1, 1, 3}, 1, 0), node({0, 0, 0}, {1, 1, 1}, 0, 1), node({0, 0, 2}, {1, 1, 3}, 1, 1)},
      {0, 1}};
  REQUIRE(gnomon::sibling_overlap(stacked, window_over(4, 1), RayMeasure::kParallel) == Approx(1.0));
}

TEST_CASE("overlaps of levels are summed before they are divided, and what the window cuts off is not seen") {
  // Level 1: children of areas 2 and 3 that share 1. Level 2, under the left: halves that share nothing.
  const Bvh tree{
      {node({0, 0, 0}, {4, 1, 1}, 1, 0), node({0, 0, 0}, {2, 1, 1}, 3, 0), node({1, 0, 0}, {4, 1, 1}, 0, 1),
       node({0, 0, 0}, {1, 1, 1}, 1, 1), node({1, 0, 0}, {2, 1, 1}, 2, 1)},
      {0, 1, 2}};
  const auto overlap = [&](double half_width, std::uint32_t levels) {
    return gnomon::sibling_overlap(tree, window_over(half_width, 1), RayMeasure::kParallel, levels);
  };
  REQUIRE(overlap(4, 0) == 0.0);
  REQUIRE(overlap(4, 1) == Approx(1.0 / 2));
  REQUIRE(overlap(4, 2) == Approx(1.0 / (2 + 1)));
  REQUIRE(overlap(4, gnomon::kAllLevels) == Approx(1.0 / 3));
  // The same where it is the right child that divides again.
  Bvh mirrored = tree;
  std::swap(mirrored.nodes[1], mirrored.nodes[2]);
  REQUIRE(gnomon::sibling_overlap(mirrored, window_over(4, 1), RayMeasure::kParallel, 1) == Approx(1.0 / 2));
  REQUIRE(gnomon::sibling_overlap(mirrored, window_over(4, 1), RayMeasure::kParallel, 2) == Approx(1.0 / 3));
  // A window from x = 1.5 to 2.5: half of what they share is seen, and the smaller is all shared.
  REQUIRE(overlap(0.5, 1) == Approx(1.0));
  REQUIRE(gnomon::sibling_overlap({}, window_over(4, 1), RayMeasure::kParallel) == 0.0);
}
