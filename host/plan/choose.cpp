#include "gnomon/plan/choose.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gnomon/base/error.h"
#include "gnomon/plan/plan_pool.h"
#include "gnomon/scene/steady_random.h"
#include "gnomon/tree/build_reference.h"

namespace gnomon {

namespace {

// No tree saves more than this share of a good one's cost: what a candidate is given to hope for before it is
// made.
constexpr double kMostSaved = 0.5;

// Where boxes along the rays save so much of the baseline's cost no other tree is made beside.
constexpr double kSavedEnough = 0.15;

// Probes that tell whether boxes in a frame can pay at all.
constexpr std::size_t kFramedProbes = 64;

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string percent(double share) {
  return number(100.0 * share, 1) + " %";
}

// The probes in random order, so that any first few of them stand for all.
std::vector<Ray> shuffled(std::vector<Ray> rays, std::uint64_t seed) {
  SteadyRandom random(seed);
  for (std::size_t i = rays.size(); i > 1; --i)
    std::swap(rays[i - 1], rays[random.below(static_cast<unsigned>(i))]);
  return rays;
}

// Decides for one kind of rays.
class Chooser {
 public:
  // Trees go to the end of `trees`.
  Chooser(std::span<const Triangle> triangles, const PlanRays& rays, const PlanOptions& options,
          PlanPool& pool, std::vector<PlanTree>& trees)
      : triangles_(triangles), rays_(rays), options_(options), pool_(pool), trees_(trees) {
    pool_.aim_at(rays);
    probes_ = shuffled(thinned(rays.probe, options.probe_rays), options.seed);
    decision_.rays = rays.name;
    decision_.query = rays.query;
    decision_.expected = rays.expected;
    decision_.kept = base();
    decision_.obliquity = pool.obliquity();
  }

  Decision run() {
    if (options_.choice == "auto") {
      decide();
    } else if (options_.choice == base()) {
      decision_.reason = "asked for";
    } else {
      take(options_.choice);
    }
    return std::move(decision_);
  }

 private:
  [[nodiscard]] const std::string& base() const { return pool_.baseline().name; }

  void take(const std::string& name) {
    if (name.ends_with("-order") && rays_.query != Query::kAny) {
      decision_.reason = "an order of children serves any hit alone";
      return;
    }
    if (name.starts_with("light")) {
      if (!options_.light_space) {
        throw Error(ErrorCode::kInvalidArgument,
                    "plan option choice = " + name +
                        " is outside its range here: this use of a plan takes no boxes in a frame "
                        "(PlanOptions::light_space)");
      }
      decision_.framed_share = pool_.framed_share();
    }
    PlanPool::Entry entry = pool_.make(name);
    decision_.kept = name;
    decision_.reason = "asked for";
    decision_.tree = add(std::move(entry.tree));
  }

  std::size_t add(PlanTree tree) {
    trees_.push_back(std::move(tree));
    return trees_.size() - 1;
  }

  // One candidate after the other until one is kept, boxes along the rays before all others; none is made
  // that could not repay itself.
  void decide() {
    if (probes_.size() < options_.race.least || rays_.fit.empty()) {
      decision_.reason = "too few rays to judge by: " + std::to_string(probes_.size()) + " probes";
      return;
    }
    limit_probes();
    const double hope = kMostSaved * options_.prices.saved * pool_.expected_cost() * rays_.expected;
    double cheapest = INFINITY;
    if (consider_frame(hope)) return;
    for (const char* const way : {"-rays", "-order"}) {
      if (way == std::string("-order") && rays_.query != Query::kAny) continue;
      const std::string name = base() + way;
      const double price = pool_.likely_price(name);
      cheapest = std::min(cheapest, price);
      if (hope > 2.0 * price && consider(name)) break;
    }
    if (!decision_.trials.empty()) return;
    decision_.reason = number(rays_.expected, 0) +
                       " rays cannot repay another tree: the cheapest costs as much as " +
                       number(cheapest, 0) + " box tests, all that they do on the baseline about " +
                       number(hope / (kMostSaved * options_.prices.saved), 0);
  }

