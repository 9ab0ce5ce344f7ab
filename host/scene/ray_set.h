// Seeded batches of rays of the kinds a renderer sends. Not for tracing them: secondary kinds take the primary hits
// as input. Feeds trace, validate, benches and tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gnomon/scene/scene.h"

namespace gnomon {

using Ray = GnRay;
using Hit = GnHit;

enum class RayKind {
  kPrimary,   // pinhole, from the scene's first camera, Morton order over pixels
  kBounce,    // cosine-weighted about the normal at primary hits
  kShadow,    // from primary hits to the scene's lights (any hit), in primary order
  kRandom,    // uniform origins in the bounds, uniform directions
  kParallel,  // towards the scene's first directional light (else -y), starting on a plane outside the bounds
};
[[nodiscard]] std::string_view to_string(RayKind kind);
[[nodiscard]] std::optional<RayKind> ray_kind_from(std::string_view name);
// Shadow and parallel rays ask only whether anything is hit.
[[nodiscard]] bool asks_any_hit(RayKind kind);

// A camera that sees the whole scene from outside, for scenes without one.
[[nodiscard]] Camera default_camera(const Scene& scene);

// Rays that need no hits: primary, random, parallel. Directions are unit, tmin 0.
[[nodiscard]] std::vector<Ray> primary_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);
[[nodiscard]] std::vector<Ray> random_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);
[[nodiscard]] std::vector<Ray> parallel_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);

// Rays that start at the hits of primary ones (offset 1e-5 of the bounds' diagonal along the normal on the side the
// ray came from): at most `count`, none for misses. Shadow rays end at the light (tmax 0.9999 of the distance, infinite for the sun).
[[nodiscard]] std::vector<Ray> bounce_rays(const Scene& scene, std::span<const Ray> primary, std::span<const Hit> hits,
                                           std::uint64_t count, std::uint64_t seed);
[[nodiscard]] std::vector<Ray> shadow_rays(const Scene& scene, std::span<const Ray> primary, std::span<const Hit> hits,
                                           std::uint64_t count, std::uint64_t seed);

// Raw little-endian files: 32-byte rays, 16-byte hits (layout.h), nothing else.
// Throws Error{kIo} or Error{kBadScene} (size not a multiple of the record).
[[nodiscard]] std::vector<Ray> read_rays(const std::filesystem::path& file);
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);
void write_hits(const std::filesystem::path& file, std::span<const Hit> hits);

}  // namespace gnomon
