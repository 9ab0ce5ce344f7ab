// Local trees and a global one against the global one alone: the same answers to the last bit, by every
// lookup, for closest and any hit.
#include <catch2/catch.hpp>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "support/forest_rig.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

// Each area alone, with all it can meet; the outcomes of all.
Tally require_each_alone(const std::vector<GnTriangle>& triangles, const std::vector<InfluenceArea>& areas,
                         double tolerance, std::uint64_t count, const std::vector<GnRay>& more) {
  Tally sum;
  for (const InfluenceArea& area : areas) {
    CAPTURE(static_cast<int>(area.kind()));
    const Rig rig(triangles, local_trees_of({area}, tolerance));
    std::vector<GnRay> rays = all_rays({area}, count, 131);
    append(rays, more);
    const Tally tally = rig.require_same_answers(rays);
    REQUIRE(total(tally) == rays.size());
    for (int k = 0; k < 4; ++k) sum.outcomes[k] += tally.outcomes[k];
  }
  return sum;
}

}  // namespace

// [large]: many scenes and rays for kernels that smaller tests compile and run too; Mesa's device is spared
// it.
TEST_CASE("generated scenes: areas of every kind that span them, shrunk or cut, change no answer",
          "[large]") {
  Tally sum;
  for (const auto& [name, count] : {std::pair{"random100", 100}, {"random1000", 1000}, {"cottage", 7000}}) {
    const Scene scene = generate_scene(name, static_cast<std::uint64_t>(count), 1);
    const Extent extent = extent_of(scene.triangles);
    std::vector<GnRay> more = random_rays(scene, 300, 132);
    append(more, primary_rays(scene, 300, 133));
    for (const double size : {1.0, 0.5}) {
      for (const Vec3d& direction : {Vec3d{0, 0, 1}, Vec3d{-0.55, -0.9, 1}}) {
        CAPTURE(name, size, direction);
        const Tally tally =
            require_each_alone(scene.triangles, areas_of(extent, direction, size), 0.01, 400, more);
        for (int k = 0; k < 4; ++k) sum.outcomes[k] += tally.outcomes[k];
      }
    }
  }
  for (const std::uint64_t outcome : sum.outcomes) REQUIRE(outcome > 500);
}

TEST_CASE("rays of every direction through areas of every shape get the global tree's answers",
          "[portable]") {
  std::vector<GnTriangle> triangles = soup(400, 134, 1.5F, -5.0F);
  // Every triangle twice: of two equally near ones the lower number must win in every tree.
  triangles.insert(triangles.end(), triangles.begin(), triangles.end());
  std::vector<InfluenceArea> areas;
  for (const auto& [name, area] : areas_of_every_kind()) areas.push_back(area);
  const Tally tally =
      Rig(triangles, local_trees_of(areas, 1.0)).require_same_answers(all_rays(areas, 60, 135));
  REQUIRE(tally.outcomes[GN_OUTCOME_LOCAL] > 300);
  REQUIRE(tally.outcomes[GN_OUTCOME_INSIDE] > 300);
  REQUIRE(tally.outcomes[GN_OUTCOME_FALLBACK] > 300);
  const Tally alone =
      require_each_alone(triangles, {areas[0], areas[4], areas[12], areas.back()}, 1.0, 200, {});
  REQUIRE(alone.outcomes[GN_OUTCOME_LOCAL] > 100);
}

namespace {

// Large triangles just outside each face, from 2^-12 to 2^-26 of the region's size away: none belongs to the
// region, and a ray that is followed by as little too far misses the first.
std::vector<GnTriangle> layers_around(const InfluenceArea& area, Source& source) {
  const Box3d box = area.enclosing_box();
  const double size = larger(magnitude(box.lo), magnitude(box.hi));
  std::vector<Plane> faces(area.planes().begin(), area.planes().end());
  const auto* ball = std::get_if<Ball>(&area.region());
  for (int i = 0; ball != nullptr && i < 12; ++i) {
    const Vec3d inwards = source.direction();
    faces.push_back(plane_through(ball->centre - ball->radius * inwards, inwards));
  }
  std::vector<GnTriangle> layers;
  for (const Plane& face : faces) {
    const AreaFrame frame = look_along({0, 0, 0}, face.normal, kWorldUp);
    for (int k = 12; k <= 26; ++k) {
      const Vec3d inside = place_in(area, source.point(-0.5, 0.5));
      const double away = signed_distance(face, inside) + std::exp2(-k) * size;
      const Vec3d centre = inside - away * face.normal;
      GnTriangle t{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        t.v0[axis] = static_cast<float>(centre[axis] - size * (frame.right[axis] + frame.up[axis]));
        t.v1[axis] = static_cast<float>(centre[axis] + size * (2.0 * frame.right[axis] - frame.up[axis]));
        t.v2[axis] = static_cast<float>(centre[axis] + size * (2.0 * frame.up[axis] - frame.right[axis]));
      }
      layers.push_back(t);
    }
  }
  return layers;
}

}  // namespace

