// How the importers word their errors: which thing, what is wrong, what to do. Not for other rooms.
// Feeds every gltf_* and obj_* file here.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "gnomon/scene/scene.h"

namespace gnomon {

// What to do when a file contradicts itself; ends most messages about damaged input.
inline constexpr std::string_view kExportAgain = "; the file is damaged or written wrongly: export it again";

// Throws Error{kBadScene}.
[[noreturn]] void bad_scene(const std::string& message);

// A name from a file, fit for a terminal: in double quotes, control characters as '?', cut after 60 bytes.
[[nodiscard]] std::string in_quotes(std::string_view name);

// `mesh 2 "Body"`, or `mesh 2` when it has no name.
[[nodiscard]] std::string numbered(std::string_view kind, std::size_t index, std::string_view name);

// Runs one importer: errors get the file's name in front (when there is one), anything that is not an Error
// becomes one: std::bad_alloc kOutOfMemory, every other exception kBadScene.
[[nodiscard]] Scene run_import(const std::filesystem::path& file, const std::function<Scene()>& import);

}  // namespace gnomon
