// Corners of a triangle soup, each kept once. Not for welding: only bitwise equal corners are one. Feeds
// gltf_export.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

struct CornerIndex {
  std::vector<Vec3> positions;         // in order of first use
  std::vector<std::uint32_t> indices;  // three per triangle
};

// Indexes the triangles named by `members`, in that order. -0 and 0 stay apart: the bits are what is
// compared.
[[nodiscard]] CornerIndex index_corners(std::span<const Triangle> triangles,
                                        std::span<const std::uint32_t> members);

}  // namespace gnomon