TEST_CASE("triangles a rounding outside the faces are found by every ray that leaves through them",
          "[portable]") {
  Source source(152);
  Tally sum;
  for (const auto& [name, area] : areas_of_every_kind({3, -2, 1})) {
    if (name == "plane, class" && source.between(0.0, 1.0) < 0.7) continue;
    CAPTURE(name);
    const std::vector<GnTriangle> triangles = layers_around(area, source);
    for (const double growth : {0.0, 0x1p-16}) {
      CAPTURE(growth);
      std::vector<LocalTree> trees = local_trees_of({area}, 1.0);
      trees[0].growth = growth;
      const Tally tally = Rig(triangles, trees).require_same_answers(all_rays({area}, 200, 153));
      for (int k = 0; k < 4; ++k) sum.outcomes[k] += tally.outcomes[k];
    }
  }
  REQUIRE(sum.outcomes[GN_OUTCOME_FALLBACK] > 1000);
  REQUIRE(sum.outcomes[GN_OUTCOME_LOCAL] > 500);
}

TEST_CASE("overlapping, nested, touching and repeated areas, some outside the scene or empty",
          "[serial][portable]") {
  const std::vector<GnTriangle> triangles = soup(300, 136, 1.0F);
  std::vector<InfluenceArea> areas;
  for (const double z : {0.0, 4.0, 8.0, 4.0}) {  // touch face to face; two are the same
    PlaneWindow window;
    window.point = {5, 5, z};
    window.half_width = 3.0;
    window.half_height = 3.0;
    window.depth = 4.0;
    areas.push_back(InfluenceArea::plane(window));
  }
  areas.push_back(InfluenceArea::omni({5, 5, 5}, 1.0));
  areas.push_back(InfluenceArea::omni({5, 5, 5}, 4.0));
  areas.push_back(InfluenceArea::omni({200, 0, 0}, 5.0));  // no triangle near: a local tree of none
  PlaneWindow outside;
  outside.point = {-90, 0, 0};
  areas.push_back(InfluenceArea::plane(outside));
  const Rig rig(triangles, local_trees_of(areas, 1.0));
  REQUIRE(rig.forest().local[6].root == GN_NONE);
  REQUIRE(rig.forest().local[7].triangle_count == 0);
  std::vector<GnRay> rays = all_rays(areas, 150, 137);
  for (const GnRay& r : random_rays(300, 138)) rays.push_back(r);
  rays.push_back(ray({200, 0, 0}, {-1, 0.02F, 0.02F}));  // out of the empty one into the scene
  rays.push_back(ray({200, 0, 0}, {-1, 0, 0}, 0, 4.0F));
  const Tally tally = rig.require_same_answers(rays);
  for (const std::uint64_t outcome : tally.outcomes) REQUIRE(outcome > 50);
}

TEST_CASE("no areas, no triangles, no rays", "[portable][memcheck]") {
  const std::vector<GnTriangle> triangles = soup(40, 139, 2.0F);
  const auto rays = random_rays(60, 140);
  const Tally none = Rig(triangles, {}).require_same_answers(rays);
  REQUIRE(none.outcomes[GN_OUTCOME_GLOBAL] == rays.size());
  const std::vector<LocalTree> trees = local_trees_of({InfluenceArea::omni({5, 5, 5}, 4.0)}, 1.0);
  const Rig empty({}, trees);
  static_cast<void>(empty.require_same_answers(rays));
  REQUIRE(ForestTracer(context(), empty.forest(), empty.tops()[0]).closest({}).hits.empty());
}

