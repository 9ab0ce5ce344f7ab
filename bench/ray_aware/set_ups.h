// The rays of ray_aware_bench: the thesis' set-ups, and generated scenes with their cameras and lights. Every
// kind of rays is drawn three times with different seeds: to fit to, to choose by, to measure. Feeds
// ray_aware_bench.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/measure/set_up.h"
#include "gnomon/plan/ray_sample.h"
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
};

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

}  // namespace gnomon::bench
