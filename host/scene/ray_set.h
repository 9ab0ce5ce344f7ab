// Seeded batches of rays of the kinds a renderer sends. Not for tracing them: secondary kinds take the
// primary hits as input. Feeds trace, validate, benches and tests.
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
  kParallel,  // along the scene's first directional light (else -y), starting on a plane outside the bounds
};
[[nodiscard]] std::string_view to_string(RayKind kind);
[[nodiscard]] std::optional<RayKind> ray_kind_from(std::string_view name);
// Shadow and parallel rays ask only whether anything is hit.
[[nodiscard]] bool asks_any_hit(RayKind kind);
// Neighbours in such a batch run through one point or one way: from a camera, along a sun, to a scene's only
// light where that is no area.
[[nodiscard]] bool run_together(RayKind kind, const Scene& scene);

// A camera that sees the whole scene from outside, for scenes without one.
[[nodiscard]] Camera default_camera(const Scene& scene);

// Rays that need no hits: primary, random, parallel. Directions are unit, tmin 0, tmax infinite. Primary and
// parallel ones walk a grid of nearly square cells in Morton order, one seeded point per cell; `count` is met
// exactly by leaving out cells evenly.
[[nodiscard]] std::vector<Ray> primary_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);
[[nodiscard]] std::vector<Ray> random_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);
[[nodiscard]] std::vector<Ray> parallel_rays(const Scene& scene, std::uint64_t count, std::uint64_t seed);

// Rays that start at the hits of primary ones (offset 1e-5 of the bounds' diagonal along the normal on the
// side the ray came from), in primary order: one per hit, thinned evenly to at most `count`, none for misses.
// Throws Error{kInvalidArgument} when hits and rays differ in number or a hit names no triangle of the scene.
// A shadow ray goes to a light chosen by the seed, or the next that can reach the place: in front of the
// surface, within its range and cone; where none can, there is no ray. It ends at the light (tmax 0.9999 of
// the distance, infinite for directional ones); on area lights at a random point. A scene without lights
// counts as lit by a sun that travels along (-0.4, -0.8, -0.45).
[[nodiscard]] std::vector<Ray> bounce_rays(const Scene& scene, std::span<const Ray> primary,
                                           std::span<const Hit> hits, std::uint64_t count,
                                           std::uint64_t seed);
[[nodiscard]] std::vector<Ray> shadow_rays(const Scene& scene, std::span<const Ray> primary,
                                           std::span<const Hit> hits, std::uint64_t count,
                                           std::uint64_t seed);

// Raw little-endian files: 32-byte rays, 16-byte hits (layout.h), nothing else.
// Throws Error{kIo} or Error{kBadScene} (size not a multiple of the record).
[[nodiscard]] std::vector<Ray> read_rays(const std::filesystem::path& file);
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);
void write_hits(const std::filesystem::path& file, std::span<const Hit> hits);

}  // namespace gnomon
