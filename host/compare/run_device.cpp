#include "gnomon/compare/run_device.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "gnomon/compare/contest.h"
#include "gnomon/compare/judging.h"
#include "gnomon/compare/pictures.h"
#include "gnomon/measure/all_pierced.h"

namespace gnomon::compare {
namespace {

// What is left of the time goes to these, in this order, by weight.
constexpr double kBuildWeight = 6.0;
constexpr double kTraceWeight = 2.0;  // each kind
constexpr double kJudgeWeight = 1.0;  // each kind
constexpr double kPictureWeight = 1.0;
constexpr double kFirstBuildShare = 0.6;

struct Entered {
  const Method* method;
  std::unique_ptr<Entrant> entrant;
};

bool wanted(const RunOptions& options, const std::string& name) {
  if (options.methods.empty() || name == kBaseline) return true;
  return std::any_of(options.methods.begin(), options.methods.end(),
                     [&](const std::string& beginning) { return name.starts_with(beginning); });
}

template <typename Row>
Row& row_of(std::vector<Row>& rows, const std::string& method) {
  return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.method == method; });
}

class Run {
 public:
  Run(const cl::Context& context, const Scene& scene, const RunOptions& options, DeviceReport& report,
      const std::function<void()>& after_step, const Progress& progress)
      : context_(context),
        scene_(scene),
        options_(options),
        report_(report),
        after_step_(after_step),
        progress_(progress),
        start_(wall_now()) {}

  void all(const std::vector<Method>& methods) {
    if (report_.complete) return;
    // What is left out is said anew: a rerun may have more time. Contests that were held keep who took part.
    std::erase_if(report_.left_out, [&](const LeftOut& left) {
      return left.what == "build" ? !is_done("builds") : !is_done(left.what);
    });
    enter(methods);
    builds();
    for (const std::string& kind : options_.kinds) {
      trace(kind);
      judge(kind);
    }
    pictures();
    report_.complete = true;
    after_step_();
  }

 private:
  [[nodiscard]] bool is_done(const std::string& step) const {
    return std::find(report_.done.begin(), report_.done.end(), step) != report_.done.end();
  }
  [[nodiscard]] bool has_row(const std::string& method) const {
    return std::any_of(report_.builds.begin(), report_.builds.end(),
                       [&](const BuildRow& row) { return row.method == method; });
  }
  void finish(const std::string& step) {
    report_.done.push_back(step);
    after_step_();
  }
  void leave_out(const std::string& method, const std::string& what, const std::string& reason) {
    report_.left_out.push_back({method, what, reason});
  }

  [[nodiscard]] double spent() const { return wall_now() - start_; }
  // Until when the next step may go on, if all steps still to come share what is left by weight.
  [[nodiscard]] double deadline(double weight, double weights_left) const {
    const double left = std::max(0.0, options_.seconds - spent());
    return wall_now() + left * weight / weights_left;
  }
  [[nodiscard]] double weights_from(std::size_t kind) const {
    return static_cast<double>(options_.kinds.size() - kind) * (kTraceWeight + kJudgeWeight) + kPictureWeight;
  }
  [[nodiscard]] std::size_t place_of(const std::string& kind) const {
    const auto found = std::find(options_.kinds.begin(), options_.kinds.end(), kind);
    return static_cast<std::size_t>(found - options_.kinds.begin());
  }
  [[nodiscard]] std::string budget() const {
    return ": the budget is " + std::to_string(std::llround(options_.seconds)) + " s";
  }
  void tell(const std::string& stage, double done) const {
    const double left = options_.seconds - spent();
    gnomon::report(
        progress_,
        report_.name + ": " + stage +
            (left > 0.0 ? ", " + std::to_string(std::llround(std::ceil(left))) + " s left at most" : ""),
        done);
  }

  // Builds each once, which also compiles its kernels, and keeps what its tree is like.
  void enter(const std::vector<Method>& methods) {
    std::size_t place = 0;
    for (const Method& method : methods) {
      const std::string& name = method.facts.name;
      const double share = static_cast<double>(place++) / static_cast<double>(methods.size());
      if (!wanted(options_, name) || (is_done("builds") && !has_row(name))) continue;
      tell("first build of " + name, share);
      const double begun = spent();
      const double expected = entered_.empty() ? 0.0 : entering_ / static_cast<double>(entered_.size());
      if (begun + expected > kFirstBuildShare * options_.seconds && name != kBaseline && !is_done("builds")) {
        leave_out(name, "build", "no time" + budget());
        continue;
      }
      try {
        Entered entered{&method, method.enter()};
        entered.entrant->build(stage_of("first build of " + name, share));
        if (name == kBaseline) baseline_ = entered.entrant.get();
        examine(entered);
        entering_ += spent() - begun;
        entered_.push_back(std::move(entered));
      } catch (const Error& error) {
        if (name == kBaseline || error.code() == ErrorCode::kCancelled) throw;
        leave_out(name, "build", error.what());
      }
    }
  }

