// Which glTF extensions a file may require. Not for reading them. Feeds gltf_json.
#pragma once

#include <string_view>

namespace gnomon {

// Throws Error{kBadScene} naming an extension we would have to know and do not, and what to do about it.
// Known are KHR_mesh_quantization, KHR_lights_punctual and all that change only looks or textures, which are
// not read.
void require_known_extension(std::string_view name);

// The remedy for geometry compressed by KHR_draco_mesh_compression or a meshopt extension.
inline constexpr std::string_view kDecompress =
    "decompress it first, for example with \"gltf-transform cp in.glb out.glb\", or export it without "
    "compression";

}  // namespace gnomon
