// Procedural scenes: the same name, triangle count and seed give the same bytes on every machine.
// Not for reading files. Feeds the command line, tests, benches and the shipped scenes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "gnomon/scene/scene.h"

namespace gnomon {

struct GeneratorInfo {
  std::string_view name;
  std::string_view summary;  // one line for --help
  std::uint64_t default_triangles;
  std::uint64_t min_triangles;
};

// All generators, in the order --help lists them.
[[nodiscard]] std::span<const GeneratorInfo> generators();

// Makes a scene of about `triangles` triangles (within 10 %, exact for random, random100, random1000), with
// at least one camera and one light. Throws Error{kInvalidArgument} for an unknown name (lists the known
// ones) or a count below the minimum.
[[nodiscard]] Scene generate_scene(std::string_view name, std::uint64_t triangles, std::uint64_t seed);

}  // namespace gnomon
