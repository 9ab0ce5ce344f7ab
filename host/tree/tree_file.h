// A binary tree in a file of its own, with what it was built from and how: written once, traced many times,
// on any machine. Not for other programs' layouts (tree_export.h). Feeds the command line and callers who
// keep trees. The layout, byte by byte: host/notes/tree-file.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

struct StoredTree {
  Bvh bvh;
  BuildOptions options;  // those that decide the tree; how a device worked is not kept
  bool fitted = false;  // to rays, by a plan: then the options are where it began, and do not decide it alone
};

// The file's bytes: the same tree, options and triangles give the same bytes. Throws Error{kInvalidArgument}
// for a tree that is not one over these triangles by check_bvh, which a reader would refuse.
[[nodiscard]] std::vector<std::byte> tree_to_bytes(const Bvh& bvh, const BuildOptions& options,
                                                   std::span<const GnTriangle> triangles,
                                                   bool fitted = false);

// Any bytes may come in; what comes out has passed check_bvh over these triangles. Memory asked for is at
// most a small multiple of what comes in. Throws Error{kBadScene}: not a tree file, of another version, cut
// off or damaged, or made for other triangles, saying which.
[[nodiscard]] StoredTree tree_from_bytes(std::span<const std::byte> bytes,
                                         std::span<const GnTriangle> triangles);

// The same to and from a file. Saving replaces it whole or not at all. Throw the same, and Error: kIo with
// path and reason, kOutOfMemory.
void save_tree(const std::filesystem::path& file, const Bvh& bvh, const BuildOptions& options,
               std::span<const GnTriangle> triangles, bool fitted = false);
[[nodiscard]] StoredTree load_tree(const std::filesystem::path& file, std::span<const GnTriangle> triangles);

}  // namespace gnomon
