// A forest beside the global tree alone, for tests that demand equal answers; areas and rays for a scene.
#pragma once

#include <catch2/catch.hpp>
#include <cstring>
#include <utility>
#include <vector>

#include "gnomon/areas/area_rays.h"
#include "gnomon/device/trace_areas.h"
#include "support/area_shapes.h"
#include "support/device.h"

namespace gnomon::test {

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

  // Every lookup (in passes: the list) gives the global tree's answers with the same outcomes; returns these.
  Tally require_same_answers(const std::vector<GnRay>& rays, std::uint32_t step_limit = 0) const {
    ForestTraceOptions options;
    options.trace.counters = true;
    options.trace.step_limit = step_limit;
    Tally first;
    for (const DeviceTopLevel& top : tops_) {
      if (step_limit != 0 && &top != &tops_.front()) break;  // each is a program to compile
      CAPTURE(to_string(top.lookup), step_limit);
      const Tally tally = compare(rays, top, options);
      REQUIRE(tally.wrong_hits == 0);
      REQUIRE(tally.wrong_any == 0);
      if (&top == &tops_.front()) first = tally;
      REQUIRE(std::equal(tally.outcomes, tally.outcomes + 4, first.outcomes));
    }
    return first;
  }

  [[nodiscard]] Tally by_the_published_rule(const std::vector<GnRay>& rays,
                                            std::uint32_t step_limit = 0) const {
    ForestTraceOptions options;
    options.trace.step_limit = step_limit;
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

inline Extent extent_of(const std::vector<GnTriangle>& triangles) {
  Box3d box;
  for (const GnTriangle& t : triangles) {
    for (const float* v : {t.v0, t.v1, t.v2})
      extend(box, {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  }
  return {0.5 * (box.lo + box.hi), 0.5 * magnitude(box.hi - box.lo)};
}

// A window, a view and a ball for a scene; by size 1 they span it, by less triangles stick out of them.
inline std::vector<InfluenceArea> areas_of(const Extent& scene, const Vec3d& direction, double size) {
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

inline std::vector<LocalTree> local_trees_of(const std::vector<InfluenceArea>& areas,
                                             double tolerance = 0.01) {
  std::vector<LocalTree> trees;
  for (const InfluenceArea& area : areas) trees.push_back({area, {}, Membership::kExact, tolerance, 0x1p-16});
  return trees;
}

inline void append(std::vector<GnRay>& rays, const std::vector<GnRay>& more) {
  rays.insert(rays.end(), more.begin(), more.end());
}

inline std::vector<GnRay> rays_of(const InfluenceArea& area, std::uint64_t count, std::uint64_t seed) {
  const RayMeasure measure =
      area.kind() == AreaKind::kPlane ? RayMeasure::kParallel : RayMeasure::kSolidAngle;
  return area_rays(area, measure, count, seed);
}

// Rays that each area is for, rays that start near its faces and may end anywhere, rays of a camera.
inline std::vector<GnRay> all_rays(const std::vector<InfluenceArea>& areas, std::uint64_t count,
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

inline std::uint64_t total(const Tally& tally) {
  return tally.outcomes[0] + tally.outcomes[1] + tally.outcomes[2] + tally.outcomes[3];
}

}  // namespace gnomon::test
