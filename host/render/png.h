// Pictures as PNG files. Feeds the command line.
#pragma once

#include <filesystem>
#include <vector>

#include "gnomon/render/picture.h"

namespace gnomon {

// The file's bytes: 8-bit RGB. Throws Error{kOutOfMemory}.
[[nodiscard]] std::vector<std::byte> encode_png(const RgbImage& image);

// Writes them by way of a temporary beside the file, so that an interrupted run leaves no half picture.
// Throws Error{kIo}.
void write_png(const RgbImage& image, const std::filesystem::path& file);

}  // namespace gnomon
