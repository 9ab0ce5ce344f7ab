// The makers behind generate_scene, one file each. Counts are checked by the caller. Feeds generators.cpp
// only.
#pragma once

#include <cstdint>

#include "gnomon/scene/scene.h"

namespace gnomon {

Scene make_random(std::uint64_t triangles, std::uint64_t seed);
Scene make_random100(std::uint64_t triangles, std::uint64_t seed);
Scene make_random1000(std::uint64_t triangles, std::uint64_t seed);
Scene make_terrain(std::uint64_t triangles, std::uint64_t seed);
Scene make_city(std::uint64_t triangles, std::uint64_t seed);
Scene make_atrium(std::uint64_t triangles, std::uint64_t seed);
Scene make_cottage(std::uint64_t triangles, std::uint64_t seed);
Scene make_cottage_walls(std::uint64_t triangles, std::uint64_t seed);
Scene make_forest(std::uint64_t triangles, std::uint64_t seed);
Scene make_crowd(std::uint64_t triangles, std::uint64_t seed);

}  // namespace gnomon
