#include "gnomon/scene/import.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "gnomon/base/error.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {
namespace {

constexpr std::uint64_t kSniffedBytes = 4096;

// glTF by its content: the GLB magic, or a JSON object after white space and a byte order mark.
bool looks_like_gltf(std::string_view head) {
  if (head.substr(0, 4) == "glTF") return true;
  if (head.substr(0, 3) == "\xEF\xBB\xBF") head.remove_prefix(3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '{';
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

Scene import_scene(const std::filesystem::path& file, const ImportOptions& options) {
  const auto head = read_file(file, kSniffedBytes);
  if (looks_like_gltf({reinterpret_cast<const char*>(head.data()), head.size()}))
    return import_gltf(file, options);
  const std::string extension = lower_extension(file);
  if (extension == ".obj") return import_obj(file, options);
  // Its content is not glTF; that importer knows best what is wrong with it.
  if (extension == ".gltf" || extension == ".glb") return import_gltf(file, options);
  throw Error(ErrorCode::kBadScene, file.string() + ": not a scene; it should be .gltf, .glb or .obj");
}

}  // namespace gnomon
