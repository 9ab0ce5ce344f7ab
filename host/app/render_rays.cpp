#include "render_rays.h"

#include <algorithm>
#include <cmath>

namespace gnomon::app {
namespace {

// Paths of each of the two small pictures: several times the rays that plans take.
constexpr double kPaths = 4096.0;

struct Traced {
  std::vector<Ray> closest, any;
  double paths = 0.0;
};

// The same view, smaller, seen through other paths.
Traced small_picture(const cl::Context& context, const Tracer& tracer, const Scene& scene,
                     const RenderOptions& options, std::uint64_t seed, const Progress& progress) {
  const double pixels = static_cast<double>(options.width) * options.height;
  const double scale = std::min(1.0, std::sqrt(kPaths / pixels));
  const auto scaled = [&](std::uint32_t size) {
    return std::max(1U, static_cast<std::uint32_t>(std::lround(scale * size)));
  };
  PathOptions how;
  how.width = scaled(options.width);
  how.height = scaled(options.height);
  how.seed = seed;
  const std::uint32_t own = how.width * how.height;
  const auto samples = static_cast<std::uint32_t>(std::max(1.0, std::ceil(kPaths / own)));
  how.paths_at_once = own * samples;
  PathTracer paths(context, tracer, scene, how);
  Traced out;
  out.paths = static_cast<double>(own) * samples;
  paths.add_samples(samples, progress, [&](const TracedRays& traced) {
    std::vector<Ray>& to = traced.use == RayUse::kShadow ? out.any : out.closest;
    to.insert(to.end(), traced.rays.begin(), traced.rays.end());
  });
  return out;
}

}  // namespace

std::vector<PlanRays> rays_of_picture(const cl::Context& context, const Tracer& tracer, const Scene& scene,
                                      const RenderOptions& options, const Progress& progress) {
  const Traced fit = small_picture(context, tracer, scene, options, options.seed + 1, progress);
  const Traced probe = small_picture(context, tracer, scene, options, options.seed + 2, progress);
  const double times =
      static_cast<double>(options.width) * options.height * options.samples / (fit.paths + probe.paths);
  std::vector<PlanRays> out;
  const auto add = [&](const char* name, Query query, const std::vector<Ray>& a, const std::vector<Ray>& b) {
    if (a.empty() || b.empty()) return;
    out.push_back({name, query, a, b, times * static_cast<double>(a.size() + b.size())});
  };
  add("closest hit", Query::kClosest, fit.closest, probe.closest);
  add("light", Query::kAny, fit.any, probe.any);
  return out;
}

}  // namespace gnomon::app
