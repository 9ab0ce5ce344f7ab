// Emissive surfaces as lights. Not for lights that a file names itself. Feeds the importers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

[[nodiscard]] bool emits(const Material& material);

// The light of some emissive triangles of one material (at least one): position is their area-weighted
// centroid, direction their area-weighted mean normal made unit, or {0, 0, 0} where they face all ways alike
// (a closed surface), color the material's emission.
[[nodiscard]] Light make_area_light(const Scene& scene, std::string name, const Material& material,
                                    std::vector<std::uint32_t> triangles);

}  // namespace gnomon
