// The rays of a long run: at corners and edges, along axes, from surfaces, anywhere, and bundles that run
// together. Feeds the soak and its tests.
#pragma once

#include "gnomon/stability/aim.h"
#include "gnomon/stability/soak.h"

namespace gnomon::stability {

// Draws the rays of one part. The n-th ray depends on seed and n alone, whatever the chunks. Of four times 64
// rays the last 64 are a bundle, so that packets are tried; the others are of mixed kinds.
class RaySource {
 public:
  static constexpr std::uint64_t kBundle = 64;  // the largest packet

  // The triangles must outlive it; there must be one at least.
  RaySource(std::span<const Triangle> triangles, std::uint64_t seed)
      : triangles_(triangles), extent_(extent_of(triangles)), size_(extent_.size()), seed_(seed) {}

  // Also counts in the part what the ray is aimed at.
  [[nodiscard]] Ray draw(std::uint64_t number, SoakPart& part) const;

 private:
  [[nodiscard]] Point target(std::uint32_t kind, SteadyRandom& random) const;
  [[nodiscard]] Point in_bounds(SteadyRandom& random) const;
  Ray at_place(std::uint32_t kind, bool exactly, SteadyRandom& random, SoakPart& part) const;
  Ray in_bundle(std::uint64_t bundle, SteadyRandom& random, SoakPart& part) const;
  Ray along_axes(SteadyRandom& random) const;
  Ray from_surface(SteadyRandom& random) const;
  Ray anywhere(SteadyRandom& random) const;

  std::span<const Triangle> triangles_;
  Extent extent_;
  float size_;
  std::uint64_t seed_;
};

}  // namespace gnomon::stability
