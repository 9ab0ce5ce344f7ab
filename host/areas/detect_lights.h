// The areas of a scene's lights, shrunk to where a sample's shadow rays are. Not for rays of unknown lights
// (detect). Feeds the same as areas_from_scene.
#pragma once

#include <span>
#include <vector>

#include "gnomon/areas/areas_from_scene.h"

namespace gnomon {

struct LightRegion {
  std::size_t light;      // its place in scene.lights
  InfluenceArea area;     // as areas_of_lights gives it
  InfluenceArea region;   // where its rays are; the area itself where it has too few
  bool shrunk = false;    // whether the region is made from rays
  std::size_t count = 0;  // of the rays: those that ask this light
  double coverage = 0.0;  // the same as a share of all rays
  double inside = 0.0;    // share of the light's rays that are in the region whole, from begin to end
  double spread =
      0.0;  // radians, root mean square, about the light's direction or from the line to its place
};

// One for each of areas_of_lights, in that order. A ray asks a sun if it goes its way to within a thousandth,
// and a lamp if its line passes it as closely; panels are asked by rays that end on them. Among several the
// nearest to it counts. A sun's and a panel's region is a box along the same direction, a lamp's a frustum or
// ball about the same place; fewer than 16 rays shrink nothing. Throws Error{kInvalidArgument} for rays that
// detect refuses.
[[nodiscard]] std::vector<LightRegion> detect_lights(const Scene& scene, std::span<const GnRay> rays);

}  // namespace gnomon