  // By totals before anything is made, and by a few probes: boxes of axis-parallel walls are fatter in any
  // frame but the world's. Whether nothing else need be made.
  bool consider_frame(double hope) {
    if (!options_.light_space || decision_.obliquity < options_.least_oblique) return false;
    if (base() == "best") return false;
    if (!(hope > 2.0 * pool_.likely_price("light-rays"))) return false;
    decision_.framed_share = pool_.framed_share();
    const bool every = rays_.query == Query::kEvery;
    if (decision_.framed_share > (every ? options_.most_framed_every : options_.most_framed)) return false;
    if (!every && framed_cost() > options_.most_framed_cost) return false;
    if (!consider("light-rays")) return false;
    const Trial& trial = decision_.trials.back();
    return trial.standing.cost * work_of(true) <= (1.0 - kSavedEnough) * trial.standing.baseline;
  }

  // What a few probes cost in the baseline put in the frame, beside what they cost in it as it is.
  double framed_cost() {
    const std::size_t some = std::min(kFramedProbes, probes_.size());
    double own = 0.0;
    double framed = 0.0;
    for (const double cost : baseline_costs(0, some)) own += cost;
    for (const double cost : traced(pool_.framed_baseline(), 0, some)) framed += cost;
    return own > 0.0 ? framed / own : 1.0;
  }

  // What a ray's work in a fitted tree is worth, in work of the baseline.
  [[nodiscard]] double work_of(bool framed) const {
    if (rays_.query == Query::kEvery) return 1.0;
    const double packets = options_.packets && rays_.together ? options_.packet_work : 1.0;
    return framed ? std::max(options_.framed_work, packets) : packets;
  }

  // As many as the share of the baseline's build that probing may take pays for.
  void limit_probes() {
    const double each = 2.0 * options_.prices.trace * pool_.expected_cost();
    const double most = options_.probe_share * pool_.baseline_units();
    const auto least = static_cast<double>(options_.race.least);
    if (each * static_cast<double>(probes_.size()) > most)
      probes_.resize(std::min(probes_.size(), static_cast<std::size_t>(std::max(least, most / each))));
  }

  // Makes a candidate and has it race the baseline; whether it is kept, which it is instead of one that saves
  // less.
  bool consider(const std::string& name) {
    PlanPool::Entry candidate = pool_.make(name);
    Trial trial;
    trial.name = name;
    trial.fit_gain = candidate.fit_gain;
    trial.price =
        candidate.tree.build_units + options_.prices.byte * static_cast<double>(candidate.tree.bytes);
    bool kept = false;
    if (name == base() + "-rays" && trial.fit_gain < options_.race.least_gain) {
      trial.standing.verdict = Verdict::kNotBetter;
      if (decision_.tree == 0)
        decision_.reason = "sampled rays save no more than " + percent(trial.fit_gain) + " of their own cost";
    } else {
      const Race race = run_race(candidate.tree.tree);
      trial.standing = race.standings[0];
      const double cost = trial.standing.cost * work_of(candidate.tree.tree.bvh.frame.has_value());
      trial.saving = options_.prices.saved * rays_.expected * (trial.standing.baseline - cost);
      const bool better = trial.standing.verdict == Verdict::kBetter;
      kept = better && trial.saving - trial.price > most_saved_;
      decision_.probes = std::max(decision_.probes, race.rays);
      if (kept || decision_.kept == base()) explain(race, trial, better, kept);
    }
    if (kept) forget_kept();
    if (kept || options_.keep_tried) {
      trial.tree = add(std::move(candidate.tree));
      if (kept) decision_.tree = trial.tree;
    }
    if (kept) most_saved_ = trial.saving - trial.price;
    decision_.trials.push_back(std::move(trial));
    return kept;
  }

  // What was kept so far is not.
  void forget_kept() {
    if (options_.keep_tried || decision_.tree == 0) return;
    for (Trial& trial : decision_.trials) {
      if (trial.tree == decision_.tree) trial.tree = 0;
    }
    trees_.pop_back();  // the last one added
    decision_.tree = 0;
  }

