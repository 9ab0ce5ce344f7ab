#include "gnomon/scene/gltf_document.h"

#include <limits>
#include <string>
#include <utility>

#include "gnomon/scene/data_uri.h"
#include "gnomon/scene/glb_split.h"
#include "gnomon/scene/gltf_json.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {
namespace {

tinygltf::Model parse_model(const std::string& json) {
  if (json.size() > std::numeric_limits<unsigned int>::max())
    bad_scene("has more than 4 GiB of JSON; split it");
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string errors;
  std::string warnings;
  // tinygltf's warnings are about images and sizes, none of which it gets to see here.
  if (!reader.LoadASCIIFromString(&model, &errors, &warnings, json.data(),
                                  static_cast<unsigned int>(json.size()), "")) {
    bad_scene("tinygltf cannot read it: " + errors);
  }
  return model;
}

std::span<const unsigned char> require_bytes(std::span<const unsigned char> bytes, std::uint64_t wanted,
                                             const std::string& place) {
  if (bytes.size() < wanted) {
    bad_scene(place + " should have " + std::to_string(wanted) + " bytes and has " +
              std::to_string(bytes.size()) + "; the file is cut short: copy or export it again");
  }
  return bytes.first(static_cast<std::size_t>(wanted));
}

// The bytes a URI stands for, at most as many as wanted.
std::vector<unsigned char> read_uri(const GltfBufferSource& source, const std::filesystem::path& base_folder,
                                    const std::string& place) {
  const std::string& uri = *source.uri;
  if (is_data_uri(uri)) return decode_data_uri(uri, place);
  if (uri.find("://") != std::string::npos) {
    bad_scene(place + " is at the address " + in_quotes(uri) +
              "; download it beside the .gltf and name the file");
  }
  const std::string name = decode_percent(uri);  // UTF-8 by the specification
  return read_file(base_folder / std::filesystem::path(std::u8string(name.begin(), name.end())),
                   source.byte_length);
}

}  // namespace

GltfDocument read_gltf_document(std::span<const unsigned char> file,
                                const std::filesystem::path& base_folder) {
  GltfDocument document;
  const GltfParts parts = split_gltf(file);
  const CheckedGltf checked = check_gltf_json(parts.json);
  document.model = parse_model(checked.text);
  for (const GltfBufferSource& source : checked.buffers) {
    const std::size_t index = document.buffers.size();
    const std::string place = "buffer " + std::to_string(index);
    if (source.uri) {
      document.storage.push_back(read_uri(source, base_folder, place));
      document.buffers.push_back(require_bytes(document.storage.back(), source.byte_length, place));
    } else if (index == 0 && !parts.binary.empty()) {
      document.buffers.push_back(require_bytes(parts.binary, source.byte_length, place));
    } else {
      bad_scene(place + " has no uri and the file no binary part for it" + std::string(kExportAgain));
    }
  }
  return document;
}

}  // namespace gnomon
