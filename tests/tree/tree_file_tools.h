// Tree files taken apart and damaged by the layout of host/notes/tree-file.md, without the library's own
// writer. Feeds the tests of tree files.
#pragma once

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/tree_file.h"
#include "support/shapes.h"

namespace gnomon::test {

using FileBytes = std::vector<std::byte>;

inline constexpr std::size_t kHeaderBytes = 256;
inline constexpr std::size_t kFileBytesAt = 16;
inline constexpr std::size_t kChecksumAt = 24;
inline constexpr std::size_t kHashedFrom = 32;
inline constexpr std::size_t kTrianglesAt = 40;
inline constexpr std::size_t kNodesAt = 44;
inline constexpr std::size_t kOrderAt = 48;

template <typename T>
T value_at(const FileBytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

template <typename T>
void set_at(FileBytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

// What stands for the rest, made to fit it again, so that damage is not noticed by that.
inline void settle(FileBytes& bytes) {
  if (bytes.size() < kHeaderBytes) return;
  set_at<std::uint64_t>(bytes, kFileBytesAt, bytes.size());
  set_at<std::uint64_t>(bytes, kChecksumAt,
                        XXH3_64bits(bytes.data() + kHashedFrom, bytes.size() - kHashedFrom));
}

struct KeptShape {
  std::string name;
  std::vector<GnTriangle> triangles;
  BuildOptions options;
};

// Trees of every builder, with leaves large and small, and those of nothing and of one triangle.
inline std::vector<KeptShape> kept_shapes() {
  std::vector<KeptShape> shapes{{"none", {}, {}},
                                {"one", soup(1, 1), {}},
                                {"two", soup(2, 5), {}},
                                {"soup", soup(90, 2), {}},
                                {"grid", grid(6), {}},
                                {"fast", soup(90, 3), {}},
                                {"best", soup(90, 4, 4.0F), {}},
                                {"published", soup(70, 6), {}}};
  for (std::size_t i = 2; i < 5; ++i) shapes[i].options.max_leaf_size = static_cast<std::uint32_t>(i - 1);
  shapes[5].options.builder = Builder::kFast;
  shapes[6].options.builder = Builder::kBest;
  shapes[7].options.published_leaves.on = true;
  shapes[7].options.axes = AxisPolicy::kLsph;
  return shapes;
}

inline FileBytes file_of(const KeptShape& shape) {
  return tree_to_bytes(build_reference(shape.triangles, shape.options), shape.options, shape.triangles);
}

}  // namespace gnomon::test
