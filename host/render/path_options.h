// What a path tracer is asked for. Feeds path_tracer.h and path_reference.h.
#pragma once

#include <cstdint>
#include <optional>

#include "gnomon/scene/scene.h"

namespace gnomon {

// How light that a surface could get from an area light or the sky is found. All three have the same mean;
// points and suns are always asked, since no scattered ray meets them.
enum class PathStrategy : std::uint32_t {
  kBoth,      // multiple importance sampling: each finding weighed against the other's chance of it; the sky
              // is left to scattering
  kLights,    // by rays drawn towards lights
  kSurfaces,  // by rays that the surface scatters
};

struct PathOptions {
  std::uint32_t width = 1280;  // pixels, 1..16384
  std::uint32_t height = 720;  // width times height up to 2^26
  std::uint64_t seed = 1;      // equal seeds, equal pictures to the last bit
  // Surfaces on a path at most, 1..1024. What longer paths would bring is missing; roulette ends nearly all
  // before.
  std::uint32_t max_bounces = 64;
  // Surfaces before paths may end by chance (Russian roulette, by the largest component of what is left).
  std::uint32_t roulette_after = 3;
  PathStrategy strategy = PathStrategy::kBoth;
  // Radiance of the sky, from all sides alike. Default: a blue sky as bright as the scene's lights suggest.
  std::optional<Vec3> sky;
  // How the device works; the picture does not depend on them.
  std::uint32_t paths_at_once = 0;  // 0: as suits the device
  std::uint32_t work_group_size = 64;

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

}  // namespace gnomon
