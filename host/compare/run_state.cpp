#include <cmath>

#include "gnomon/compare/contest.h"
#include "gnomon/compare/run_steps.h"

namespace gnomon::compare {

RunState::RunState(const cl::Context& context_, const Scene& scene_, const RunOptions& options_,
                   DeviceReport& report_, const std::function<void()>& after_step, const Progress& progress)
    : context(context_),
      scene(scene_),
      options(options_),
      report(report_),
      after_step_(after_step),
      progress_(progress),
      start_(wall_now()) {}

bool RunState::is_done(const std::string& step) const {
  return std::find(report.done.begin(), report.done.end(), step) != report.done.end();
}

void RunState::finish(const std::string& step) {
  report.done.push_back(step);
  keep();
}

void RunState::forget(const std::string& kind) {
  std::erase_if(report.traces, [&](const TraceRow& row) { return row.kind == kind; });
  std::erase_if(report.accuracies, [&](const AccuracyRow& row) { return row.kind == kind; });
  for (const std::string& step : {"trace " + kind, "judge " + kind}) {
    std::erase(report.done, step);
    std::erase_if(report.left_out, [&](const LeftOut& left) { return left.what == step; });
  }
}

void RunState::leave_out(const std::string& method, const std::string& what, const std::string& reason) {
  report.left_out.push_back({method, what, reason});
}

void RunState::say_rounds(const std::string& step, std::size_t rounds) {
  if (rounds < static_cast<std::size_t>(options.rounds))
    leave_out("", step,
              std::to_string(rounds) + " rounds instead of " + std::to_string(options.rounds) + budget());
}

double RunState::spent() const {
  return wall_now() - start_;
}

double RunState::deadline(double weight, double weights_left) const {
  const double left = std::max(0.0, options.seconds - spent());
  return wall_now() + left * weight / weights_left;
}

double RunState::weights_from(std::size_t kind) const {
  return static_cast<double>(options.kinds.size() - kind) * (kTraceWeight + kJudgeWeight) + kSizesWeight +
         kAreasWeight + kPictureWeight;
}

std::size_t RunState::place_of(const std::string& kind) const {
  const auto found = std::find(options.kinds.begin(), options.kinds.end(), kind);
  return static_cast<std::size_t>(found - options.kinds.begin());
}

std::string RunState::budget() const {
  return ": the budget is " + std::to_string(std::llround(options.seconds)) + " s";
}

void RunState::tell(const std::string& stage, double done) const {
  const double left = options.seconds - spent();
  gnomon::report(
      progress_,
      report.name + ": " + stage +
          (left > 0.0 ? ", " + std::to_string(std::llround(std::ceil(left))) + " s left at most" : ""),
      done);
}

Progress RunState::stage_of(const std::string& stage, double done) const {
  return [this, stage, done](std::string_view, double) {
    tell(stage, done);
    return true;
  };
}

Batch RunState::make_batch_of(const std::string& kind, std::uint64_t count) const {
  return make_batch(
      context, scene, [this](std::span<const Ray> rays) { return baseline->closest(rays); }, kind, count,
      options.seed);
}

}  // namespace gnomon::compare
