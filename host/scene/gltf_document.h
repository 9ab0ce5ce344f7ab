// A glTF file in memory: tinygltf's structs and the bytes of its buffers. Not for what they mean as a scene.
// Feeds gltf_accessor, gltf_nodes, gltf_mesh and gltf_import.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <span>
#include <vector>

namespace gnomon {

// buffers may point into the file's bytes: keep those while this lives.
struct GltfDocument {
  tinygltf::Model model;
  std::vector<std::vector<unsigned char>> storage;
  std::vector<std::span<const unsigned char>> buffers;  // as the model's buffer views number them
};

// Checks the JSON, lets tinygltf read it and resolves every buffer: the GLB's own, data URIs and files
// relative to `base_folder`. Throws Error: kIo for a buffer file that cannot be read, kBadScene for
// everything else.
[[nodiscard]] GltfDocument read_gltf_document(std::span<const unsigned char> file,
                                              const std::filesystem::path& base_folder);

}  // namespace gnomon
