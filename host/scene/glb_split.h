// Telling the parts of a glTF file apart. Not for what the JSON says (gltf_json). Feeds the glTF importer.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace gnomon {

// Views into the file's bytes. binary is empty for a .gltf and for a .glb without a BIN chunk.
struct GltfParts {
  std::string_view json;
  std::span<const unsigned char> binary;
};

// Reads the chunks of a GLB (glTF 2.0, section 4.4) or takes everything as JSON.
// Throws Error{kBadScene} for a GLB of another version, cut short or with its chunks in the wrong order.
[[nodiscard]] GltfParts split_gltf(std::span<const unsigned char> file);

}  // namespace gnomon
