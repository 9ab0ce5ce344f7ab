// The contests of a run: all builds, and all methods on the rays of a kind.
#include "gnomon/compare/contest.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {
namespace {

// So many rays that all rounds of all methods fit, as a few rays tell; those also warm the kernels up.
std::uint64_t fitting_count(RunState& run, const Batch& few, double until) {
  for (Entered& entered : run.entered) entered.entrant->trace(few);
  const double begun = wall_now();
  for (Entered& entered : run.entered) entered.entrant->trace(few);
  const double per_ray = (wall_now() - begun) / static_cast<double>(few.rays.size());
  const double seconds = std::max(0.0, 0.8 * (until - wall_now()));
  const double fits = seconds / (per_ray * (run.options.rounds + 1));
  std::uint64_t count = run.options.ray_count;
  while (count > kMinRays && static_cast<double>(count) > fits) count /= 2;
  return std::max<std::uint64_t>(count, std::min(kMinRays, run.options.ray_count));
}

void say_who_sat_out(RunState& run, const std::string& step, const std::vector<Contestant>& contest) {
  for (std::size_t i = 0; i < contest.size(); ++i) {
    if (contest[i].rounds.wall_s.size() < contest.front().rounds.wall_s.size())
      run.leave_out(run.entered[i].method->facts.name, step,
                    "one round: it takes more than half of one, and all would not fit" + run.budget());
  }
}

TraceRow trace_row(Entered& entered, const Batch& batch, const Rounds& rounds) {
  TraceRow row;
  row.method = entered.method->facts.name;
  row.kind = batch.kind;
  row.any_hit = batch.any_hit;
  row.rays = batch.rays.size();
  row.rounds = rounds;
  if (const auto work = entered.entrant->work(batch)) {
    row.counted = true;
    row.boxes_per_ray = work->boxes_per_ray;
    row.triangles_per_ray = work->triangles_per_ray;
  }
  return row;
}

}  // namespace

void time_builds(RunState& run) {
  if (run.is_done("builds")) return;
  std::vector<Contestant> contest;
  for (Entered& entered : run.entered)
    contest.push_back({[&entered] {
                         entered.entrant->build({});
                         entered.entrant->forget_tree();
                       },
                       {}});
  run_contest(contest, run.options.rounds, run.deadline(kBuildWeight, kBuildWeight + run.weights_from(0)),
              wall_now, [&](int done, int most) { run.tell("builds", static_cast<double>(done) / most); });
  run.say_rounds("builds", contest.front().rounds.wall_s.size());
  say_who_sat_out(run, "builds", contest);
  for (std::size_t i = 0; i < run.entered.size(); ++i)
    row_of(run.report.builds, run.entered[i].method->facts.name).rounds = contest[i].rounds;
  run.finish("builds");
}

void time_traces(RunState& run, const std::string& kind) {
  const std::string step = "trace " + kind;
  if (run.is_done(step)) return;
  run.tell(step, 0.0);
  const double until = run.deadline(kTraceWeight, run.weights_from(run.place_of(kind)));
  Batch batch = run.make_batch_of(kind, kMinRays);
  if (batch.rays.empty()) {
    run.leave_out("", step,
                  kind == "light" ? "the scene has no light with an area" : "the scene has no such rays");
    run.finish(step);
    return;
  }
  const std::uint64_t count = fitting_count(run, batch, until);
  batch = run.make_batch_of(kind, count);
  if (count < run.options.ray_count)
    run.leave_out(
        "", step,
        std::to_string(count) + " rays instead of " + std::to_string(run.options.ray_count) + run.budget());
  std::vector<Contestant> contest;
  for (Entered& entered : run.entered)
    contest.push_back({[&entered, &batch] { entered.entrant->trace(batch); }, {}});
  run_contest(contest, run.options.rounds, until, wall_now,
              [&](int done, int most) { run.tell(step, static_cast<double>(done) / most); });
  run.say_rounds(step, contest.front().rounds.wall_s.size());
  say_who_sat_out(run, step, contest);
  std::vector<TraceRow> rows;
  for (std::size_t i = 0; i < run.entered.size(); ++i) {
    rows.push_back(trace_row(run.entered[i], batch, contest[i].rounds));
    run.tell(step, 1.0);
  }
  run.report.traces.insert(run.report.traces.end(), rows.begin(), rows.end());
  run.finish(step);
}

}  // namespace gnomon::compare
