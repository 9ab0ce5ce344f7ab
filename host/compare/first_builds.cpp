// First builds: each tree once, what it is like, and what its heuristic expected of rays.
#include "gnomon/compare/run_steps.h"
#include "gnomon/measure/all_pierced.h"

namespace gnomon::compare {
namespace {

constexpr double kFirstBuildShare = 0.6;

bool wanted(const RunOptions& options, const std::string& name) {
  if (options.methods.empty() || name == kBaseline) return true;
  return std::any_of(options.methods.begin(), options.methods.end(),
                     [&](const std::string& beginning) { return name.starts_with(beginning); });
}

bool has_row(const DeviceReport& report, const std::string& method) {
  return std::any_of(report.builds.begin(), report.builds.end(),
                     [&](const BuildRow& row) { return row.method == method; });
}

class FirstBuilds {
 public:
  explicit FirstBuilds(RunState& run) : run_(run) {}

  void all(const std::vector<Method>& methods) {
    double entering = 0.0;  // seconds of all first builds so far
    std::size_t place = 0;
    for (const Method& method : methods) {
      const std::string& name = method.facts.name;
      const double share = static_cast<double>(place++) / static_cast<double>(methods.size());
      const bool contest_held = run_.is_done("builds");
      if (!wanted(run_.options, name) || (contest_held && !has_row(run_.report, name))) continue;
      run_.tell("first build of " + name, share);
      const double begun = run_.spent();
      const double mean = run_.entered.empty() ? 0.0 : entering / static_cast<double>(run_.entered.size());
      const double expected =
          std::max(mean, method.builds > 1.0 && !contest_held ? method.builds * baseline_build() : 0.0);
      if (begun + expected > kFirstBuildShare * run_.options.seconds && name != kBaseline && !contest_held) {
        run_.leave_out(name, "build", "no time" + run_.budget());
        continue;
      }
      try {
        Entered entered{&method, method.enter()};
        entered.entrant->build(run_.stage_of("first build of " + name, share));
        if (name == kBaseline) run_.baseline = entered.entrant.get();
        examine(entered);
        entering += run_.spent() - begun;
        run_.entered.push_back(std::move(entered));
      } catch (const Error& error) {
        if (name == kBaseline || error.code() == ErrorCode::kCancelled) throw;
        run_.leave_out(name, "build", error.what());
      }
    }
  }

 private:
  // Seconds of one with its kernels compiled.
  [[nodiscard]] double baseline_build() const {
    if (run_.baseline == nullptr) return 0.0;
    const double begun = run_.spent();
    run_.baseline->build({});
    run_.baseline->forget_tree();
    return run_.spent() - begun;
  }

  void examine(Entered& entered) {
    const MethodFacts& facts = entered.method->facts;
    DeviceReport& report = run_.report;
    if (std::none_of(report.methods.begin(), report.methods.end(),
                     [&](const MethodFacts& known) { return known.name == facts.name; }))
      report.methods.push_back(facts);
    const std::string step = "tree " + facts.name;
    if (run_.is_done(step)) {
      entered.entrant->forget_tree();
      return;
    }
    BuildRow row = entered.entrant->facts();
    row.method = facts.name;
    report.builds.push_back(std::move(row));
    for (DecisionRow& decision : entered.entrant->decisions()) {
      decision.method = facts.name;
      report.decisions.push_back(std::move(decision));
    }
    predict(entered);
    entered.entrant->forget_tree();
    run_.finish(step);
  }

  void predict(Entered& entered) {
    const Bvh* const tree = entered.entrant->tree();
    if (tree == nullptr) return;
    const auto predicted = entered.entrant->predicted_cost(*tree);
    if (!predicted) return;
    for (const std::string& kind : run_.options.kinds) {
      if (!samples_.contains(kind))
        samples_[kind] = run_.make_batch_of(kind, run_.options.predicted_rays).rays;
      const std::vector<Ray>& rays = samples_.at(kind);
      if (rays.empty()) continue;
      const MeanCost cost = mean_of(all_pierced_costs(*tree, rays));
      run_.report.predictions.push_back(
          {entered.method->facts.name, kind, rays.size(), *predicted, cost.mean, cost.standard_error});
    }
  }

  RunState& run_;
  std::map<std::string, std::vector<Ray>> samples_;  // a few of each kind, to hold predictions against
};

}  // namespace

void enter_methods(RunState& run, const std::vector<Method>& methods) {
  FirstBuilds(run).all(methods);
}

}  // namespace gnomon::compare
