// Frames that a tree's boxes may stand in instead of the world's: z along a light's rays, say, so that boxes
// are long where rays run and narrow across (host/notes/light-space.md). The tree is that of turned
// triangles; the triangles themselves, and hits, stay as they are. Not for trees whose triangles move, files
// or exports, which refuse such trees. Feeds plans, trees, tracers.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/tree/bvh.h"

namespace gnomon {

// z along `direction`, of any length but 0; x at a right angle to one of the world's axes too, so that what
// stands along that is narrow: the axis by which triangles' boxes, seen along z, are smallest together.
// Throws Error{kInvalidArgument} for a direction that is zero or not finite.
[[nodiscard]] BoxFrame frame_along(const std::array<double, 3>& direction,
                                   std::span<const GnTriangle> triangles);

[[nodiscard]] std::vector<GnTriangle> turned(std::span<const GnTriangle> triangles, const BoxFrame& frame);
// Rays as turned triangles' tree sees them but for rounding: what trees are fitted to, not what is traced.
[[nodiscard]] std::vector<GnRay> turned(std::span<const GnRay> rays, const BoxFrame& frame);

// What is wrong with a frame for these triangles, or nothing: rows beyond what gnomon/shared/box_frame.h
// asks for, a size that is too small.
[[nodiscard]] std::optional<std::string> fault_of(const BoxFrame& frame,
                                                  std::span<const GnTriangle> triangles);

// Throws Error{kInvalidArgument} where there is a frame: `what` takes no such trees.
void refuse_frame(const std::optional<BoxFrame>& frame, const std::string& what);

}  // namespace gnomon
