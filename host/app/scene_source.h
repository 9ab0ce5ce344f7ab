// Getting the scene a command line names. Feeds the subcommands that read one.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "console.h"
#include "gnomon/scene/scene.h"
#include "options.h"

namespace gnomon::app {

// Reads the file, or makes the scene that gen:NAME[:TRIANGLES[:SEED]] describes (seed 1 by default). Notes on
// stderr say what was dropped or assumed. Throws Error: kBadScene (also for a file that cannot be read),
// kInvalidArgument (a gen: that makes no sense), kOutOfMemory, kCancelled.
[[nodiscard]] Scene load_scene(const SceneOptions& options, Console& console);

// What makes a generated scene anew with about so many triangles and the same seed; nothing for files. It
// throws Error{kInvalidArgument} for fewer than the generator can make.
[[nodiscard]] std::function<Scene(std::uint64_t triangles)> at_sizes(const SceneOptions& options);

// How many triangles a generator makes when nobody says; 1 for a name there is none of (generate_scene then
// lists those there are).
[[nodiscard]] std::uint64_t default_triangles(std::string_view generator);

}  // namespace gnomon::app
