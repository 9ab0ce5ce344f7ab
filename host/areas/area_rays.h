// Seeded rays of an influence area, distributed as a RayMeasure says: the thesis' ray casters. Not for rays
// that a renderer sends (host/scene/ray_set). Feeds benches, predictions' checks and tests.
#pragma once

#include <cstdint>
#include <vector>

#include "gnomon/areas/ray_measure.h"

namespace gnomon {

struct AreaRayOptions {
  RayStart start = RayStart::kWindow;
  bool stop_at_far_end = false;  // tmax where the ray leaves by the region's far end, else infinite
};

// `count` rays with unit directions and tmin 0; the same bits for the same seed, and ray i the same for every
// count. Rays from a window start 2^-22 of the window's largest coordinate further in than it, and at least
// as much inside its edges, so that rounding their origins to float leaves them in the region; those of
// kYawPitch beyond the frustum's sides stay outside it, as the measure says. Rays from an eye or centre start
// exactly there. Throws Error{kInvalidArgument} when the area has no such rays.
[[nodiscard]] std::vector<GnRay> area_rays(const InfluenceArea& area, RayMeasure measure, std::uint64_t count,
                                           std::uint64_t seed, const AreaRayOptions& options = {});

}  // namespace gnomon