  [[nodiscard]] Progress stage_of(const std::string& stage, double done) const {
    return [this, stage, done](std::string_view, double) {
      tell(stage, done);
      return true;
    };
  }

  void examine(Entered& entered) {
    const MethodFacts& facts = entered.method->facts;
    if (std::none_of(report_.methods.begin(), report_.methods.end(),
                     [&](const MethodFacts& known) { return known.name == facts.name; }))
      report_.methods.push_back(facts);
    const std::string step = "tree " + facts.name;
    if (is_done(step)) {
      entered.entrant->forget_tree();
      return;
    }
    BuildRow row = entered.entrant->facts();
    row.method = facts.name;
    report_.builds.push_back(std::move(row));
    predict(entered);
    entered.entrant->forget_tree();
    finish(step);
  }

  Batch make_batch_of(const std::string& kind, std::uint64_t count) {
    return make_batch(
        context_, scene_, [this](std::span<const Ray> rays) { return baseline_->closest(rays); }, kind, count,
        options_.seed);
  }

  void predict(Entered& entered) {
    const Bvh* const tree = entered.entrant->tree();
    if (tree == nullptr) return;
    const auto predicted = entered.entrant->predicted_cost(*tree);
    if (!predicted) return;
    for (const std::string& kind : options_.kinds) {
      if (!samples_.contains(kind)) samples_[kind] = make_batch_of(kind, options_.predicted_rays).rays;
      const std::vector<Ray>& rays = samples_.at(kind);
      if (rays.empty()) continue;
      const MeanCost cost = mean_of(all_pierced_costs(*tree, rays));
      report_.predictions.push_back(
          {entered.method->facts.name, kind, rays.size(), *predicted, cost.mean, cost.standard_error});
    }
  }

  void builds() {
    if (is_done("builds")) return;
    std::vector<Contestant> contest;
    for (Entered& entered : entered_)
      contest.push_back({[&entered] {
                           entered.entrant->build({});
                           entered.entrant->forget_tree();
                         },
                         {}});
    run_contest(contest, options_.rounds, deadline(kBuildWeight, kBuildWeight + weights_from(0)), wall_now,
                [&](int done, int most) { tell("builds", static_cast<double>(done) / most); });
    say_rounds("builds", contest);
    for (std::size_t i = 0; i < entered_.size(); ++i)
      row_of(report_.builds, entered_[i].method->facts.name).rounds = contest[i].rounds;
    finish("builds");
  }

  void say_rounds(const std::string& step, const std::vector<Contestant>& contest) {
    const std::size_t rounds = contest.front().rounds.wall_s.size();
    if (rounds < static_cast<std::size_t>(options_.rounds))
      leave_out("", step,
                std::to_string(rounds) + " rounds instead of " + std::to_string(options_.rounds) + budget());
  }

  void trace(const std::string& kind) {
    const std::string step = "trace " + kind;
    if (is_done(step)) return;
    tell(step, 0.0);
    const double until = deadline(kTraceWeight, weights_from(place_of(kind)));
    Batch batch = make_batch_of(kind, kMinRays);
    if (batch.rays.empty()) {
      leave_out("", step,
                kind == "light" ? "the scene has no light with an area" : "the scene has no such rays");
      finish(step);
      return;
    }
    const std::uint64_t count = fitting_count(batch, until);
    batch = make_batch_of(kind, count);
    if (count < options_.ray_count)
      leave_out("", step,
                std::to_string(count) + " rays instead of " + std::to_string(options_.ray_count) + budget());
    std::vector<Contestant> contest;
    for (Entered& entered : entered_)
      contest.push_back({[&entered, &batch] { entered.entrant->trace(batch); }, {}});
    run_contest(contest, options_.rounds, until, wall_now,
                [&](int done, int most) { tell(step, static_cast<double>(done) / most); });
    say_rounds(step, contest);
    std::vector<TraceRow> rows;
    for (std::size_t i = 0; i < entered_.size(); ++i) {
      TraceRow row;
      row.method = entered_[i].method->facts.name;
      row.kind = kind;
      row.any_hit = batch.any_hit;
      row.rays = batch.rays.size();
      row.rounds = contest[i].rounds;
      if (const auto work = entered_[i].entrant->work(batch)) {
        row.counted = true;
        row.boxes_per_ray = work->boxes_per_ray;
        row.triangles_per_ray = work->triangles_per_ray;
      }
      rows.push_back(std::move(row));
      tell(step, 1.0);
    }
    report_.traces.insert(report_.traces.end(), rows.begin(), rows.end());
    finish(step);
  }

