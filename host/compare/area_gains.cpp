// What trees made for the rays of one light save there, light by light: counts, so one trace of each is
// enough.
#include "gnomon/areas/area_rays.h"
#include "gnomon/compare/contest.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {
namespace {

constexpr std::uint64_t kMostRays = 16'384;

AreaRow row_of(const std::string& area, const std::string& method, Entrant& entrant, const Batch& batch) {
  const Work work = entrant.work(batch).value_or(Work{});
  return {method, area, batch.rays.size(), work.boxes_per_ray, work.triangles_per_ray};
}

// "pah-window" asks for "pah" here.
bool wanted(const RunOptions& options, const std::string& name) {
  return options.methods.empty() ||
         std::any_of(options.methods.begin(), options.methods.end(), [&](const std::string& beginning) {
           return name.starts_with(beginning) || beginning.starts_with(name);
         });
}

Batch batch_of(RunState& run, const RaysOf& rays) {
  Batch batch;
  batch.kind = rays.name;
  batch.rays =
      area_rays(rays.area, rays.measure, std::min(run.options.ray_count, kMostRays), run.options.seed);
  return batch;
}

}  // namespace

void count_areas(RunState& run) {
  if (run.is_done("areas")) return;
  const double until = run.deadline(kAreasWeight, kAreasWeight + kPictureWeight);
  const std::vector<RaysOf> lights = rays_of_lights(run.scene);
  std::vector<AreaRow> rows;
  std::vector<DecisionRow> decisions;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const RaysOf& rays = lights[i];
    // Not in the middle of a light, so that all methods stand beside each other.
    if (wall_now() > until || run.spent() > run.options.seconds) {
      run.leave_out("", "areas",
                    std::to_string(lights.size() - i) + " of " + std::to_string(lights.size()) +
                        " lights: no time" + run.budget());
      break;
    }
    run.tell("areas", static_cast<double>(i) / static_cast<double>(lights.size()));
    const Batch batch = batch_of(run, rays);
    std::vector<AreaRow> own;
    for (const Method& method : methods_for(run.context, run.scene, rays, run.options.plan)) {
      if (!wanted(run.options, method.facts.name)) continue;
      try {
        const std::unique_ptr<Entrant> entrant = method.enter();
        entrant->build(run.stage_of("areas", static_cast<double>(i) / static_cast<double>(lights.size())));
        own.push_back(row_of(rays.name, method.facts.name, *entrant, batch));
        for (DecisionRow& decision : entrant->decisions()) {
          decision.method = method.facts.name;
          decisions.push_back(std::move(decision));
        }
      } catch (const Error& error) {
        if (error.code() == ErrorCode::kCancelled) throw;
        run.leave_out(method.facts.name, "areas", rays.name + ": " + error.what());
      }
    }
    if (own.empty()) break;
    rows.push_back(row_of(rays.name, kBaseline, *run.baseline, batch));
    rows.insert(rows.end(), own.begin(), own.end());
  }
  run.report.areas = std::move(rows);
  run.report.decisions.insert(run.report.decisions.end(), decisions.begin(), decisions.end());
  run.finish("areas");
}

}  // namespace gnomon::compare
