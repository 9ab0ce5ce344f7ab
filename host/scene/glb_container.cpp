#include "gnomon/scene/glb_container.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

static_assert(std::endian::native == std::endian::little,
              "binary glTF is little-endian and written as it lies in memory");

constexpr std::uint64_t kMaxFileBytes = 0xffffffffULL;
constexpr std::uint64_t kJsonRoom = 1ULL << 24;  // more than the JSON of thousands of materials takes

constexpr std::uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN"

std::uint64_t padded(std::uint64_t size) {
  return (size + 3) / 4 * 4;
}

// Copies `size` bytes to `offset`, which must lie inside.
void put(std::vector<unsigned char>& bytes, std::uint64_t offset, const void* data, std::size_t size) {
  if (size != 0) std::memcpy(bytes.data() + offset, data, size);
}

[[noreturn]] void too_large(std::uint64_t bytes) {
  throw Error(ErrorCode::kInvalidArgument,
              "the scene needs " + std::to_string(bytes) + " bytes; a .glb file holds at most " +
                  std::to_string(kMaxFileBytes) + ": make it smaller or export it in parts");
}

}  // namespace

void require_glb_room(std::uint64_t buffer_bytes) {
  if (buffer_bytes > kMaxFileBytes - kJsonRoom) too_large(buffer_bytes);
}

std::vector<unsigned char> pack_glb(std::string_view json, std::span<const unsigned char> buffer) {
  const std::uint64_t bin_chunk = buffer.empty() ? 0 : 8 + padded(buffer.size());
  const std::uint64_t total = 12 + 8 + padded(json.size()) + bin_chunk;
  if (total > kMaxFileBytes) too_large(total);
  const std::uint64_t json_bytes = padded(json.size());
  const auto word = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const std::uint32_t head[] = {kMagic, 2, word(total), word(json_bytes), kJsonChunk};
  std::vector<unsigned char> bytes(total, 0);
  put(bytes, 0, head, sizeof head);
  put(bytes, sizeof head, json.data(), json.size());
  std::fill_n(bytes.begin() + sizeof head + json.size(), json_bytes - json.size(), ' ');
  if (buffer.empty()) return bytes;
  const std::uint32_t bin_head[] = {word(padded(buffer.size())), kBinChunk};
  put(bytes, sizeof head + json_bytes, bin_head, sizeof bin_head);
  put(bytes, sizeof head + json_bytes + sizeof bin_head, buffer.data(), buffer.size());
  return bytes;
}

}  // namespace gnomon
