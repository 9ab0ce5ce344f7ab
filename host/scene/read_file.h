// Reading a regular file into memory. Not for devices and pipes: a scene that names one must not make us
// wait. Feeds the importers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gnomon {

// The first `at_most` bytes of a file, all of it by default. Throws Error: kIo saying why it cannot be read,
// kOutOfMemory.
[[nodiscard]] std::vector<unsigned char> read_file(const std::filesystem::path& file,
                                                   std::uint64_t at_most = UINT64_MAX);

}  // namespace gnomon
