// The scene, and the boxes each method tests for each pixel, as small PNG files. Feeds run_device.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gnomon/compare/method.h"
#include "gnomon/compare/report.h"

namespace gnomon::compare {

// The scene's picture and its size go to `pictures`.
void draw_scene(const cl::Context& context, const Scene& scene, const DeviceBvh& tree, std::uint32_t width,
                std::uint32_t height, std::uint64_t seed, Pictures& pictures, const Progress& progress);

// A heat map of each method that counts boxes, all with one scale, one ray through the middle of each pixel;
// methods whose rays test just as many boxes as an earlier one's have none.
void draw_heat_maps(const Scene& scene, const std::vector<std::pair<std::string, Entrant*>>& methods,
                    Pictures& pictures);

}  // namespace gnomon::compare
