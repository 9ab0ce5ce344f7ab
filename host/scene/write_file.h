// Writing a whole file or nothing: into a temporary beside it that takes its name at the end. Not for streams
// and devices. Feeds gltf_export and ray_files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace gnomon {

// Replaces `file` by `bytes`. Throws Error{kIo} with path and reason; what was there before is then
// untouched.
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace gnomon
