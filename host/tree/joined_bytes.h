// Parts of a file put behind one another. Feeds the writers of trees.
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <span>
#include <vector>

namespace gnomon {

[[nodiscard]] inline std::vector<std::byte> joined_bytes(
    std::initializer_list<std::span<const std::byte>> parts) {
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  std::vector<std::byte> bytes(size);
  std::size_t at = 0;
  for (const auto& part : parts) {
    if (!part.empty()) std::memcpy(bytes.data() + at, part.data(), part.size());
    at += part.size();
  }
  return bytes;
}

}  // namespace gnomon
