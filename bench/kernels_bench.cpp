// The question: what would other kernels gain in speed, and cost in hits? Those of a folder beside the embedded
// ones, in one process: the time of a batch, and answers held against the embedded kernels', which are exact. One
// JSON row for each scene, kind of rays and flavour on stdout; then one for each case of the stability catalogue.
//
//   kernels_bench FOLDER [SCENE TRIANGLES]...
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "contest.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/stability/catalogue.h"
#include "gnomon_commit.h"

namespace {

using gnomon::Hit;
using gnomon::Ray;
using namespace gnomon::bench;

constexpr std::uint64_t kSeed = 1;
constexpr std::uint64_t kRays = 131'072;
constexpr int kRounds = 9;

// Kernels are read where a tracer is made.
gnomon::Tracer tracer_of(const gnomon::cl::Context& context, const gnomon::DeviceBvh& tree,
                         gnomon::TraceFlavour flavour, const std::string& folder) {
  gnomon::TraceOptions options;
  options.flavour = flavour;
  if (!folder.empty()) setenv("GNOMON_KERNELS", folder.c_str(), 1);
  gnomon::Tracer tracer(context, tree, options);
  unsetenv("GNOMON_KERNELS");
  return tracer;
}

struct Differences {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  std::uint64_t lost = 0;
  std::uint64_t added = 0;
  std::uint64_t other_triangle = 0;  // at another distance
  double most_ulp = 0.0;             // of t, where the triangle is the same
};

void compare(const std::vector<Hit>& exact, const std::vector<Hit>& other, Differences& sum) {
  sum.rays += exact.size();
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const bool hit = exact[i].primitive != GN_NONE;
    const bool found = other[i].primitive != GN_NONE;
    sum.hits += hit ? 1 : 0;
    sum.lost += hit && (!found || other[i].t > exact[i].t * 1.0001F) ? 1 : 0;
    sum.added += !hit && found ? 1 : 0;
    if (!hit || !found) continue;
    if (exact[i].primitive != other[i].primitive) {
      sum.other_triangle += exact[i].t != other[i].t ? 1 : 0;
    } else if (exact[i].t != 0.0F) {
      const double ulp = std::ldexp(1.0, std::ilogb(exact[i].t) - 23);
      sum.most_ulp = std::max(sum.most_ulp, std::fabs(static_cast<double>(exact[i].t) - other[i].t) / ulp);
    }
  }
}

json to_json(const Differences& d) {
  return {{"rays", d.rays},
          {"hits", d.hits},
          {"lost", d.lost},
          {"added", d.added},
          {"other_triangle", d.other_triangle},
          {"most_t_ulp", d.most_ulp}};
}

struct Folder {
  const gnomon::cl::Context& context;
  std::string path;

  [[nodiscard]] json start(const char* kind) const {
    return {{"schema", 1},
            {"bench", "kernels"},
            {"kind", kind},
            {"commit", GNOMON_COMMIT},
            {"device", context.device().name},
            {"driver", context.device().driver},
            {"folder", path}};
  }

  void speed(const gnomon::Scene& scene, const std::string& name, const gnomon::DeviceBvh& tree,
             const std::string& rays_name, const std::vector<Ray>& rays, bool any) const {
    for (const auto flavour : {gnomon::TraceFlavour::kWide, gnomon::TraceFlavour::kPacket}) {
      const gnomon::Tracer exact = tracer_of(context, tree, flavour, "");
      const gnomon::Tracer other = tracer_of(context, tree, flavour, path);
      const auto count = static_cast<std::uint32_t>(rays.size());
      const auto in = context.create_buffer("rays", rays.size() * sizeof(Ray));
      const auto out = context.create_buffer("answers", rays.size() * sizeof(Hit));
      context.upload_values<Ray>(in, rays);
      const auto work = [&](const gnomon::Tracer& tracer) {
        return [&] {
          gnomon::cl::wait(any ? tracer.enqueue_any(in.mem.get(), out.mem.get(), count)
                               : tracer.enqueue_closest(in.mem.get(), out.mem.get(), count));
        };
      };
      std::vector<Contestant> contest{{"embedded", work(exact)}, {"folder", work(other)}};
      run_contest(contest, kRounds);
      Differences differences;
      compare(exact.closest(rays).hits, other.closest(rays).hits, differences);
      json row = start("speed");
      row.update({{"scene", name},
                  {"scene_hash", gnomon::scene_hash(scene)},
                  {"triangles", scene.triangles.size()},
                  {"seed", kSeed},
                  {"rays_kind", rays_name},
                  {"task", any ? "any hit" : "closest hit"},
                  {"flavour", to_string(flavour)},
                  {"clock", "process CPU time"},
                  {"threads", 1},
                  {"ratio", spread_json(speed_ratios(contest[1].cpu_seconds, contest[0].cpu_seconds))},
                  {"closest", to_json(differences)}});
      std::printf("%s\n", row.dump().c_str());
      std::fflush(stdout);
    }
  }

  void run(const std::string& name, std::uint64_t triangles) const {
    const gnomon::Scene scene = gnomon::generate_scene(name, triangles, kSeed);
    const gnomon::DeviceBvh tree = gnomon::build_device(context, scene.triangles);
    const std::vector<Ray> primary = gnomon::primary_rays(scene, kRays, kSeed);
    const std::vector<Hit> hits =
        tracer_of(context, tree, gnomon::TraceFlavour::kWide, "").closest(primary).hits;
    speed(scene, name, tree, "primary", primary, false);
    speed(scene, name, tree, "bounce", gnomon::bounce_rays(scene, primary, hits, kRays, kSeed), false);
    speed(scene, name, tree, "shadow", gnomon::shadow_rays(scene, primary, hits, kRays, kSeed), true);
    speed(scene, name, tree, "random", gnomon::random_rays(scene, kRays, kSeed), false);
  }

  void hard_cases() const {
    for (const auto& info : gnomon::stability::catalogue()) {
      for (const auto flavour : {gnomon::TraceFlavour::kWide, gnomon::TraceFlavour::kPacket}) {
        Differences sum;
        for (const auto& specimen : gnomon::stability::specimens_of(context, info.number, {})) {
          const gnomon::DeviceBvh tree = gnomon::build_device(context, specimen.triangles);
          compare(tracer_of(context, tree, flavour, "").closest(specimen.rays).hits,
                  tracer_of(context, tree, flavour, path).closest(specimen.rays).hits, sum);
        }
        if (sum.rays == 0) continue;
        json row = start("case");
        row.update(
            {{"case", info.number}, {"name", info.name}, {"flavour", to_string(flavour)}, {"closest", to_json(sum)}});
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
      }
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: kernels_bench FOLDER [SCENE TRIANGLES]...\n");
    return 2;
  }
  try {
    const gnomon::cl::Context context = one_thread_context();
    const Folder folder{context, argv[1]};
    SceneList scenes = scenes_from(argc - 1, argv + 1);
    if (argc == 2) scenes = {{"atrium", 1'000'000}, {"city", 300'000}, {"crowd", 300'000}, {"random", 100'000}};
    for (const auto& [name, triangles] : scenes) folder.run(name, triangles);
    folder.hard_cases();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kernels_bench: %s\n", error.what());
    return 1;
  }
}
