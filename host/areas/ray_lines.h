// Rays as segments of lines in double precision, and a sample of them that does not depend on their order.
// Feeds detect and detect_lights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gnomon/areas/box.h"
#include "gnomon/shared/layout.h"

namespace gnomon {

// The points origin + t direction with begin <= t <= end. The direction has unit length, so t is a length;
// end may be infinite.
struct RayLine {
  Vec3d origin;
  Vec3d direction;
  double begin;
  double end;

  [[nodiscard]] Vec3d at(double t) const { return origin + t * direction; }
};

// Throws Error{kInvalidArgument} naming the first ray that has a NaN, an infinite origin or direction, or the
// direction zero. A ray whose tmax is below its tmin is empty: it becomes the point where it begins.
[[nodiscard]] std::vector<RayLine> lines_of(std::span<const GnRay> rays);

// At most `most` of the rays, every subset of that size about as likely as any other, in an order that only
// their values and the seed decide: rays in another order give the same. n log n.
[[nodiscard]] std::vector<GnRay> unordered_sample(std::span<const GnRay> rays, std::size_t most,
                                                  std::uint64_t seed);

// Around all origins and all finite ends; empty without rays.
[[nodiscard]] Box3d extent_of(std::span<const RayLine> lines);

// Ends of unbounded rays where they leave the bounds; where they begin if they never meet them.
void end_within(std::span<RayLine> lines, const Box3d& bounds);

}  // namespace gnomon
