// Which rays a tree is built for, as the command line says it: a heuristic, an axis policy, and a light of
// the scene or rays of the caller's own. Feeds the subcommands that build.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "console.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/build_options.h"

namespace gnomon::app {

struct HeuristicOptions {
  std::string heuristic = "sah";
  std::string axes = "all";
  std::optional<std::uint64_t> light;  // place in scene.lights
  std::string direction;               // x,y,z
  std::string point;                   // x,y,z
  std::string fov;                     // degrees, W,H
  std::optional<double> share;         // of the heuristic in a mixture with surface area
};

void add_heuristic_options(CLI::App& command, HeuristicOptions& options);

// Refuses combinations that make no sense, before anything is loaded. Throws Error{kInvalidArgument} naming
// the option.
void check(const HeuristicOptions& options);

// The tree options with the heuristic, settled for the scene's light or the caller's rays. Throws
// Error{kInvalidArgument}: no such light, a light without an area, rays that the heuristic does not measure.
[[nodiscard]] BuildOptions with_heuristic(BuildOptions build, const HeuristicOptions& options,
                                          const Scene& scene);

// "pah-window+spfh, rays of light 0 (directional)".
[[nodiscard]] std::string describe(const HeuristicOptions& options, const BuildOptions& build,
                                   const Scene& scene);

// The same in the document's options: "axes", "rays_of" and "share", null where not given; "heuristic" is
// there already.
void add_heuristic(Json& document, const HeuristicOptions& options, const Scene& scene);

// For the footer of --help.
extern const char* const kHeuristicHelp;

}  // namespace gnomon::app
