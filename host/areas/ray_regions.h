// The influence area that given rays really occupy: a box, a frustum or a ball about their segments. Feeds
// detect and detect_lights.
#pragma once

#include <optional>
#include <span>

#include "gnomon/areas/influence_area.h"
#include "gnomon/areas/ray_lines.h"

namespace gnomon {

// How tight: this share of the rays may stick out on each side, so that a few strays do not widen it. Ends
// must be finite (end_within). All return nothing without rays, or where coordinates overflow.

// A box along the direction, turned about it as is narrowest; the world's up is kept where turning saves less
// than a twentieth.
[[nodiscard]] std::optional<InfluenceArea> box_about(std::span<const RayLine> lines, const Vec3d& direction,
                                                     double outside);

// A frustum from the apex over what the segments are on one side of it, that of most of their length; a ball
// about the apex where they are seen from it wider than 150 degrees. A frustum begins at least 2^-10 of its
// reach from the apex.
[[nodiscard]] std::optional<InfluenceArea> frustum_about(std::span<const RayLine> lines, const Vec3d& apex,
                                                         double outside);

// The share of the segments that are in the area whole; what is nearer to an apex than its frustum begins
// does not count.
[[nodiscard]] double share_inside(const InfluenceArea& area, std::span<const RayLine> lines);

}  // namespace gnomon
