// Local trees and a global one against the global one alone: the same answers to the last bit, by every
// lookup, for closest and any hit. And the thesis' rule, which gives other ones.
#include <catch2/catch.hpp>
#include <cstring>

#include "gnomon/areas/area_rays.h"
#include "gnomon/device/trace_areas.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/shared/area_math.h"
#include "support/area_shapes.h"
#include "support/device.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// How rays were answered, and how many answers differ from the global tree's.
struct Tally {
  std::uint64_t outcomes[4] = {};
  std::uint64_t wrong_hits = 0;
  std::uint64_t wrong_any = 0;
};

class Rig {
 public:
  Rig(const std::vector<GnTriangle>& triangles, const std::vector<LocalTree>& local_trees)
      : global_(build_device(context(), triangles)),
        forest_(build_forest(context(), triangles, local_trees)) {
    const OctreeOptions octree{3, false};
    for (const AreaLookup lookup : {AreaLookup::kList, AreaLookup::kBvh, AreaLookup::kOctree})
      tops_.push_back(
          upload_top_level(context(), build_top_level(forest_.areas, lookup, octree), forest_.shared_areas));
  }

  [[nodiscard]] Tally compare(const std::vector<GnRay>& rays, const DeviceTopLevel& top,
                              const ForestTraceOptions& options) const {
    const Tracer alone(context(), global_);
    const ForestTracer tracer(context(), forest_, top, options);
    const std::vector<GnHit> hits = alone.closest(rays).hits;
    const std::vector<std::uint32_t> occluded = alone.any(rays).occluded;
    const ForestTraceResult closest = tracer.closest(rays);
    const ForestTraceResult any = tracer.any(rays);
    Tally tally;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      tally.wrong_hits += std::memcmp(&closest.hits[i], &hits[i], sizeof(GnHit)) != 0 ? 1 : 0;
      tally.wrong_any += any.occluded[i] != occluded[i] ? 1 : 0;
      if (options.trace.counters) tally.outcomes[closest.counters[i].outcome] += 1;
    }
    return tally;
  }

  // Every lookup gives the global tree's answers with the same work; returns the outcomes.
  Tally require_same_answers(const std::vector<GnRay>& rays, std::uint32_t step_limit = 0) const {
    ForestTraceOptions options;
    options.trace.counters = true;
    options.trace.step_limit = step_limit;
    Tally first;
    for (const DeviceTopLevel& top : tops_) {
      CAPTURE(to_string(top.lookup), step_limit);
      const Tally tally = compare(rays, top, options);
      REQUIRE(tally.wrong_hits == 0);
      REQUIRE(tally.wrong_any == 0);
      if (&top == &tops_.front()) first = tally;
      REQUIRE(std::equal(tally.outcomes, tally.outcomes + 4, first.outcomes));
    }
    return first;
  }

  [[nodiscard]] Tally by_the_published_rule(const std::vector<GnRay>& rays) const {
    ForestTraceOptions options;
    options.rule = FallbackRule::kPublished;
    return compare(rays, tops_.front(), options);
  }

  [[nodiscard]] const DeviceForest& forest() const { return forest_; }
  [[nodiscard]] const std::vector<DeviceTopLevel>& tops() const { return tops_; }

 private:
  DeviceBvh global_;
  DeviceForest forest_;
  std::vector<DeviceTopLevel> tops_;
};

struct Extent {
  Vec3d middle;
  double half;  // of the longest side
};

