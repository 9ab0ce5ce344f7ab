// What the failure map crosses: lights over generated scenes, and the ways to build a tree for them. Feeds
// the bench of failures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/areas/ray_measure.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/build_options.h"

namespace gnomon::bench {

// Rays of these seeds measure; scenes, and the rays that samplers fit to, have seeds of their own.
inline constexpr std::uint64_t kSceneSeed = 1;
inline constexpr std::uint64_t kMeasureSeed = 11;
inline constexpr std::uint64_t kFitSeed = 1001;

// One light over one scene.
struct LightCase {
  std::string name;   // a column of the map; stays
  std::string light;  // in words
  InfluenceArea area;
  RayMeasure rays;  // how the light's rays are distributed
};

// A scene and the lights over it.
struct CaseScene {
  std::string generator;
  Scene scene;
  std::vector<LightCase> lights;
};

// The names of generators used, and one of them with its lights. `triangles` 0: the size the map is made for.
[[nodiscard]] std::vector<std::string> case_generators();
[[nodiscard]] CaseScene make_case(const std::string& generator, std::uint64_t triangles);

// A way to build a tree for a light's rays. Names are rows of the map and stay.
struct Method {
  std::string name;
  BuildOptions options;
};
// Surface area first: what the others are held against.
[[nodiscard]] std::vector<Method> methods_for(const LightCase& light);
[[nodiscard]] Method method_named(const LightCase& light, const std::string& name);

// The measure that the light's own rays ask for, and the window that it is seen through.
[[nodiscard]] GnMeasure own_measure(const LightCase& light);

}  // namespace gnomon::bench
