#include "gnomon/scene/gltf_materials.h"

#include <algorithm>
#include <limits>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

constexpr double kMostRadiance = std::numeric_limits<float>::max();

float clamped(double value, double most) {
  return static_cast<float>(std::clamp(value, 0.0, most));
}

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end()) return 1.0;
  const tinygltf::Value& strength = extension->second.Get("emissiveStrength");
  return strength.IsNumber() ? strength.GetNumberAsDouble() : 1.0;
}

Material read_material(const tinygltf::Material& source) {
  Material material;
  material.name = source.name;
  const auto& pbr = source.pbrMetallicRoughness;
  const double strength = emissive_strength(source);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    material.base_color[channel] = clamped(pbr.baseColorFactor[channel], 1.0);
    material.emission[channel] = clamped(source.emissiveFactor[channel] * strength, kMostRadiance);
  }
  material.roughness = clamped(pbr.roughnessFactor, 1.0);
  material.metallic = clamped(pbr.metallicFactor, 1.0);
  return material;
}

}  // namespace

std::vector<Material> read_materials(const tinygltf::Model& model, std::vector<std::string>& notes) {
  std::vector<Material> materials;
  std::size_t textured = 0;
  std::size_t glowing = 0;
  for (const tinygltf::Material& source : model.materials) {
    materials.push_back(read_material(source));
    if (source.pbrMetallicRoughness.baseColorTexture.index >= 0) ++textured;
    const Vec3& emission = materials.back().emission;
    if (source.emissiveTexture.index >= 0 && *std::max_element(emission.begin(), emission.end()) > 0.0F)
      ++glowing;
  }
  if (textured > 0) {
    notes.push_back("Textures are not read: " + std::to_string(textured) +
                    " materials have their plain color only.");
  }
  if (glowing > 0) {
    notes.push_back("Textures are not read: " + std::to_string(glowing) +
                    " emissive materials shine with their whole surface.");
  }
  return materials;
}

std::uint32_t MaterialIds::of(int material, const std::string& place) {
  if (material >= 0) {
    if (static_cast<std::size_t>(material) >= file_count_) {
      bad_scene(place + ": material " + std::to_string(material) + " does not exist, there are " +
                std::to_string(file_count_) + std::string(kExportAgain));
    }
    return static_cast<std::uint32_t>(material);
  }
  if (!default_id_) {
    default_id_ = static_cast<std::uint32_t>(materials_.size());
    materials_.emplace_back().name = "default";
  }
  return *default_id_;
}

}  // namespace gnomon
