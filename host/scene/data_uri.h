// URIs as glTF uses them: data inside the text, and file names with escapes. Not for network addresses.
// Feeds gltf_document.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

[[nodiscard]] bool is_data_uri(std::string_view uri);

// The bytes of "data:<any type>;base64,<text>" (RFC 2397, RFC 4648), with or without the closing '='.
// Throws Error{kBadScene} starting with `place` for another encoding or a character that is not base64.
[[nodiscard]] std::vector<unsigned char> decode_data_uri(std::string_view uri, const std::string& place);

// Replaces %20 and its like (RFC 3986); what is no escape stays as it is.
[[nodiscard]] std::string decode_percent(std::string_view uri);

}  // namespace gnomon
