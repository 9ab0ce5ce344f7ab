// Influence areas of a scene's lights. Not for areas found in recorded rays. Feeds the choice of local trees.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gnomon/areas/influence_area.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

struct LightArea {
  std::size_t light;  // its place in scene.lights
  InfluenceArea area;
};

// One area for each light that can have one, in the lights' order:
// directional: a window across the direction, just around the scene's triangles, as deep as they are;
// point: a ball of the light's range, or up to the scene's farthest corner;
// spot: the square frustum around its cone, likewise; a ball where the cone is wider than 150 degrees;
// area: the window around the emitter, along its mean normal through the scene; a ball where it faces all
// ways. Left out: every light of a scene without triangles, area lights that name none, emitters with nothing
// in front.
[[nodiscard]] std::vector<LightArea> areas_of_lights(const Scene& scene);

// The area of one light, which need not be the scene's own; nothing where areas_of_lights would leave it out.
[[nodiscard]] std::optional<InfluenceArea> area_of_light(const Scene& scene, const Light& light);

// Areas of lights that may leave part of the scene dark, for a plan's rays to be told of: of the first 64
// lights, suns apart.
[[nodiscard]] std::vector<InfluenceArea> bounded_areas_of_lights(const Scene& scene);

}  // namespace gnomon
