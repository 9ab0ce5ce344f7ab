// The builder in plain C++, one thread, the same decisions as the device's bit for bit. Not fast and not
// meant to be: it is what the device builder is tested against, and what runs where no device is. Feeds tests
// and tools.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

using Triangle = GnTriangle;

// How the splits of a tree were found (the thesis' attempted planes, and how often its policies fell back).
struct SplitTally {
  std::uint64_t inner_nodes = 0;
  std::uint64_t axes_tried = 0;  // over all nodes of two triangles and more, of those that became leaves too
  std::array<std::uint64_t, 3> split_on{};     // inner nodes divided along x, y, z; by count along none
  std::array<std::uint64_t, 3> fallback_on{};  // inner nodes whose policy ended with the fallback on x, y, z
};

// Top-down binned SAH over all three axes (Wald 2007) with the constants of `options`, or what
// options.builder says (build_fast_reference.h, build_best_reference.h). Throws Error: kInvalidArgument
// (options), kBadScene (a coordinate that is not finite or beyond 2^48; names the triangle). `tally`, if
// given, is added to.
[[nodiscard]] Bvh build_reference(std::span<const Triangle> triangles, const BuildOptions& options = {},
                                  SplitTally* tally = nullptr);

// The balanced tree over boxes that may be parts of triangles; their indices become the leaf order.
[[nodiscard]] Bvh build_over_primitives(std::vector<GnPrimitive> primitives,
                                        std::span<const Triangle> triangles, const BuildOptions& options,
                                        SplitTally* tally = nullptr);

// Throws Error{kBadScene} saying that the triangle has a coordinate which is not finite or beyond 2^48.
[[noreturn]] void throw_bad_coordinate(std::uint32_t triangle);

// A triangle's box, without negative zeros. Throws as throw_bad_coordinate(index).
[[nodiscard]] GnPrimitive primitive_of(const Triangle& triangle, std::uint32_t index);

// Dense tree from nodes placed by split position: the children of a split at leaf position m stand at 2m and
// 2m + 1 of `sparse`, inner nodes link to 2m. is_split[m] says which m are splits. The root is sparse[0].
[[nodiscard]] std::vector<Node> compact_nodes(const std::vector<Node>& sparse,
                                              const std::vector<bool>& is_split);

}  // namespace gnomon
