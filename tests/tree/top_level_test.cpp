// The structures that look areas up: none loses an area, and all choose the same one.
#include "gnomon/tree/top_level.h"

#include <catch2/catch.hpp>
#include <set>

#include "gnomon/areas/shared_area.h"
#include "gnomon/shared/area_math.h"
#include "support/area_shapes.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// The thesis' benchmark areas: half plane, half point, places in [2, 6]^3.
std::vector<InfluenceArea> random_areas(std::uint32_t count, std::uint64_t seed) {
  Source source(seed);
  std::vector<InfluenceArea> areas;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      PlaneWindow window;
      window.point = source.point(2.0, 6.0);
      window.direction = source.direction();
      window.half_width = source.between(1.0, 5.0);
      window.half_height = source.between(1.0, 5.0);
      window.depth = source.between(2.0, 10.0);
      areas.push_back(InfluenceArea::plane(window));
    } else {
      PointView view;
      view.eye = source.point(2.0, 6.0);
      view.direction = source.direction();
      view.fov_x = source.between(20.0, 100.0) * kDegree;
      view.fov_y = source.between(20.0, 100.0) * kDegree;
      view.near_distance = source.between(1.0, 2.0);
      view.far_distance = view.near_distance + source.between(2.0, 10.0);
      areas.push_back(InfluenceArea::point(view));
    }
  }
  return areas;
}

std::vector<GnArea> shared_of(const std::vector<InfluenceArea>& areas, double tolerance = 0.01) {
  std::vector<GnArea> shared;
  for (const InfluenceArea& area : areas) shared.push_back(to_shared(area, tolerance));
  return shared;
}

std::vector<TopLevel> all_structures(const std::vector<InfluenceArea>& areas) {
  std::vector<TopLevel> all;
  for (const AreaLookup lookup : {AreaLookup::kList, AreaLookup::kBvh})
    all.push_back(build_top_level(areas, lookup));
  for (const std::uint32_t level : {0U, 1U, 4U, 5U})
    all.push_back(build_top_level(areas, AreaLookup::kOctree, {level, false}));
  return all;
}

std::array<float, 3> to_float(const Vec3d& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

// Areas that touch, share faces, lie in one another, or are the same one twice.
std::vector<InfluenceArea> neighbours() {
  std::vector<InfluenceArea> areas;
  for (const double z : {0.0, 1.0, 2.0, 1.0}) {
    PlaneWindow window;
    window.point = {0, 0, z};
    areas.push_back(InfluenceArea::plane(window));
  }
  areas.push_back(InfluenceArea::omni({0, 0, 1.5}, 0.25));
  areas.push_back(InfluenceArea::omni({0, 0, 1.5}, 4.0));
  areas.push_back(InfluenceArea::omni({100, 0, 0}, 1.0));
  return areas;
}

}  // namespace

