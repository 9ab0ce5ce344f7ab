// The thesis' builders as options, and the triangles that its octree gave them.
#include "gnomon/measure/published_builder.h"

#include <catch2/catch.hpp>

#include "gnomon/areas/measure.h"
#include "gnomon/areas/projection.h"
#include "gnomon/measure/area_measure.h"
#include "gnomon/tree/build_reference.h"
#include "support/shapes.h"

using gnomon::AreaKind;
using gnomon::InfluenceArea;
using gnomon::PublishedVariant;
using gnomon::RayMeasure;
using gnomon::test::triangle;

namespace {

// Its region is the box [-4, 4] x [-2, 2] x [0, 16].
InfluenceArea box_area() {
  gnomon::PlaneWindow window;
  window.point = {0, 0, 0};
  window.direction = {0, 0, 1};
  window.half_width = 4;
  window.half_height = 2;
  window.depth = 16;
  return InfluenceArea::plane(window);
}

// A square pyramid along z from 1 to 9, as wide as it is far away on each side.
InfluenceArea pyramid() {
  gnomon::PointView view;
  view.eye = {0, 0, 0};
  view.direction = {0, 0, 1};
  view.fov_x = 3.14159265358979323846 / 2;
  view.fov_y = view.fov_x;
  view.near_distance = 2;
  view.far_distance = 9;
  return InfluenceArea::point(view);
}

// Its first corner alone may be a member.
GnTriangle corner_at(std::array<float, 3> p) {
  return triangle(p, {100, 100, 100}, {100, 101, 100});
}

bool is_member(const InfluenceArea& area, const GnTriangle& t) {
  return gnomon::published_members(area, std::vector<GnTriangle>{t}).size() == 1;
}

}  // namespace

TEST_CASE("a triangle belongs to a published tree by any corner in the octree's root, give or take 0.01") {
  const InfluenceArea area = box_area();
  REQUIRE(is_member(area, corner_at({0, 0, 8})));
  REQUIRE(is_member(area, triangle({100, 100, 100}, {0, 0, 8}, {100, 101, 100})));
  REQUIRE(is_member(area, triangle({100, 100, 100}, {100, 101, 100}, {0, 0, 8})));
  // Across the whole area, but no corner in it.
  REQUIRE_FALSE(is_member(area, triangle({-50, -50, 8}, {50, -50, 8}, {0, 90, 8})));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<float, 3> lo{-4, -2, 0};
    const std::array<float, 3> hi{4, 2, 16};
    for (const float outside : {0.0F, 0.009F, 0.011F}) {
      CAPTURE(axis, outside);
      std::array<float, 3> below{0, 0, 8};
      std::array<float, 3> above{0, 0, 8};
      below[axis] = lo[axis] - outside;
      above[axis] = hi[axis] + outside;
      REQUIRE(is_member(area, corner_at(below)) == (outside < 0.01F));
      REQUIRE(is_member(area, corner_at(above)) == (outside < 0.01F));
    }
  }
}

TEST_CASE("beside a pyramid the octree's cells decide: a 32nd of its box") {
  const InfluenceArea area = pyramid();
  const std::vector<GnTriangle> triangles = {
      corner_at({0, 0, 5}),            // inside
      corner_at({100, 0, 5}),          // outside the box
      corner_at({4.2F, 0, 3.6F}),      // in a cell that misses it, though one of twice the size would not
      corner_at({3.2F, 0.1F, 3.15F}),  // outside, in a cell that meets the pyramid
      corner_at({8, 0, 2.1F}),         // in a corner of the box that the pyramid leaves empty
  };
  REQUIRE(gnomon::published_members(area, triangles) == std::vector<std::uint32_t>{0, 3});
}

TEST_CASE("published variants are named for what they really were") {
  using gnomon::heuristics_of;
  for (const AreaKind kind : {AreaKind::kPlane, AreaKind::kPoint}) {
    REQUIRE(heuristics_of(PublishedVariant::kFull, kind) == "PAH+SPFH@0.4");
    REQUIRE(heuristics_of(PublishedVariant::kFacing, kind) == "SAH+SPFH@0.4");
    REQUIRE(heuristics_of(PublishedVariant::kStandard, kind) == "SAH+LSPH@0.99");
    REQUIRE(heuristics_of(PublishedVariant::kTrueLongest, kind) == "PAH+LSPH@0.99");
  }
  REQUIRE(heuristics_of(PublishedVariant::kLongest, AreaKind::kPlane) == "PAH+LSPH@0.99");
  REQUIRE(heuristics_of(PublishedVariant::kLongest, AreaKind::kPoint) == "SAH+SPFH@0.99");
}

