#include "gnomon/scene/glb_split.h"

#include <cstdint>
#include <string>

#include "gnomon/scene/import_message.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t little_endian(std::span<const unsigned char> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16U | static_cast<std::uint32_t>(bytes[at + 3]) << 24U;
}

std::string_view as_text(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void cut_short(const std::string& what) {
  bad_scene("this .glb is cut short: " + what + "; copy or download it again");
}

// The file up to the length its header states; what follows that is not part of it.
std::span<const unsigned char> stated_part(std::span<const unsigned char> file) {
  if (file.size() < kHeaderBytes) cut_short("it ends inside its header");
  const std::uint32_t version = little_endian(file, 4);
  if (version != 2) {
    bad_scene("this .glb is of version " + std::to_string(version) + "; export it as glTF 2.0");
  }
  const std::uint32_t length = little_endian(file, 8);
  if (length < kHeaderBytes) cut_short("its header states a length of " + std::to_string(length) + " bytes");
  if (length > file.size()) {
    cut_short("its header states " + std::to_string(length) + " bytes and there are " +
              std::to_string(file.size()));
  }
  return file.first(length);
}

GltfParts split_glb(std::span<const unsigned char> file) {
  GltfParts parts;
  const auto glb = stated_part(file);
  std::size_t at = kHeaderBytes;
  for (std::size_t chunk = 0; glb.size() - at >= kChunkHeaderBytes; ++chunk) {
    const std::uint32_t length = little_endian(glb, at);
    const std::uint32_t type = little_endian(glb, at + 4);
    at += kChunkHeaderBytes;
    if (length > glb.size() - at) cut_short("chunk " + std::to_string(chunk) + " reaches past its end");
    if ((chunk == 0) != (type == kJsonChunk)) {
      bad_scene("this .glb must have exactly one JSON chunk, and it must come first" +
                std::string(kExportAgain));
    }
    if (chunk == 0) parts.json = as_text(glb.subspan(at, length));
    // Only the second chunk may be BIN; others belong to extensions and are skipped.
    if (chunk == 1 && type == kBinChunk) parts.binary = glb.subspan(at, length);
    at += length;
  }
  if (parts.json.empty()) cut_short("it has no JSON chunk");
  return parts;
}

}  // namespace

GltfParts split_gltf(std::span<const unsigned char> file) {
  if (file.size() >= 4 && little_endian(file, 0) == kMagic) return split_glb(file);
  return {as_text(file), {}};
}

}  // namespace gnomon