Extent extent_of(const std::vector<GnTriangle>& triangles) {
  Box3d box;
  for (const GnTriangle& t : triangles) {
    for (const float* v : {t.v0, t.v1, t.v2})
      extend(box, {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  }
  return {0.5 * (box.lo + box.hi), 0.5 * magnitude(box.hi - box.lo)};
}

// A window, a view and a ball for a scene; by size 1 they span it, by less triangles stick out of them.
std::vector<InfluenceArea> areas_of(const Extent& scene, const Vec3d& direction, double size) {
  PlaneWindow window;
  window.direction = direction;
  window.point = scene.middle - 1.5 * scene.half * unit_of(direction);
  window.half_width = size * scene.half;
  window.half_height = 0.8 * size * scene.half;
  window.depth = size * 3.0 * scene.half;
  PointView view;
  view.direction = direction;
  view.eye = scene.middle - 2.5 * scene.half * unit_of(direction);
  view.fov_x = size * 60.0 * kDegree;
  view.fov_y = size * 40.0 * kDegree;
  view.near_distance = 0.5 * scene.half;
  view.far_distance = view.near_distance + size * 4.0 * scene.half;
  return {InfluenceArea::plane(window), InfluenceArea::point(view),
          InfluenceArea::omni(scene.middle, size * scene.half)};
}

std::vector<LocalTree> local_trees_of(const std::vector<InfluenceArea>& areas, double tolerance = 0.01) {
  std::vector<LocalTree> trees;
  for (const InfluenceArea& area : areas) trees.push_back({area, {}, Membership::kExact, tolerance, 0x1p-16});
  return trees;
}

void append(std::vector<GnRay>& rays, const std::vector<GnRay>& more) {
  rays.insert(rays.end(), more.begin(), more.end());
}

std::vector<GnRay> rays_of(const InfluenceArea& area, std::uint64_t count, std::uint64_t seed) {
  const RayMeasure measure =
      area.kind() == AreaKind::kPlane ? RayMeasure::kParallel : RayMeasure::kSolidAngle;
  return area_rays(area, measure, count, seed);
}

// Rays that each area is for, rays that start near its faces and may end anywhere, rays of a camera.
std::vector<GnRay> all_rays(const std::vector<InfluenceArea>& areas, std::uint64_t count,
                            std::uint64_t seed) {
  std::vector<GnRay> rays;
  Source source(seed);
  for (const InfluenceArea& area : areas) {
    append(rays, rays_of(area, count, seed));
    for (std::uint64_t i = 0; i < count; ++i) {
      GnRay r = ray_near(area, source);
      const double choice = source.between(0.0, 3.0);
      const std::optional<double> exit =
          area.exit_distance({point_at(r, static_cast<double>(r.tmin)), to_ray3d(r).direction});
      if (exit && choice < 2.0)
        r.tmax = r.tmin + static_cast<float>(*exit * (choice < 1.0 ? 1.0 : source.between(0.0, 1.5)));
      rays.push_back(r);
    }
  }
  return rays;
}

std::uint64_t total(const Tally& tally) {
  return tally.outcomes[0] + tally.outcomes[1] + tally.outcomes[2] + tally.outcomes[3];
}

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

TEST_CASE("generated scenes: areas of every kind that span them, shrunk or cut, change no answer") {
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

TEST_CASE("overlapping, nested, touching and repeated areas, some outside the scene or empty", "[portable]") {
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
  for (const std::uint32_t step_limit : {1U, 30U}) {
    const Tally cut = rig.require_same_answers(rays, step_limit);
    REQUIRE(std::equal(cut.outcomes, cut.outcomes + 4, whole.outcomes));
  }
}

TEST_CASE("a ray that starts in its window is served by the local tree") {
  const std::vector<GnTriangle> triangles = soup(300, 145, 1.0F);
  const std::vector<InfluenceArea> areas = areas_of({{5, 5, 5}, 5.0}, {0.3, -0.2, 1}, 1.0);
  for (const InfluenceArea& area : areas) {
    const Rig rig(triangles, local_trees_of({area}));
    const std::vector<GnRay> rays = rays_of(area, 500, 146);
    const Tally tally = rig.require_same_answers(rays);
    REQUIRE(tally.outcomes[GN_OUTCOME_GLOBAL] == 0);
  }
  // A camera: the eye of a view that begins right in front of it.
  PointView view;
  view.eye = {5, 5, -8};
  view.near_distance = 1e-6;
  view.far_distance = 25.0;
  const InfluenceArea camera = InfluenceArea::point(view);
  const Rig rig(triangles, local_trees_of({camera}));
  const std::vector<GnRay> rays =
      area_rays(camera, RayMeasure::kNearPlane, 500, 147, {RayStart::kEye, false});
  REQUIRE(rig.require_same_answers(rays).outcomes[GN_OUTCOME_GLOBAL] == 0);
}

TEST_CASE("a ray that ends where it leaves, before or behind, is asked the right trees") {
  // A wall in the region and one behind it.
  const std::vector<GnTriangle> triangles = {triangle({-9, -9, 0.5F}, {9, -9, 0.5F}, {0, 18, 0.5F}),
                                             triangle({-9, -9, 3}, {9, -9, 3}, {0, 18, 3})};
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});  // z from 0 to 1
  const Rig rig(triangles, local_trees_of({area}));
  const GnArea& shared = rig.forest().shared_areas.front();
  const GnRay behind_wall = ray({0, 0, 0.75F}, {0, 0, 1});
  const GnRayStart start = gn_ray_start(&behind_wall);
  const float exit = gn_area_exit(&shared, &start);
  REQUIRE(exit == Approx(0.25F).epsilon(1e-3));
  const auto outcome_of = [&](const GnRay& r) {
    const Tally tally = rig.require_same_answers({r});
    return std::find(tally.outcomes, tally.outcomes + 4, 1) - tally.outcomes;
  };
  const auto with_end = [&](float tmax) { return ray({0, 0, 0.75F}, {0, 0, 1}, 0, tmax); };
  REQUIRE(outcome_of(with_end(0.1F)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(with_end(exit)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(with_end(std::nextafter(exit, kInf))) == GN_OUTCOME_FALLBACK);
  REQUIRE(outcome_of(with_end(2.25F)) == GN_OUTCOME_FALLBACK);
  REQUIRE(outcome_of(with_end(-1.0F)) == GN_OUTCOME_INSIDE);
  REQUIRE(outcome_of(ray({0, 0, 0.25F}, {0, 0, 1})) == GN_OUTCOME_LOCAL);
  REQUIRE(outcome_of(ray({0, 0, -4}, {0, 0, 1}, 4.25F)) == GN_OUTCOME_LOCAL);
  REQUIRE(outcome_of(ray({0, 0, -4}, {0, 0, 1}, 5.5F)) == GN_OUTCOME_GLOBAL);
  REQUIRE(outcome_of(ray({0, 0, 0.25F}, {0, 1, 1})) == GN_OUTCOME_GLOBAL);  // not affine
}

TEST_CASE("the published rule gives wrong hits, more so with membership by vertices; the exit rule none") {
  const Scene scene = generate_scene("random1000", 1000, 1);
  const Extent extent = extent_of(scene.triangles);
  std::vector<InfluenceArea> areas = areas_of(extent, {0, 0, 1}, 1.0);
  for (const InfluenceArea& half : areas_of(extent, {0, 0, 1}, 0.5)) areas.push_back(half);
  std::uint64_t exact = 0;
  std::uint64_t vertices = 0;
  for (const InfluenceArea& area : areas) {
    const std::vector<GnRay> rays = rays_of(area, 2000, 148);
    std::vector<LocalTree> trees = local_trees_of({area});
    const Rig rig(scene.triangles, trees);
    static_cast<void>(rig.require_same_answers(rays));
    const std::uint64_t wrong = rig.by_the_published_rule(rays).wrong_hits;
    trees[0].membership = Membership::kVertices;
    const std::uint64_t by_vertices = Rig(scene.triangles, trees).by_the_published_rule(rays).wrong_hits;
    UNSCOPED_INFO("kind " << static_cast<int>(area.kind()) << ": " << wrong
                          << " wrong with exact membership, " << by_vertices << " by vertices, of "
                          << rays.size());
    exact += wrong;
    vertices += by_vertices;
  }
  CAPTURE(exact, vertices);
  REQUIRE(exact > 0);
  REQUIRE(vertices > exact);
}

TEST_CASE("triangles that stick out and hide others: the published rule is wrong, the exit rule is not",
          "[portable]") {
  // A long roof slants down out of the region; the ray meets a screen outside before it meets the roof.
  const std::vector<GnTriangle> triangles = {triangle({-0.9F, -4, 0.9F}, {10, -4, 0}, {-0.9F, 20, 0.9F}),
                                             triangle({2, -4, 0}, {2, 8, 0}, {2, -4, 30})};
  const InfluenceArea area = InfluenceArea::plane(PlaneWindow{});
  const Rig rig(triangles, local_trees_of({area}, 1.0));
  REQUIRE(rig.forest().local[0].triangle_count == 1);
  const std::vector<GnRay> rays = {ray({0.5F, 0, 0.3F}, {1, 0, 0})};
  static_cast<void>(rig.require_same_answers(rays));
  REQUIRE(rig.by_the_published_rule(rays).wrong_hits == 1);
  REQUIRE(rig.by_the_published_rule(rays).wrong_any == 0);
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
