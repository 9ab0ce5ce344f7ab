// Writing a scene as a binary glTF 2.0 file that other tools open. Not for reading. Feeds `gnomon scene`.
#pragma once

#include <filesystem>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

// The scene as .glb bytes: one mesh per material, indexed where corners repeat, cameras as nodes,
// point/spot/directional lights by KHR_lights_punctual, area lights as emissive materials
// (KHR_materials_emissive_strength above 1). Importing them gives the same triangles bit for bit, grouped by
// material.
[[nodiscard]] std::vector<unsigned char> export_glb(const Scene& scene);

// Writes them to `file` by way of a temporary beside it: an interrupted run leaves no half file.
// Throws Error{kIo}.
void write_glb(const Scene& scene, const std::filesystem::path& file);

}  // namespace gnomon
