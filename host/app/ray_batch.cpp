#include "ray_batch.h"

namespace gnomon::app {

std::vector<Ray> make_rays(RayKind kind, const Scene& scene, const Tracer& tracer, std::uint64_t count,
                           std::uint64_t seed, const Progress& progress) {
  if (kind == RayKind::kRandom) return random_rays(scene, count, seed);
  if (kind == RayKind::kParallel) return parallel_rays(scene, count, seed);
  std::vector<Ray> primary = primary_rays(scene, count, seed);
  if (kind == RayKind::kPrimary) return primary;
  const TraceResult traced = tracer.closest(primary, progress);
  return kind == RayKind::kBounce ? bounce_rays(scene, primary, traced.hits, count, seed)
                                  : shadow_rays(scene, primary, traced.hits, count, seed);
}

std::vector<Ray> read_ray_file(const std::string& file) {
  try {
    return read_rays(file);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kIo) throw Error(ErrorCode::kBadScene, error.what());
    throw;
  }
}

std::vector<std::string> ray_kind_names() {
  std::vector<std::string> names;
  for (const RayKind kind :
       {RayKind::kPrimary, RayKind::kBounce, RayKind::kShadow, RayKind::kRandom, RayKind::kParallel}) {
    names.emplace_back(to_string(kind));
  }
  return names;
}

std::string explain_ray_kinds() {
  return "Kinds of rays:\n"
         "  primary   from the scene's first camera through a picture\n"
         "  bounce    from where primary rays hit, into the hemisphere, cosine-weighted\n"
         "  shadow    from where primary rays hit to the lights (any hit)\n"
         "  random    from anywhere in the bounds to anywhere\n"
         "  parallel  all along the sun's direction, from outside (any hit)\n";
}

}  // namespace gnomon::app