TEST_CASE("the options of a variant are those that its name says") {
  for (const InfluenceArea& area : {box_area(), pyramid()}) {
    const bool point = area.kind() == AreaKind::kPoint;
    for (const PublishedVariant variant :
         {PublishedVariant::kFull, PublishedVariant::kFacing, PublishedVariant::kStandard,
          PublishedVariant::kLongest, PublishedVariant::kTrueLongest}) {
      const std::string name(gnomon::heuristics_of(variant, area.kind()));
      CAPTURE(name, point);
      const auto options = gnomon::published_options(variant, area);
      const bool pah = name.starts_with("PAH");
      const bool spfh = name.find("SPFH") != std::string::npos;
      REQUIRE(options.axes == (spfh ? gnomon::AxisPolicy::kSpfh : gnomon::AxisPolicy::kLsph));
      REQUIRE(options.policy.quality_threshold == (name.ends_with("@0.4") ? 0.4F : 0.99F));
      REQUIRE(options.policy.acceptable == 1.3F);
      REQUIRE(options.policy.excellent == 0.9F);
      REQUIRE_FALSE(options.policy.repaired);
      REQUIRE(options.published_leaves.on);
      REQUIRE(options.published_leaves.min_split == 2);
      REQUIRE(options.bins == 40);
      REQUIRE(options.cost_traversal == 2.0F);
      REQUIRE(options.cost_triangle == 1.2F);
      if (pah) {
        REQUIRE(options.measure.kind == (point ? GN_MEASURE_NEAR_PLANE : GN_MEASURE_WINDOW));
        REQUIRE(options.measure.culled == 1);
        REQUIRE(options.measure.breaks_ties == 0);
      } else {
        REQUIRE(options.measure.kind == gnomon::surface_area_measure().kind);
        REQUIRE(options.measure.area_share == 0.0F);
        REQUIRE(options.policy.rays_from_point == point);
      }
      REQUIRE(options.measure.forward[2] == 1.0F);  // SPFH asks it
    }
  }
  const auto global = gnomon::published_global_options();
  REQUIRE(global.axes == gnomon::AxisPolicy::kLsph);
  REQUIRE(global.policy.quality_threshold == 0.4F);
  REQUIRE(global.measure.area_share == 0.0F);
  REQUIRE_FALSE(global.policy.repaired);
  REQUIRE_THROWS_AS(gnomon::published_options(PublishedVariant::kFull, InfluenceArea::omni({0, 0, 0}, 1)),
                    gnomon::Error);
}

TEST_CASE("an area's measure is relative to its whole window") {
  // The window of the box area is 8 by 4; that of the pyramid 2 by 2 at distance 1, whatever its near plane.
  REQUIRE(gnomon::area_measure(box_area(), RayMeasure::kParallel).area_scale == Approx(1.0 / 32));
  REQUIRE(gnomon::area_measure(pyramid(), RayMeasure::kNearPlane).area_scale == Approx(1.0 / 4));
  REQUIRE(gnomon::area_measure(pyramid(), RayMeasure::kSolidAngle).area_scale ==
          Approx(1.0 / gnomon::window_measure(pyramid(), RayMeasure::kSolidAngle)));
  REQUIRE_THROWS_AS(gnomon::area_measure(box_area(), RayMeasure::kSolidAngle), gnomon::Error);
}

TEST_CASE("the builder tells how it found its splits") {
  const auto triangles = gnomon::test::soup(300, 211);
  gnomon::SplitTally tally;
  auto options = gnomon::published_options(PublishedVariant::kFacing, box_area());
  const auto tree = gnomon::build_reference(triangles, options, &tally);
  REQUIRE(tally.inner_nodes == (tree.nodes.size() - 1) / 2);
  REQUIRE(tally.split_on[0] + tally.split_on[1] + tally.split_on[2] == tally.inner_nodes);
  // Rays along z cross x and y not at all (quality 1) and z wholly (quality 0): z is never an axis of its
  // own, and to reach the fallback two axes must have been tried.
  const auto fallbacks = tally.fallback_on[0] + tally.fallback_on[1] + tally.fallback_on[2];
  REQUIRE(fallbacks > 0);
  REQUIRE(tally.split_on[2] <= tally.fallback_on[2]);
  REQUIRE(tally.axes_tried >= tally.inner_nodes + 2 * fallbacks);
  REQUIRE(tally.axes_tried <= 3 * tally.inner_nodes + 3);
  // Counted beside the building, never part of it.
  REQUIRE(gnomon::tree_hash(tree) == gnomon::tree_hash(gnomon::build_reference(triangles, options)));
  // With no quality asked there is nothing to fall back from; over all axes three are tried.
  gnomon::SplitTally lax;
  options.policy.quality_threshold = 0.0F;
  static_cast<void>(gnomon::build_reference(triangles, options, &lax));
  REQUIRE(lax.fallback_on == std::array<std::uint64_t, 3>{});
  gnomon::SplitTally all;
  gnomon::BuildOptions three;
  three.max_leaf_size = 1;
  static_cast<void>(gnomon::build_reference(triangles, three, &all));
  REQUIRE(all.axes_tried == 3 * all.inner_nodes);
}
