#include "gnomon/compare/batch.h"

#include <algorithm>

#include "gnomon/areas/area_rays.h"
#include "gnomon/compare/method.h"

namespace gnomon::compare {
namespace {

constexpr const char* kLight = "light";

std::vector<Ray> rays_of_light(const Scene& scene, std::uint64_t count, std::uint64_t seed) {
  const auto light = first_light(scene);
  return light ? area_rays(light->area, light->measure, count, seed) : std::vector<Ray>{};
}

std::vector<Ray> rays_of_file(const std::string& file, std::uint64_t count) {
  std::vector<Ray> rays;
  try {
    rays = read_rays(file);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kIo) throw;
    throw Error(ErrorCode::kBadScene,
                std::string(error.what()) +
                    "\nkinds of rays are primary, bounce, shadow, random, parallel and light; "
                    "anything else is a file of rays");
  }
  if (rays.size() <= count) return rays;
  std::vector<Ray> thinned;
  for (std::uint64_t i = 0; i < count; ++i) thinned.push_back(rays[i * rays.size() / count]);
  return thinned;
}

std::vector<Ray> rays_of_kind(RayKind kind, const Scene& scene, const FindHits& closest, std::uint64_t count,
                              std::uint64_t seed) {
  if (kind == RayKind::kRandom) return random_rays(scene, count, seed);
  if (kind == RayKind::kParallel) return parallel_rays(scene, count, seed);
  std::vector<Ray> primary = primary_rays(scene, count, seed);
  if (kind == RayKind::kPrimary) return primary;
  const std::vector<Hit> hits = closest(primary);
  return kind == RayKind::kBounce ? bounce_rays(scene, primary, hits, count, seed)
                                  : shadow_rays(scene, primary, hits, count, seed);
}

}  // namespace

bool is_ray_kind(const std::string& kind) {
  return kind == kLight || ray_kind_from(kind).has_value();
}

void check_kind(const std::string& kind) {
  if (!is_ray_kind(kind)) static_cast<void>(rays_of_file(kind, 1));
}

std::vector<std::string> default_kinds() {
  return {"primary", "bounce", "shadow", "random", kLight};
}

bool is_any_hit(const std::string& kind) {
  const auto known = ray_kind_from(kind);
  return known && asks_any_hit(*known);
}

std::vector<Ray> draw_rays(const Scene& scene, const FindHits& closest, const std::string& kind,
                           std::uint64_t count, std::uint64_t seed) {
  if (const auto known = ray_kind_from(kind)) return rays_of_kind(*known, scene, closest, count, seed);
  return kind == kLight ? rays_of_light(scene, count, seed) : rays_of_file(kind, count);
}

Batch make_batch(const cl::Context& context, const Scene& scene, const FindHits& closest,
                 const std::string& kind, std::uint64_t count, std::uint64_t seed) {
  Batch batch;
  batch.kind = kind;
  batch.any_hit = is_any_hit(kind);
  batch.rays = draw_rays(scene, closest, kind, count, seed);
  if (batch.rays.empty()) return batch;
  batch.device_rays = context.create_buffer("rays", batch.rays.size() * sizeof(Ray));
  batch.device_answers = context.create_buffer("answers", batch.rays.size() * sizeof(Hit));
  context.upload_values<Ray>(batch.device_rays, batch.rays);
  return batch;
}

}  // namespace gnomon::compare
