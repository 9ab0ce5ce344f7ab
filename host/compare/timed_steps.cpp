// The contests of a run: all builds, and all methods on the rays of a kind; and these again where time is
// left.
#include <cmath>

#include "gnomon/base/stats.h"
#include "gnomon/compare/contest.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {
namespace {

double traced_once(RunState& run, const Batch& batch) {
  const double begun = wall_now();
  for (Entered& entered : run.entered) entered.entrant->trace(batch);
  return (wall_now() - begun) / static_cast<double>(batch.rays.size());
}

// How often each round traces the batch: a turn is to take long enough for what disturbs it to even out,
// where there is time for that.
std::uint64_t fitting_passes(RunState& run, const Batch& batch, double until) {
  constexpr double kTurn = 0.05;  // seconds
  const double begun = wall_now();
  run.baseline->trace(batch);
  if (wall_now() - begun >= kTurn) return 1;
  const double all = traced_once(run, batch) * static_cast<double>(batch.rays.size());
  const double wished = std::ceil(kTurn * static_cast<double>(run.entered.size()) / all);
  const double fit = std::floor(0.9 * (until - wall_now()) / (all * (run.options.rounds + 1)));
  return static_cast<std::uint64_t>(std::max(1.0, std::min(wished, fit)));
}

void say_who_sat_out(RunState& run, const std::string& step, const std::vector<Contestant>& contest) {
  for (std::size_t i = 0; i < contest.size(); ++i) {
    if (contest[i].rounds.wall_s.size() < contest.front().rounds.wall_s.size())
      run.leave_out(run.entered[i].method->facts.name, step,
                    "one round: it takes more than half of one, and all would not fit" + run.budget());
  }
}

TraceRow trace_row(Entered& entered, const Batch& batch, std::uint64_t passes, const Rounds& rounds) {
  TraceRow row;
  row.method = entered.method->facts.name;
  row.kind = batch.kind;
  row.any_hit = batch.any_hit;
  row.rays = batch.rays.size();
  row.passes = passes;
  row.rounds = rounds;
  for (std::vector<double>* seconds : {&row.rounds.wall_s, &row.rounds.cpu_s})
    for (double& one : *seconds) one /= static_cast<double>(passes);
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

void add_rounds_of_builds(RunState& run, double until) {
  std::vector<Contestant> contest;
  std::vector<BuildRow*> rows;
  std::size_t had = 0;
  for (Entered& entered : run.entered) {
    BuildRow& row = row_of(run.report.builds, entered.method->facts.name);
    if (contest.empty()) had = row.rounds.wall_s.size();
    if (row.rounds.wall_s.size() < had) continue;  // sat out
    contest.push_back({[&entered] {
                         entered.entrant->build({});
                         entered.entrant->forget_tree();
                       },
                       row.rounds});
    rows.push_back(&row);
  }
  const int wished = run.options.rounds - static_cast<int>(had);
  double round = 0.0;
  for (const BuildRow* row : rows)
    round += *std::max_element(row->rounds.wall_s.begin(), row->rounds.wall_s.end());
  if (wished < 1 || wall_now() + round > until) return;
  run_contest(contest, wished, until, wall_now,
              [&](int done, int most) { run.tell("builds", static_cast<double>(done) / most); });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]->rounds = contest[i].rounds;
  std::erase_if(run.report.left_out,
                [](const LeftOut& left) { return left.what == "builds" && left.method.empty(); });
  run.say_rounds("builds", rows.front()->rounds.wall_s.size());
  run.keep();
}

void time_traces(RunState& run, const std::string& kind, double until) {
  const std::string step = "trace " + kind;
  if (run.is_done(step)) return;
  run.tell(step, 0.0);
  Batch batch = run.make_batch_of(kind, kLeastRays);
  if (batch.rays.empty()) {
    run.leave_out("", step,
                  kind == "light" ? "the scene has no light with an area" : "the scene has no such rays");
    run.finish(step);
    return;
  }
  const std::uint64_t count =
      fitting_rays(run.options.ray_count, run.options.rounds, until, wall_now,
                   [&](std::uint64_t some) { return traced_once(run, run.make_batch_of(kind, some)); });
  batch = run.make_batch_of(kind, count);
  if (count < run.options.ray_count)
    run.leave_out(
        "", step,
        std::to_string(count) + " rays instead of " + std::to_string(run.options.ray_count) + run.budget());
  const std::uint64_t passes = fitting_passes(run, batch, until);
  std::vector<Contestant> contest;
  for (Entered& entered : run.entered)
    contest.push_back({[&entered, &batch, passes] {
                         for (std::uint64_t i = 0; i < passes; ++i) entered.entrant->trace(batch);
                       },
                       {}});
  run_contest(contest, run.options.rounds, until, wall_now,
              [&](int done, int most) { run.tell(step, static_cast<double>(done) / most); });
  run.say_rounds(step, contest.front().rounds.wall_s.size());
  say_who_sat_out(run, step, contest);
  if (count < run.options.ray_count ||
      contest.front().rounds.wall_s.size() < static_cast<std::size_t>(run.options.rounds))
    run.cut_kinds.push_back(kind);
  std::vector<TraceRow> rows;
  for (std::size_t i = 0; i < run.entered.size(); ++i) {
    rows.push_back(trace_row(run.entered[i], batch, passes, contest[i].rounds));
    run.tell(step, 1.0);
  }
  run.report.traces.insert(run.report.traces.end(), rows.begin(), rows.end());
  run.finish(step);
}

bool has_time_for_more(const RunState& run, const std::string& kind, double until) {
  double per_ray = 0.0;
  double count = 0.0;
  std::size_t rounds = run.options.rounds;
  for (const TraceRow& row : run.report.traces) {
    if (row.kind != kind) continue;
    count = static_cast<double>(row.rays);
    if (row.method == kBaseline) rounds = row.rounds.wall_s.size();
    per_ray += spread_of(row.rounds.wall_s).median / count;
  }
  const bool lacks_rounds = rounds < static_cast<std::size_t>(run.options.rounds);
  const double wished = (lacks_rounds ? 1.0 : 2.0) * count;
  return count > 0.0 && wall_now() + per_ray * wished * (run.options.rounds + 1) < until;
}

}  // namespace gnomon::compare
