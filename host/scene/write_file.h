// Writing a whole file or nothing: into a temporary beside it that takes its name at the end. Devices and
// pipes are written to as they are, and the file behind a link, not the link, is replaced. Feeds gltf_export
// and ray_files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace gnomon {

// Replaces `file` by `bytes`. Throws Error{kIo} with path and reason; what was there before is then
// untouched.
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

// Appends to `file`, which is made where there is none; nothing to append asks only whether that is possible.
// Throws Error{kIo} with path and reason.
void append_to_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace gnomon
