// Triangles just outside an area, which its local tree does not have: whoever trusts that tree a rounding too
// far loses them. Feeds the cases of areas.
#pragma once

#include "gnomon/areas/influence_area.h"
#include "gnomon/stability/meshes.h"

namespace gnomon::stability {

// Large triangles across every face (of a ball: across twelve directions), from 2^-6 to 2^-24 of the region's
// size outside it.
[[nodiscard]] Triangles layers_around(const InfluenceArea& area, std::uint64_t seed);

// From about the region's middle at every layer.
[[nodiscard]] std::vector<Ray> rays_at_layers(const InfluenceArea& area, const Triangles& layers,
                                              std::uint32_t count, std::uint64_t seed);

}  // namespace gnomon::stability
