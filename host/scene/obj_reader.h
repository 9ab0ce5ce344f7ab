// Reading OBJ text from memory: the part of import_obj that tests and fuzzing feed directly. Not for MTL
// (obj_material).
#pragma once

#include <filesystem>
#include <vector>

#include "gnomon/scene/import.h"

namespace gnomon {

// The scene of an OBJ file's text; `base_folder` is where material files are looked for. Triangles keep the
// file's order, polygons are split by split_polygon. Throws as import_obj does, naming lines.
[[nodiscard]] Scene import_obj_bytes(std::vector<unsigned char> text,
                                     const std::filesystem::path& base_folder,
                                     const ImportOptions& options = {});

}  // namespace gnomon
