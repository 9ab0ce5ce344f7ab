// The best builder in plain C++, one thread, the same decisions as the device's bit for bit: what that is
// tested against. Called by build_reference for Builder::kBest. Feeds tests and tools through it.
#pragma once

#include <cstdint>
#include <span>

#include "gnomon/tree/bvh.h"
#include "gnomon/tree/optimise.h"

namespace gnomon {

// Parts of triangles (parts.h), the balanced tree over them, and reinsertion (optimise.h). Throws Error:
// kInvalidArgument (options), kBadScene (as build_reference).
[[nodiscard]] Bvh build_best_reference(std::span<const GnTriangle> triangles, const BuildOptions& options);

// Parts beyond one for each triangle, as a share of the triangles, at most.
inline constexpr float kPartBudget = 0.3F;

// How the balanced tree is built and then optimised, for so many triangles with this scene's box.
[[nodiscard]] BuildOptions options_over_parts(const BuildOptions& options);
[[nodiscard]] OptimiseOptions optimise_options(const BuildOptions& options, std::uint64_t triangles,
                                               const float lo[3], const float hi[3]);

// How deep a best tree may be.
[[nodiscard]] std::uint32_t most_depth_of_best(const BuildOptions& options, std::uint64_t triangles);

}  // namespace gnomon
