// The rays that all methods of a comparison trace. Feeds run_device.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gnomon/device/trace_device.h"
#include "gnomon/scene/ray_set.h"

namespace gnomon::compare {

// Rays on the host, and on the device with room for their answers.
struct Batch {
  std::string kind;
  bool any_hit = false;  // what is timed; accuracy is judged by both queries
  std::vector<Ray> rays;
  cl::Buffer device_rays;
  cl::Buffer device_answers;
};

// What may be asked for: the kinds of RayKind, "light" (rays of the first light that has an area, as its
// heuristics expect them), or a file of rays, by its name.
[[nodiscard]] bool is_ray_kind(const std::string& kind);
[[nodiscard]] std::vector<std::string> default_kinds();

// Throws Error{kBadScene} for what is neither a kind nor a file of rays.
void check_kind(const std::string& kind);

// Closest hits of rays, in their order.
using FindHits = std::function<std::vector<Hit>(std::span<const Ray>)>;

// Whether rays of that kind ask for any hit; a file's ask for the closest.
[[nodiscard]] bool is_any_hit(const std::string& kind);

// At most `count` rays, the same for the same seed; empty where the scene has none of that kind. `closest`
// finds the hits that bounce and shadow rays start from. A file's rays are thinned evenly. Throws Error:
// kInvalidArgument, kBadScene (a file that is none).
[[nodiscard]] std::vector<Ray> draw_rays(const Scene& scene, const FindHits& closest, const std::string& kind,
                                         std::uint64_t count, std::uint64_t seed);
// The same, on the device too. Throws Error also: kDevice, kOutOfMemory.
[[nodiscard]] Batch make_batch(const cl::Context& context, const Scene& scene, const FindHits& closest,
                               const std::string& kind, std::uint64_t count, std::uint64_t seed);

}  // namespace gnomon::compare
