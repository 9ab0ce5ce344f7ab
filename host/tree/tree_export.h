// A tree as other programs take one: boxes with two children side by side, the leaves' indices, the
// triangles. Not for reading back (tree_file.h). Feeds the command line. The layout, and which programs take
// it how: host/notes/tree-file.md; tests/consumer/read_bvh2.cpp reads one without gnomon.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// 32 bytes of header, then 32 a node, 4 an index, 36 a triangle. The tree must be sound over the triangles
// (check_bvh). Nodes are numbered anew: the root is 0, 1 is unused, so that siblings share 64 aligned bytes,
// and children come after their parents.
[[nodiscard]] std::vector<std::byte> bvh2_bytes(const Bvh& bvh, std::span<const GnTriangle> triangles);

// Throws Error{kIo}; replaces the file whole or not at all.
void export_bvh2(const std::filesystem::path& file, const Bvh& bvh, std::span<const GnTriangle> triangles);

}  // namespace gnomon
