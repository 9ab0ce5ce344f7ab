// The path tracer in plain C++, one path after another to its end: what the device's wavefronts are tested
// against. Not fast. Feeds tests.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gnomon/render/path_options.h"
#include "gnomon/tree/bvh.h"

namespace gnomon {

// Sums over `samples` samples, as PathTracer::film(), to the last bit where hits are
// (host/notes/exact-hits.md). bvh: over scene.triangles. Throws as options.check().
[[nodiscard]] std::vector<std::array<float, 4>> path_reference(const Scene& scene, const Bvh& bvh,
                                                               const PathOptions& options,
                                                               std::uint32_t samples);

}  // namespace gnomon