  // So many rays that all rounds of all methods fit, as a few rays tell; those also warm the kernels up.
  std::uint64_t fitting_count(const Batch& few, double until) {
    for (Entered& entered : entered_) entered.entrant->trace(few);
    const double begun = wall_now();
    for (Entered& entered : entered_) entered.entrant->trace(few);
    const double per_ray = (wall_now() - begun) / static_cast<double>(few.rays.size());
    const double seconds = std::max(0.0, 0.8 * (until - wall_now()));
    const double fits = seconds / (per_ray * (options_.rounds + 1));
    std::uint64_t count = options_.ray_count;
    while (count > kMinRays && static_cast<double>(count) > fits) count /= 2;
    return std::max<std::uint64_t>(count, std::min(kMinRays, options_.ray_count));
  }

  void judge(const std::string& kind) {
    const std::string step = "judge " + kind;
    if (is_done(step)) return;
    const auto traced = std::find_if(report_.traces.begin(), report_.traces.end(),
                                     [&](const TraceRow& row) { return row.kind == kind; });
    if (traced == report_.traces.end()) {
      finish(step);
      return;
    }
    tell(step, 0.0);
    const double until = deadline(kJudgeWeight, weights_from(place_of(kind)) - kTraceWeight);
    if (!judge_) judge_ = std::make_unique<Judge>(scene_, !context_.device().fp64);
    const Batch batch = make_batch_of(kind, traced->rays);
    std::vector<AccuracyRow> rows;
    for (std::size_t i = 0; i < entered_.size(); ++i) {
      const double left =
          (until - wall_now()) / static_cast<double>(std::min<std::size_t>(entered_.size() - i, 4));
      Answers answers = entered_[i].entrant->answers(batch);
      const auto hits = std::count_if(answers.hits.begin(), answers.hits.end(),
                                      [](const Hit& hit) { return hit.primitive != GN_NONE; });
      AccuracyRow row =
          judge_->row(entered_[i].method->facts.name, batch, std::move(answers), options_.judged_rays,
                      std::max(0.05, left), [&](std::string_view, double done) {
                        tell(step, (static_cast<double>(i) + done) / static_cast<double>(entered_.size()));
                        return true;
                      });
      for (TraceRow& trace : report_.traces)
        if (trace.kind == kind && trace.method == row.method) trace.hits = static_cast<std::uint64_t>(hits);
      rows.push_back(std::move(row));
    }
    judge_->forget();
    const std::uint64_t wished = std::min<std::uint64_t>(options_.judged_rays, batch.rays.size());
    for (const AccuracyRow& row : rows) {
      if (row.judged >= wished || !row.same_as.empty()) continue;
      leave_out(row.method, step,
                std::to_string(row.judged) + " rays judged instead of " + std::to_string(wished) + budget());
    }
    report_.accuracies.insert(report_.accuracies.end(), rows.begin(), rows.end());
    finish(step);
  }

  void pictures() {
    if (is_done("pictures")) return;
    tell("pictures", 0.0);
    Entrant& baseline = *baseline_;
    baseline.build({});
    report_.pictures = {};
    draw_scene(context_, scene_, *baseline.device_tree(), options_.picture_width, options_.picture_height,
               options_.seed, report_.pictures, stage_of("picture", 0.5));
    std::vector<std::pair<std::string, Entrant*>> shown;
    for (Entered& entered : entered_) shown.emplace_back(entered.method->facts.name, entered.entrant.get());
    draw_heat_maps(scene_, shown, report_.pictures);
    baseline.forget_tree();
    finish("pictures");
  }

  const cl::Context& context_;
  const Scene& scene_;
  const RunOptions& options_;
  DeviceReport& report_;
  const std::function<void()>& after_step_;
  const Progress& progress_;
  double start_;
  double entering_ = 0.0;  // seconds of all first builds so far
  std::vector<Entered> entered_;
  Entrant* baseline_ = nullptr;
  std::map<std::string, std::vector<Ray>> samples_;  // a few of each kind, to hold predictions against
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
  Run(context, scene, options, report, after_step, progress).all(methods);
}

}  // namespace gnomon::compare
