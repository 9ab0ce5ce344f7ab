// The question: what does each stage of a plan take by the clock, beside what PlanPrices say? One JSON row on
// stdout for each scene and stage: processor time of the process, least of a few goes.
//
//   plan_price_bench [--triangles 1000,4000,20000,100000]
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include <nlohmann/json.hpp>

#include "gnomon/cl/context.h"
#include "gnomon/device/optimise_device.h"
#include "gnomon/plan/child_order.h"
#include "gnomon/plan/choose.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/tree/merge_leaves.h"
#include "gnomon_commit.h"

namespace {

using namespace gnomon;

constexpr double kUnit = 6e-6;  // ms of a box test of a device's tracer (PlanPrices)

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <typename Stage>
void row(const char* name, const Scene& scene, const Stage& stage) {
  double least = 1e30;
  double units = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double start = processor_ms();
    units = stage();
    least = std::min(least, processor_ms() - start);
  }
  const nlohmann::json out = {{"schema", 1},
                              {"bench", "plan_price"},
                              {"commit", GNOMON_COMMIT},
                              {"triangles", scene.triangles.size()},
                              {"stage", name},
                              {"processor_ms", least},
                              {"priced_ms", units * kUnit}};
  std::printf("%s\n", out.dump().c_str());
  std::fflush(stdout);
}

void run(const cl::Context& context, std::uint64_t triangles) {
  const Scene scene = generate_scene(triangles < 7000 ? "random" : "forest", triangles, 1);
  const auto count = static_cast<double>(scene.triangles.size());
  const PlanPrices prices;
  BuildOptions single;
  single.max_leaf_size = 1;
  Bvh built, moved, joined;
  row("build", scene, [&] {
    built = download_bvh(context, build_device(context, scene.triangles, single));
    return prices.build_start + prices.build * count;
  });
  const DeviceBvh there = upload_bvh(context, built, scene.triangles);
  row("move by areas", scene, [&] {
    moved = download_bvh(context, optimise_device(context, there, thorough()));
    return prices.move_start + prices.move * count;
  });
  row("join leaves", scene, [&] {
    joined = merge_leaves(moved, face_measures(moved, {1.0F, 1.0F, 1.0F}));
    return prices.finish * count;
  });
  const std::vector<Ray> rays = primary_rays(scene, 2048, 1);
  const std::vector<Ray> fit = thinned(rays, 512);
  row("probe", scene, [&] {
    double sum = 0.0;
    for (const double cost : ray_costs({joined, {}}, scene.triangles, rays, Query::kClosest)) sum += cost;
    return prices.trace * sum;
  });
  row("learn an order", scene,
      [&] { return prices.learn * count + prices.trace * learn_order(joined, scene.triangles, fit).work; });
  const std::vector<Ray> segments = segments_of(joined, scene.triangles, fit, Query::kClosest);
  for (const Query query : {Query::kClosest, Query::kEvery})
    row(query == Query::kClosest ? "move by segments" : "move by endless rays", scene,
        [&] { return optimise_for_rays(moved, query == Query::kClosest ? segments : fit, {}).work; });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What the stages of a plan take by the clock.");
  std::vector<std::uint64_t> triangles{1000, 4000, 20'000, 100'000};
  app.add_option("--triangles", triangles)->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    const cl::Context context(cl::list_devices().front());
    for (const std::uint64_t count : triangles) run(context, count);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