TEST_CASE("no structure loses an area that holds a point, and list and tree offer only boxes around it") {
  Source source(101);
  std::size_t held = 0;
  for (const std::vector<InfluenceArea>& areas : {random_areas(40, 102), random_areas(7, 103), neighbours(),
                                                  std::vector{InfluenceArea::omni({1, 2, 3}, 2)}}) {
    const std::vector<TopLevel> structures = all_structures(areas);
    for (int i = 0; i < 25000; ++i) {
      const InfluenceArea& near = areas[static_cast<std::size_t>(i) % areas.size()];
      const auto p = to_float(i % 3 == 0 ? source.point(-4.0, 12.0) : start_near(near, source));
      const Vec3d exact{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
      std::vector<std::uint32_t> holding;
      std::vector<std::uint32_t> boxed;
      for (std::uint32_t a = 0; a < areas.size(); ++a) {
        if (areas[a].contains(exact)) holding.push_back(a);
        const FloatBox box = float_box_around(areas[a].enclosing_box());
        if (gn_box_has(box.lo.data(), box.hi.data(), p.data()) != 0) boxed.push_back(a);
      }
      held += holding.size();
      for (const TopLevel& top : structures) {
        const std::vector<std::uint32_t> found = candidates(top, p.data());
        CAPTURE(i, p, to_string(top.lookup), top.cells.size());
        REQUIRE(std::includes(found.begin(), found.end(), holding.begin(), holding.end()));
        if (top.lookup != AreaLookup::kOctree) REQUIRE(found == boxed);
      }
    }
  }
  REQUIRE(held > 50000);
}

TEST_CASE("an octree's cells name no area twice and none that does not meet them; deeper ones name fewer") {
  const std::vector<InfluenceArea> areas = random_areas(20, 104);
  Source source(105);
  double before = 1e9;
  for (const std::uint32_t level : {0U, 2U, 4U, 6U}) {
    const TopLevel top = build_top_level(areas, AreaLookup::kOctree, {level, false});
    double offered = 0.0;
    Source points(106);
    for (int i = 0; i < 4000; ++i) {
      const auto p = to_float(points.point(-2.0, 10.0));
      const std::vector<std::uint32_t> found = candidates(top, p.data());
      REQUIRE(std::adjacent_find(found.begin(), found.end()) == found.end());
      offered += static_cast<double>(found.size());
    }
    REQUIRE(offered < before);
    before = offered;
  }
}

TEST_CASE("inside a region an octree is not divided: whole cells are kept") {
  // One ball around the origin: at level L only cells at its surface are divided, 4 to 5 times as many a
  // level.
  const std::vector<InfluenceArea> ball{InfluenceArea::omni({0, 0, 0}, 1.0)};
  PointView view;  // the published test never kept a cell of a frustum
  const std::vector<InfluenceArea> frustum{InfluenceArea::point(view)};
  for (const auto& areas : {ball, frustum}) {
    const auto cells_at = [&](std::uint32_t level) {
      return static_cast<double>(build_top_level(areas, AreaLookup::kOctree, {level, false}).cells.size());
    };
    REQUIRE(cells_at(6) < 5.5 * cells_at(5));
    REQUIRE(cells_at(5) < 5.5 * cells_at(4));
  }
}

TEST_CASE("a conservative octree names only areas that hold the point") {
  const std::vector<InfluenceArea> areas = random_areas(20, 107);
  const TopLevel top = build_top_level(areas, AreaLookup::kOctree, {5, true});
  const TopLevel all = build_top_level(areas, AreaLookup::kOctree, {5, false});
  Source source(108);
  std::size_t named = 0;
  std::size_t lost = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto p = to_float(source.point(0.0, 8.0));
    const Vec3d exact{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    const std::vector<std::uint32_t> found = candidates(top, p.data());
    for (const std::uint32_t area : found) REQUIRE(areas[area].contains(exact));
    named += found.size();
    lost += candidates(all, p.data()).size() - found.size();
  }
  REQUIRE(named > 10000);
  REQUIRE(lost > 1000);
}

TEST_CASE("every structure chooses the same area: the lowest that has the start and is meant for the ray") {
  Source source(109);
  std::size_t chosen = 0;
  for (const std::vector<InfluenceArea>& areas : {random_areas(40, 110), neighbours()}) {
    const std::vector<GnArea> shared = shared_of(areas, 0.2);
    const std::vector<TopLevel> structures = all_structures(areas);
    for (int i = 0; i < 8000; ++i) {
      const GnRay r = ray_near(areas[static_cast<std::size_t>(i) % areas.size()], source);
      const GnRayStart start = gn_ray_start(&r);
      for (const std::uint32_t from : {0U, 3U}) {
        std::uint32_t expected = GN_NONE;
        for (std::uint32_t a = from; a < shared.size() && expected == GN_NONE; ++a) {
          if (gn_area_contains(&shared[a], &start) != 0 && gn_area_is_affine(&shared[a], &start) != 0)
            expected = a;
        }
        for (const TopLevel& top : structures) {
          CAPTURE(i, from, to_string(top.lookup));
          REQUIRE(choose_area(top, shared, r, from).area == expected);
        }
        chosen += expected != GN_NONE ? 1 : 0;
      }
    }
  }
  REQUIRE(chosen > 2000);
}

TEST_CASE("without areas nothing is found, and what cannot be built is refused") {
  const float p[3] = {0, 0, 0};
  for (const AreaLookup lookup : {AreaLookup::kList, AreaLookup::kBvh, AreaLookup::kOctree}) {
    const TopLevel none = build_top_level({}, lookup);
    REQUIRE(candidates(none, p).empty());
    REQUIRE(choose_area(none, {}, ray({0, 0, 0}, {0, 0, 1})).area == GN_NONE);
    REQUIRE(none.bytes() == 0);
    const std::vector<InfluenceArea> far_off{InfluenceArea::omni({0, 0, 0}, 1e30)};
    REQUIRE_THROWS_WITH(build_top_level(far_off, lookup), Catch::Contains("2^48"));
  }
  REQUIRE_THROWS_WITH(build_top_level(neighbours(), AreaLookup::kOctree, {10, false}),
                      Catch::Contains("0..9"));
  const TopLevel top = build_top_level(neighbours(), AreaLookup::kBvh);
  REQUIRE(top.bytes() == (2 * 7 - 1) * sizeof(GnAreaBox));
  const float nan_point[3] = {0, std::nanf(""), 0};
  for (const TopLevel& some : all_structures(neighbours())) REQUIRE(candidates(some, nan_point).empty());
}
