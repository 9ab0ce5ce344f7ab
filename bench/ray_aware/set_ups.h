// The rays of ray_aware_bench and plan_clock_bench: the thesis' set-ups, and generated scenes with their
// cameras and lights. Every kind of rays is drawn three times with different seeds: to fit to, to choose by,
// to measure. Feeds those and ray_aware_time.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/measure/set_up.h"
#include "gnomon/plan/choose.h"
#include "gnomon/scene/scene.h"

namespace gnomon::bench {

// Three draws of one kind of rays.
struct Draws {
  std::vector<Ray> fit;
  std::vector<Ray> probe;
  std::vector<Ray> measure;
};

struct RayCase {
  std::string rays;  // "area", "primary", "bounce", "shadow", "lit", "light 0"
  Query query = Query::kClosest;
  Draws draws;
  bool together = false;                 // PlanRays'
  std::vector<InfluenceArea> regions{};  // PlanRays'
};

// What a plan is made for: with `draws`' first two.
[[nodiscard]] PlanRays to_plan_for(const RayCase& rays, double expected);

// Triangles and what is asked of them.
struct AwareSetUp {
  std::string family;  // "thesis" or "generated"
  std::string name;
  std::vector<Triangle> triangles;
  std::vector<RayCase> cases;
};

// One of the thesis': the triangles that touch the area; rays of the area (closest hit, and every box on
// their way), shadow rays to its light from what a camera sees of it, and those of them that nothing stops.
[[nodiscard]] AwareSetUp thesis_set_up(const SetUp& set_up, const Scene& scene, std::uint64_t rays);

// A generated scene: primary, bounce and shadow rays, those that nothing stops, and rays of up to two lights'
// areas.
[[nodiscard]] AwareSetUp generated_set_up(const std::string& name, const Scene& scene, std::uint64_t rays);

// Where set-ups come from.
struct SetUpSources {
  std::string configs, models;  // the thesis': a JSON file, a folder; none are read without
  std::string only;             // of these those whose label has this
  std::vector<std::string> scenes{"atrium", "city", "forest", "crowd", "cottage"};  // generated
  std::uint64_t triangles = 100'000;
  std::uint64_t rays = 2048;  // to measure on
};

using VisitSetUp = std::function<void(const AwareSetUp& set_up)>;
void for_each_thesis_set_up(const SetUpSources& sources, const VisitSetUp& visit);
void for_each_generated_set_up(const SetUpSources& sources, const VisitSetUp& visit);

}  // namespace gnomon::bench
