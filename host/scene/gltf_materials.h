// The four values we keep of a glTF material. Not for textures: notes say where some were left out.
// Feeds gltf_import.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

// Every material of the file, in its order, values clamped to what they may be.
[[nodiscard]] std::vector<Material> read_materials(const tinygltf::Model& model,
                                                   std::vector<std::string>& notes);

// Numbers a primitive's material in the scene; the first one without gets a default material appended.
class MaterialIds {
 public:
  explicit MaterialIds(std::vector<Material>& materials)
      : materials_(materials), file_count_(materials.size()) {}

  // `material` is -1 for none. Throws Error{kBadScene} for one that does not exist.
  [[nodiscard]] std::uint32_t of(int material, const std::string& place);

 private:
  std::vector<Material>& materials_;
  std::size_t file_count_;
  std::optional<std::uint32_t> default_id_;
};

}  // namespace gnomon
