// The JSON of a glTF file, checked before tinygltf sees it. tinygltf 2.7 wraps large integers, takes negative
// offsets for zero, silently drops primitives it cannot read and fails on missing images; so only the members
// we use are passed on, each of the right type and range. Not for whether indices and byte ranges make sense
// together (gltf_accessor, gltf_nodes). Feeds gltf_document.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

// Where a buffer's bytes come from. No uri: the .glb's BIN chunk.
struct GltfBufferSource {
  std::optional<std::string> uri;
  std::uint64_t byte_length = 0;
};

struct CheckedGltf {
  std::string
      text;  // glTF JSON for tinygltf, without buffers, images, textures, animations, skins and extras
  std::vector<GltfBufferSource> buffers;
};

// Throws Error{kBadScene} naming the member that is missing, of the wrong type or out of range, for a version
// other than 2, and for a required extension that is not supported.
[[nodiscard]] CheckedGltf check_gltf_json(std::string_view json);

}  // namespace gnomon