TEST_CASE("few rays and triangles, every outcome, in one go and in passes, keep to their buffers",
          "[memcheck]") {
  const std::vector<GnTriangle> triangles = soup(60, 141, 1.5F);
  const std::vector<InfluenceArea> areas = areas_of({{5, 5, 5}, 5.0}, {0.2, 0.1, 1}, 0.6);
  const Rig rig(triangles, local_trees_of(areas, 1.0));
  const std::vector<GnRay> rays = all_rays(areas, 24, 142);
  for (const std::uint32_t step_limit : {0U, 20U})
    static_cast<void>(rig.require_same_answers(rays, step_limit));
}

TEST_CASE("passes of any length give the same answers", "[portable]") {
  const std::vector<GnTriangle> triangles = soup(500, 143, 1.5F);
  const std::vector<InfluenceArea> areas = areas_of({{5, 5, 5}, 5.0}, {0.2, 0.1, 1}, 0.6);
  const Rig rig(triangles, local_trees_of(areas, 1.0));
  const std::vector<GnRay> rays = all_rays(areas, 100, 144);
  const Tally whole = rig.require_same_answers(rays);
  for (const std::uint32_t step_limit : {1U, 20U}) {
    const Tally cut = rig.require_same_answers(rays, step_limit);
    REQUIRE(std::equal(cut.outcomes, cut.outcomes + 4, whole.outcomes));
  }
  const Tally published = rig.by_the_published_rule(rays);
  REQUIRE(published.wrong_hits > 0);
  REQUIRE(rig.by_the_published_rule(rays, 20).wrong_hits == published.wrong_hits);
}

TEST_CASE("a forest says what it holds, and what does not fit together is refused") {
  const std::vector<GnTriangle> triangles = soup(500, 149, 0.5F);
  const std::vector<InfluenceArea> areas = areas_of({{5, 5, 5}, 5.0}, {0, 0, 1}, 0.5);
  std::vector<LocalTree> trees = local_trees_of(areas);
  trees[1].options.max_leaf_size = 1;
  ForestReport report;
  const DeviceForest forest = build_forest(context(), triangles, trees, {}, &report);
  REQUIRE(forest.local.size() == 3);
  REQUIRE(report.members_ms.size() == 3);
  REQUIRE(report.total_ms > report.global_ms);
  REQUIRE(forest.local[1].node_count == 2 * forest.local[1].triangle_count - 1);
  std::uint64_t nodes = forest.global.node_count;
  for (std::size_t i = 0; i < 3; ++i) {
    REQUIRE(forest.local[i].root == nodes);
    REQUIRE(forest.shared_areas[i].root == nodes);
    REQUIRE(forest.local[i].triangle_count == members(forest.areas[i], triangles).size());
    nodes += forest.local[i].node_count;
  }
  REQUIRE(forest.bytes() == forest.triangles.bytes + forest.global.node_count * sizeof(Node) +
                                forest.triangle_count * sizeof(std::uint32_t) + forest.local_bytes());
  const DeviceTopLevel two =
      upload_top_level(context(), build_top_level(std::span(forest.areas).first(2), AreaLookup::kList),
                       std::span(forest.shared_areas).first(2));
  REQUIRE_THROWS_WITH(ForestTracer(context(), forest, two), Catch::Contains("2 areas"));
  trees[0].growth = -1.0;
  REQUIRE_THROWS_WITH(build_forest(context(), triangles, trees), Catch::Contains("growth"));
  const Progress stop = [](std::string_view, double) { return false; };
  REQUIRE_THROWS_AS(build_forest(context(), triangles, local_trees_of(areas), {}, nullptr, stop), Error);
}

TEST_CASE("rays that are not traceable miss and are counted by the forest too", "[portable][memcheck]") {
  const Rig rig(soup(50, 150, 3.0F), local_trees_of({InfluenceArea::omni({5, 5, 5}, 8.0)}, 1.0));
  const float nan = std::nanf("");
  const std::vector<GnRay> rays = {ray({5, 5, 5}, {0, 0, 0}), ray({nan, 5, 5}, {0, 0, 1}),
                                   ray({5, 5, 5}, {0, 0, 1}, nan), ray({5, 5, 5}, {0, 0, 1})};
  ForestTraceOptions options;
  const ForestTraceResult closest =
      ForestTracer(context(), rig.forest(), rig.tops()[1], options).closest(rays);
  REQUIRE(closest.invalid_rays == 3);
  for (std::size_t i = 0; i < 3; ++i) REQUIRE(closest.hits[i].primitive == GN_NONE);
  static_cast<void>(rig.require_same_answers(rays));
}