  Race run_race(const OrderedTree& candidate) {
    return race(
        1, probes_.size(),
        [&](std::size_t tree, std::size_t first, std::size_t count) {
          if (tree != 0) return traced(candidate, first, count);
          return baseline_costs(first, count);
        },
        options_.race);
  }

  // Known from the race before, or found now.
  std::vector<double> baseline_costs(std::size_t first, std::size_t count) {
    for (std::size_t at = baseline_costs_.size(); at < first + count; at = baseline_costs_.size()) {
      const std::vector<double> more = traced(pool_.baseline().tree, at, first + count - at);
      baseline_costs_.insert(baseline_costs_.end(), more.begin(), more.end());
    }
    const auto from = baseline_costs_.begin() + static_cast<std::ptrdiff_t>(first);
    return {from, from + static_cast<std::ptrdiff_t>(count)};
  }

  std::vector<double> traced(const OrderedTree& tree, std::size_t first, std::size_t count) {
    std::vector<double> costs =
        ray_costs(tree, triangles_, std::span(probes_).subspan(first, count), rays_.query);
    for (const double cost : costs) decision_.probe_units += options_.prices.trace * cost;
    return costs;
  }

  void explain(const Race& race, const Trial& trial, bool better, bool kept) {
    decision_.baseline_cost = race.baseline;
    decision_.cost = race.baseline;
    if (kept) {
      decision_.kept = trial.name;
      decision_.cost = trial.standing.cost;
      decision_.reason = percent(1.0 - trial.standing.cost / trial.standing.baseline) +
                         " cheaper on probe rays; saves the work of " + number(trial.saving, 0) +
                         " box tests for a price of " + number(trial.price, 0);
    } else if (better && trial.saving <= 0.0) {
      decision_.reason = trial.name + " does " +
                         percent(1.0 - trial.standing.cost / trial.standing.baseline) +
                         " less work on probe rays, too little to save time in packets or in a frame";
    } else if (better) {
      decision_.reason = trial.name + " is cheaper to trace but does not repay its price over " +
                         number(rays_.expected, 0) + " rays";
    } else {
      decision_.reason =
          "no candidate is surely " + percent(options_.race.least_gain) + " cheaper than the baseline";
    }
  }

  std::span<const Triangle> triangles_;
  const PlanRays& rays_;
  const PlanOptions& options_;
  PlanPool& pool_;
  std::vector<Ray> probes_;
  std::vector<double> baseline_costs_;  // of the first probes
  double most_saved_ = 0.0;             // beyond its price, by what is kept
  std::vector<PlanTree>& trees_;
  Decision decision_;
};

}  // namespace

PlanBuilder reference_builder() {
  return {[](std::span<const Triangle> triangles, const BuildOptions& options) {
            return build_reference(triangles, options);
          },
          [](const Bvh& bvh, const OptimiseOptions& options) { return optimise_reference(bvh, options); }};
}

Plan make_plan(std::span<const Triangle> triangles, std::span<const PlanRays> rays,
               const PlanOptions& options, const PlanBuilder& builder, const Progress& progress) {
  options.check();
  report(progress, "baseline", 0.0);
  PlanPool pool(triangles, options, builder);
  Plan plan;
  plan.trees.push_back(pool.baseline());
  plan.baseline_units = pool.baseline_units();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(rays[i].expected >= 0.0 && std::isfinite(rays[i].expected))) {
      throw Error(ErrorCode::kInvalidArgument, "expected rays of " + rays[i].name + " = " +
                                                   std::to_string(rays[i].expected) +
                                                   " are no finite number >= 0");
    }
    report(progress, rays[i].name, static_cast<double>(i + 1) / static_cast<double>(rays.size() + 1));
    Decision decision = Chooser(triangles, rays[i], options, pool, plan.trees).run();
    plan.planning_units += decision.probe_units;
    if (decision.tree != 0) plan.kept_units += plan.trees[decision.tree].build_units;
    plan.decisions.push_back(std::move(decision));
  }
  plan.planning_units += pool.work();
  return plan;
}

}  // namespace gnomon
