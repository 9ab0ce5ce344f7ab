#include "gnomon/render/path_reference.h"

#include "gnomon/render/path_scene.h"
#include "gnomon/shared/path_math.h"
#include "gnomon/tree/trace_reference.h"

namespace gnomon {
namespace {

bool is_any(const GnRay& ray) {
  return ray.tmin <= ray.tmax;
}

// Follows a path to its end.
void follow(const Scene& scene, const Bvh& bvh, const GnPathTables& tables, std::uint32_t max_bounces,
            GnPath& path, GnRay ray) {
  const auto trace = [&](const GnRay& one, bool any) {
    return trace_reference(bvh, scene.triangles, std::span(&one, 1), any).hits.front();
  };
  for (std::uint32_t bounce = 0; bounce < max_bounces && is_any(ray); ++bounce) {
    const GnHit hit = trace(ray, false);
    GnRay next{};
    GnRay shadow{};
    GnLit lit{};
    gn_path_step(&tables, &ray, &hit, bounce, &path, &next, &shadow, &lit);
    if (is_any(shadow) && trace(shadow, true).primitive == GN_NONE) {
      for (int k = 0; k < 3; ++k) path.radiance[k] += lit.radiance[k];
    }
    ray = next;
  }
}

}  // namespace

std::vector<std::array<float, 4>> path_reference(const Scene& scene, const Bvh& bvh,
                                                 const PathOptions& options, std::uint32_t samples) {
  const PathScene paths = make_path_scene(scene, options);
  const GnPathTables tables{&paths.frame,          scene.triangles.data(), scene.material_ids.data(),
                            paths.surfaces.data(), paths.lights.data(),    paths.light_rows.data(),
                            paths.emitters.data(), paths.links.data()};
  std::vector<std::array<float, 4>> film(std::size_t{options.width} * options.height);
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    for (std::uint32_t cell = 0; cell < paths.cells(); ++cell) {
      GnPath path{};
      GnRay ray{};
      gn_begin_path(&tables, cell, sample, &path, &ray);
      if (path.pixel == GN_NONE) continue;
      follow(scene, bvh, tables, options.max_bounces, path, ray);
      std::array<float, 4>& sum = film[path.pixel];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += path.radiance[k];
      sum[3] += path.seen != 0 ? 1.0F : 0.0F;
    }
  }
  return film;
}

}  // namespace gnomon
