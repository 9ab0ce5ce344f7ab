// Bytes as text (RFC 4648). Feeds the report's JSON and its page.
#pragma once

#include <string>

namespace gnomon::compare {

[[nodiscard]] std::string to_base64(const std::string& bytes);
// Throws Error{kBadScene} for a character that is not of it.
[[nodiscard]] std::string from_base64(const std::string& text);

}  // namespace gnomon::compare
