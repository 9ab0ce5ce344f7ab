// Reading a scene file, whatever its format. Not for making scenes (generators) or writing them
// (gltf_export).
#pragma once

#include <filesystem>

#include "gnomon/scene/scene.h"

namespace gnomon {

struct ImportOptions {
  InvalidPolicy invalid = InvalidPolicy::kDrop;
  std::uint64_t max_triangles = 1ULL << 31;  // more is refused before memory is taken
};

// Reads .gltf, .glb or .obj, told apart by content first and extension second.
// Throws Error: kIo (cannot be opened), kBadScene (anything wrong inside; says which mesh, accessor or line).
[[nodiscard]] Scene import_scene(const std::filesystem::path& file, const ImportOptions& options = {});

// The two readers behind it. `bytes` variants let tests feed memory; `base_folder` resolves relative buffers.
[[nodiscard]] Scene import_gltf(const std::filesystem::path& file, const ImportOptions& options = {});
[[nodiscard]] Scene import_gltf_bytes(const unsigned char* bytes, std::size_t size,
                                      const std::filesystem::path& base_folder,
                                      const ImportOptions& options = {});
[[nodiscard]] Scene import_obj(const std::filesystem::path& file, const ImportOptions& options = {});

}  // namespace gnomon
