#include "gnomon/compare/run_device.h"

#include <algorithm>
#include <utility>

#include "gnomon/compare/contest.h"
#include "gnomon/compare/judging.h"
#include "gnomon/compare/pictures.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {
namespace {

class Run {
 public:
  explicit Run(RunState& run) : run_(run) {}

  void all(const std::vector<Method>& methods) {
    if (run_.report.complete) return;
    // What is left out is said anew: a rerun may have more time. Contests that were held keep who took part.
    std::erase_if(run_.report.left_out, [&](const LeftOut& left) {
      return left.what == "build" ? !run_.is_done("builds") : !run_.is_done(left.what);
    });
    enter_methods(run_, methods);
    time_builds(run_);
    for (const std::string& kind : run_.options.kinds) {
      const double weights = run_.weights_from(run_.place_of(kind));
      time_traces(run_, kind, run_.deadline(kTraceWeight, weights));
      judge(kind, run_.deadline(kJudgeWeight, weights - kTraceWeight));
    }
    time_sizes(run_);
    count_areas(run_);
    pictures();
    use_what_is_left();
    run_.report.complete = true;
    run_.keep();
  }

 private:
  // Shares of the time are set before anybody knows what the steps to come will take of theirs.
  void use_what_is_left() {
    const std::vector<std::string> cut = std::move(run_.cut_kinds);
    const double each = kTraceWeight + kJudgeWeight;
    const auto of_kinds = static_cast<double>(cut.size()) * each;
    add_rounds_of_builds(run_, run_.deadline(kBuildWeight, kBuildWeight + of_kinds));
    for (std::size_t i = 0; i < cut.size(); ++i) {
      const double weights = static_cast<double>(cut.size() - i) * each;
      const double until = run_.deadline(kTraceWeight, weights);
      if (!has_time_for_more(run_, cut[i], until)) continue;
      run_.forget(cut[i]);
      time_traces(run_, cut[i], until);
      judge(cut[i], run_.deadline(kJudgeWeight, weights - kTraceWeight));
    }
    const auto in_order = [&](const auto& a, const auto& b) {
      return run_.place_of(a.kind) < run_.place_of(b.kind);
    };
    std::stable_sort(run_.report.traces.begin(), run_.report.traces.end(), in_order);
    std::stable_sort(run_.report.accuracies.begin(), run_.report.accuracies.end(), in_order);
  }

  void judge(const std::string& kind, double until) {
    const std::string step = "judge " + kind;
    if (run_.is_done(step)) return;
    const auto traced = std::find_if(run_.report.traces.begin(), run_.report.traces.end(),
                                     [&](const TraceRow& row) { return row.kind == kind; });
    if (traced == run_.report.traces.end()) {
      run_.finish(step);
      return;
    }
    run_.tell(step, 0.0);
    if (!judge_) judge_ = std::make_unique<Judge>(run_.scene, !run_.context.device().fp64);
    const Batch batch = run_.make_batch_of(kind, traced->rays);
    std::vector<AccuracyRow> rows;
    for (std::size_t i = 0; i < run_.entered.size(); ++i) {
      const double left =
          (until - wall_now()) / static_cast<double>(std::min<std::size_t>(run_.entered.size() - i, 4));
      Answers answers = run_.entered[i].entrant->answers(batch);
      const auto hits = std::count_if(answers.hits.begin(), answers.hits.end(),
                                      [](const Hit& hit) { return hit.primitive != GN_NONE; });
      AccuracyRow row = judge_->row(
          run_.entered[i].method->facts.name, batch, std::move(answers), run_.options.judged_rays,
          std::max(0.05, left), [&](std::string_view, double done) {
            run_.tell(step, (static_cast<double>(i) + done) / static_cast<double>(run_.entered.size()));
            return true;
          });
      for (TraceRow& trace : run_.report.traces)
        if (trace.kind == kind && trace.method == row.method) trace.hits = static_cast<std::uint64_t>(hits);
      rows.push_back(std::move(row));
    }
    judge_->forget();
    const std::uint64_t wished = std::min<std::uint64_t>(run_.options.judged_rays, batch.rays.size());
    for (const AccuracyRow& row : rows) {
      if (row.judged >= wished || !row.same_as.empty()) continue;
      run_.leave_out(
          row.method, step,
          std::to_string(row.judged) + " rays judged instead of " + std::to_string(wished) + run_.budget());
    }
    run_.report.accuracies.insert(run_.report.accuracies.end(), rows.begin(), rows.end());
    run_.finish(step);
  }

  void pictures() {
    if (run_.is_done("pictures")) return;
    run_.tell("pictures", 0.0);
    Entrant& baseline = *run_.baseline;
    baseline.build({});
    run_.report.pictures = {};
    draw_scene(run_.context, run_.scene, *baseline.device_tree(), run_.options.picture_width,
               run_.options.picture_height, run_.options.seed, run_.report.pictures,
               run_.stage_of("picture", 0.5));
    std::vector<std::pair<std::string, Entrant*>> shown;
    for (Entered& entered : run_.entered)
      shown.emplace_back(entered.method->facts.name, entered.entrant.get());
    draw_heat_maps(run_.scene, shown, run_.report.pictures);
    baseline.forget_tree();
    run_.finish("pictures");
  }

  RunState& run_;
  std::unique_ptr<Judge> judge_;
};

}  // namespace

void RunOptions::check() const {
  const auto refuse = [](const std::string& what) { throw Error(ErrorCode::kInvalidArgument, what); };
  if (kinds.empty()) refuse("no kind of rays is chosen; give --rays primary, for example");
  if (ray_count < 1 || ray_count > (1U << 26U))
    refuse("rays of each kind: " + std::to_string(ray_count) + "; 1 to 67108864");
  if (judged_rays < 1) refuse("rays to judge: 0; at least 1");
  if (rounds < 1 || rounds > 1000) refuse("rounds: " + std::to_string(rounds) + "; 1 to 1000");
  if (!(seconds > 0.0)) refuse("the time must be more than 0 seconds");
}

void run_device(const cl::Context& context, const Scene& scene, const std::vector<Method>& methods,
                const RunOptions& options, DeviceReport& report, const std::function<void()>& after_step,
                const Progress& progress) {
  options.check();
  if (scene.triangles.empty())
    throw Error(ErrorCode::kBadScene, "the scene has no triangles to compare trees of");
  for (const std::string& kind : options.kinds) check_kind(kind);
  for (const std::string& beginning : options.methods) {
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const Method& method) { return method.facts.name.starts_with(beginning); }))
      continue;
    std::string names;
    for (const Method& method : methods) names += "\n  " + method.facts.name;
    throw Error(ErrorCode::kInvalidArgument,
                "no method's name begins with \"" + beginning + "\"; there are" + names);
  }
  RunState state(context, scene, options, report, after_step, progress);
  Run(state).all(methods);
}

}  // namespace gnomon::compare
