// The outer shell of a binary glTF file: header, JSON chunk, binary chunk. Not for what is in them. Feeds
// gltf_export. Source: glTF 2.0 specification, section 4.4.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gnomon {

// Throws Error{kInvalidArgument} when a buffer of this size does not fit into one file: its lengths are 32
// bits wide.
void require_glb_room(std::uint64_t buffer_bytes);

// Both chunks padded to four bytes, the JSON with spaces, the buffer with zeros; no second chunk for an empty
// buffer.
[[nodiscard]] std::vector<unsigned char> pack_glb(std::string_view json,
                                                  std::span<const unsigned char> buffer);

}  // namespace gnomon
