#include "gnomon/scene/gltf_extensions.h"

#include <array>
#include <string>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool is_known(std::string_view name) {
  constexpr std::array<std::string_view, 2> kRead{"KHR_mesh_quantization", "KHR_lights_punctual"};
  // Materials beyond colour, emission and roughness, texture formats and metadata leave every triangle in
  // place.
  constexpr std::array<std::string_view, 7> kHarmless{
      "KHR_materials_", "KHR_texture_",     "EXT_texture_",         "MSFT_texture_",
      "KHR_xmp",        "ADOBE_materials_", "KHR_animation_pointer"};
  for (const std::string_view exact : kRead) {
    if (name == exact) return true;
  }
  for (const std::string_view start : kHarmless) {
    if (starts_with(name, start)) return true;
  }
  return false;
}

std::string remedy(std::string_view name) {
  if (name == "KHR_draco_mesh_compression" || name.find("meshopt_compression") != std::string_view::npos) {
    return std::string(kDecompress);
  }
  if (name == "EXT_mesh_gpu_instancing") return "export it with one node per instance instead";
  return "export it without this extension";
}

}  // namespace

void require_known_extension(std::string_view name) {
  if (is_known(name)) return;
  bad_scene("needs the glTF extension " + in_quotes(name) + ", which is not supported; " + remedy(name));
}

}  // namespace gnomon
