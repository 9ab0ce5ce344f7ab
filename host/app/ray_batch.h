// Rays of any kind, whatever they need traced first. Feeds `trace`, `validate` and `plan`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/device/trace_device.h"
#include "gnomon/scene/ray_record.h"
#include "gnomon/scene/ray_set.h"
#include "options.h"

namespace gnomon::app {

// `count` rays; bounce and shadow rays start where primary rays hit, so a batch of them can be smaller.
[[nodiscard]] std::vector<Ray> make_rays(RayKind kind, const Scene& scene, const Tracer& tracer,
                                         std::uint64_t count, std::uint64_t seed, const Progress& progress);

// The kinds' names, and a text for --help that explains them.
[[nodiscard]] std::vector<std::string> ray_kind_names();
[[nodiscard]] std::string explain_ray_kinds();

// Rays from a file instead: raw ones, or a record (scene/ray_record.h).
struct RayFileOptions {
  std::string file;
  std::vector<std::string> kinds;  // of a record's rays; empty: all
};
CLI::Option* add_ray_file_options(CLI::App& command, RayFileOptions& options);
// --rays KINDS, and the file's options instead.
void add_ray_kind_options(CLI::App& command, std::vector<std::string>& kinds, RayFileOptions& file);

struct NamedRays {
  std::string kind;  // "file" for raw ones
  std::vector<Ray> rays;
  std::uint64_t traced = 0;  // as a record says; 0 for raw ones
};
// One entry for each kind in the file. Throws Error: kBadScene (also for a file that cannot be read, and for
// kinds that it has no rays of), kInvalidArgument (kinds asked of raw rays), kOutOfMemory.
[[nodiscard]] std::vector<NamedRays> read_ray_file(const RayFileOptions& options);
// Whether only shadow rays are asked for.
[[nodiscard]] bool asks_shadow_only(const RayFileOptions& options);

}  // namespace gnomon::app
