// The question: what does fast accuracy gain in speed, and what does it cost in hits? Beside watertight
// tracing of the same rays in one process: the time of a batch, and answers held against the exact ones. One
// JSON row for each scene, kind of rays and flavour on stdout; then one for each case of the stability
// catalogue.
//
//   accuracy_bench [SCENE TRIANGLES]...
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "contest.h"
#include "gnomon/cl/launch.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/stability/catalogue.h"
#include "gnomon/tree/hit_difference.h"
#include "gnomon_commit.h"

namespace {

using gnomon::Hit;
using gnomon::Ray;
using namespace gnomon::bench;

constexpr const char* kHelp =
    "accuracy_bench: what fast accuracy gains in speed, and what it costs in hits\n\n"
    "  accuracy_bench [SCENE TRIANGLES]...\n\n"
    "Beside watertight tracing of the same rays, one thread, processor time. One JSON row a scene, kind of "
    "rays and flavour\n"
    "on stdout, then one a case of the stability catalogue.\n\n"
    "  SCENE   a generated scene (gnomon scene --help names them); default: atrium 300000, city and crowd "
    "100000, random\n"
    "          50000\n\n"
    "GNOMON_DEVICE chooses another device.\n"
    "Example:  accuracy_bench cottage 20000\n";
constexpr std::uint64_t kSeed = 1;
constexpr std::uint64_t kRays = 131'072;
constexpr int kRounds = 9;

constexpr gnomon::TraceFlavour kFlavours[] = {gnomon::TraceFlavour::kWide, gnomon::TraceFlavour::kPacket};

gnomon::Tracer tracer_of(const gnomon::cl::Context& context, const gnomon::DeviceBvh& tree,
                         gnomon::TraceFlavour flavour, gnomon::Accuracy accuracy) {
  gnomon::TraceOptions options;
  options.flavour = flavour;
  options.accuracy = accuracy;
  return {context, tree, options};
}

json to_json(const gnomon::HitDifference& d) {
  return {{"rays", d.rays},
          {"hits", d.hits},
          {"lost", d.lost},
          {"added", d.added},
          {"other_triangle", d.other_triangle},
          {"max_t_ulp", d.max_t_ulp}};
}

struct Runs {
  const gnomon::cl::Context& context;

  [[nodiscard]] json start(const char* kind) const {
    return {{"schema", 1},
            {"bench", "accuracy"},
            {"kind", kind},
            {"commit", GNOMON_COMMIT},
            {"device", context.device().name},
            {"driver", context.device().driver}};
  }

  void speed(const gnomon::Scene& scene, const std::string& name, const gnomon::DeviceBvh& tree,
             const std::string& rays_name, const std::vector<Ray>& rays, bool any) const {
    for (const auto flavour : kFlavours) {
      const gnomon::Tracer exact = tracer_of(context, tree, flavour, gnomon::Accuracy::kWatertight);
      const gnomon::Tracer fast = tracer_of(context, tree, flavour, gnomon::Accuracy::kFast);
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
      std::vector<Contestant> contest{{"watertight", work(exact)}, {"fast", work(fast)}};
      run_contest(contest, kRounds);
      const auto cost = any ? gnomon::difference_of(exact.any(rays).occluded, fast.any(rays).occluded)
                            : gnomon::difference_of(exact.closest(rays).hits, fast.closest(rays).hits);
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
                  {"cost", to_json(cost)}});
      std::printf("%s\n", row.dump().c_str());
      std::fflush(stdout);
    }
  }

  void run(const std::string& name, std::uint64_t triangles) const {
    const gnomon::Scene scene = gnomon::generate_scene(name, triangles, kSeed);
    const gnomon::DeviceBvh tree = gnomon::build_device(context, scene.triangles);
    const std::vector<Ray> primary = gnomon::primary_rays(scene, kRays, kSeed);
    const std::vector<Hit> hits =
        tracer_of(context, tree, kFlavours[0], gnomon::Accuracy::kWatertight).closest(primary).hits;
    speed(scene, name, tree, "primary", primary, false);
    speed(scene, name, tree, "bounce", gnomon::bounce_rays(scene, primary, hits, kRays, kSeed), false);
    speed(scene, name, tree, "shadow", gnomon::shadow_rays(scene, primary, hits, kRays, kSeed), true);
    speed(scene, name, tree, "random", gnomon::random_rays(scene, kRays, kSeed), false);
  }

  void hard_cases() const {
    for (const auto& info : gnomon::stability::catalogue()) {
      for (const auto flavour : kFlavours) {
        gnomon::HitDifference sum;
        for (const auto& specimen : gnomon::stability::specimens_of(context, info.number, {})) {
          const gnomon::DeviceBvh tree = gnomon::build_device(context, specimen.triangles);
          const auto cost = gnomon::difference_of(
              tracer_of(context, tree, flavour, gnomon::Accuracy::kWatertight).closest(specimen.rays).hits,
              tracer_of(context, tree, flavour, gnomon::Accuracy::kFast).closest(specimen.rays).hits);
          sum.rays += cost.rays;
          sum.hits += cost.hits;
          sum.lost += cost.lost;
          sum.added += cost.added;
          sum.other_triangle += cost.other_triangle;
          sum.max_t_ulp = std::max(sum.max_t_ulp, cost.max_t_ulp);
        }
        if (sum.rays == 0) continue;
        json row = start("case");
        row.update({{"case", info.number},
                    {"name", info.name},
                    {"flavour", to_string(flavour)},
                    {"cost", to_json(sum)}});
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
      }
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (gnomon::bench::taught(argc, argv, kHelp)) return 0;
  try {
    const gnomon::cl::Context context = one_thread_context();
    const Runs runs{context};
    SceneList scenes = scenes_from(argc, argv);
    if (argc == 1) scenes = {{"atrium", 300'000}, {"city", 100'000}, {"crowd", 100'000}, {"random", 50'000}};
    for (const auto& [name, triangles] : scenes) runs.run(name, triangles);
    runs.hard_cases();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "accuracy_bench: %s\n", error.what());
    return 1;
  }
}
