// Where samples lie: well-spread points of the unit square for every pixel and purpose. Feeds the picture's
// jitter, light points and sky directions.
#pragma once

#include <cstdint>

#include "gnomon/render/vector_math.h"

namespace gnomon {

// The `index`-th point of the sequence that belongs to this pixel and purpose, in [0, 1)^2. Consecutive
// indices fill the square evenly (additive recurrence on the plastic number, Roberts 2018); pixels and
// purposes are shifted against each other at random (Cranley and Patterson 1976). The same arguments give the
// same point on every machine.
[[nodiscard]] Point2 sample_point(std::uint64_t seed, std::uint64_t pixel, std::uint32_t purpose,
                                  std::uint32_t index);

// Cosine-weighted direction about a unit normal (Malley: a point of the disc, raised to the hemisphere).
[[nodiscard]] Point cosine_direction(const Point& normal, const Point2& sample);

}  // namespace gnomon
