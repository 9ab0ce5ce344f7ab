#include "gnomon/plan/chooser.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gnomon/base/error.h"
#include "gnomon/scene/steady_random.h"

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

}  // namespace

Chooser::Chooser(std::span<const Triangle> triangles, const PlanRays& rays, const PlanOptions& options,
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

Decision Chooser::run() {
  if (options_.choice == "auto") {
    decide();
  } else if (options_.choice == base()) {
    decision_.reason = "asked for";
  } else {
    take(options_.choice);
  }
  return std::move(decision_);
}

void Chooser::take(const std::string& name) {
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
  if (name == "local-rays") return take_local();
  PlanPool::Entry entry = pool_.make(name);
  decision_.kept = name;
  decision_.reason = "asked for";
  decision_.tree = add(std::move(entry.tree));
}

void Chooser::take_local() {
  if (!options_.local_trees) {
    throw Error(
        ErrorCode::kInvalidArgument,
        "plan option choice = local-rays is outside its range here: this use of a plan takes no local "
        "trees (PlanOptions::local_trees)");
  }
  const LocalSets local = pool_.find_local(true);
  note_regions(local);
  if (local.sets.empty()) {
    decision_.reason = no_region(local);
    return;
  }
  const PlanPool::Entry others = pool_.make(base() + "-rays");
  PlanPool::Entry entry = pool_.make_local(local, others.tree);
  entry.tree.build_units += others.tree.build_units;
  entry.tree.bytes += others.tree.bytes;
  decision_.kept = "local-rays";
  decision_.reason = "asked for";
  note_kept(local);
  decision_.tree = add(std::move(entry.tree));
}

std::string Chooser::no_region(const LocalSets& local) const {
  if (local.looked_at == 0) return "a tenth of the rays or more are within no region that is known";
  return "the regions that the rays run through hold more than " + percent(options_.most_local) +
         " of the triangles each";
}

void Chooser::note_regions(const LocalSets& local) {
  decision_.regions = local.looked_at;
  decision_.least_members = local.least_members;
}

void Chooser::note_kept(const LocalSets& local) {
  for (const LocalSet& set : local.sets) decision_.local.push_back({set.members.size(), set.share});
}

std::size_t Chooser::add(PlanTree tree) {
  trees_.push_back(std::move(tree));
  return trees_.size() - 1;
}

// One candidate after the other until one is kept, boxes along the rays before all others; none is made
// that could not repay itself.
void Chooser::decide() {
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
  consider_local(hope);
  if (!decision_.trials.empty()) return;
  decision_.reason = number(rays_.expected, 0) +
                     " rays cannot repay another tree: the cheapest costs as much as " + number(cheapest, 0) +
                     " box tests, all that they do on the baseline about " +
                     number(hope / (kMostSaved * options_.prices.saved), 0);
}

// By totals before anything is made, and by a few probes: boxes of axis-parallel walls are fatter in any
// frame but the world's. Whether nothing else need be made.
bool Chooser::consider_frame(double hope) {
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

// Beside what is kept so far, where a region of the rays leaves most triangles out.
void Chooser::consider_local(double hope) {
  if (!options_.local_trees || base() == "best") return;
  if (!(hope > 2.0 * (options_.prices.build_start + options_.prices.move_start))) return;
  const LocalSets local = pool_.find_local(false);
  note_regions(local);
  double share = 0.0;
  for (const LocalSet& set : local.sets) share += set.share;
  if (!(share * hope > 2.0 * pool_.likely_local_price(local))) return;
  const PlanTree others = trees_[decision_.tree];
  if (others.tree.bvh.frame) return;
  if (judge("local-rays", pool_.make_local(local, others), kept_price_)) note_kept(local);
}

// What a few probes cost in the baseline put in the frame, beside what they cost in it as it is.
double Chooser::framed_cost() {
  const std::size_t some = std::min(kFramedProbes, probes_.size());
  double own = 0.0;
  double framed = 0.0;
  for (const double cost : baseline_costs(0, some)) own += cost;
  for (const double cost : traced(pool_.framed_baseline(), 0, some)) framed += cost;
  return own > 0.0 ? framed / own : 1.0;
}

// What a ray's work in a fitted tree is worth, in work of the baseline.
double Chooser::work_of(bool framed) const {
  if (rays_.query == Query::kEvery) return 1.0;
  const double packets = options_.packets && rays_.together ? options_.packet_work : 1.0;
  return framed ? std::max(options_.framed_work, packets) : packets;
}

// As many as the share of the baseline's build that probing may take pays for.
void Chooser::limit_probes() {
  const double each = 2.0 * options_.prices.trace * pool_.expected_cost();
  const double most = options_.probe_share * pool_.baseline_units();
  const auto least = static_cast<double>(options_.race.least);
  if (each * static_cast<double>(probes_.size()) > most)
    probes_.resize(std::min(probes_.size(), static_cast<std::size_t>(std::max(least, most / each))));
}

// Makes a candidate and has it race the baseline; whether it is kept, which it is instead of one that saves
// less.
bool Chooser::consider(const std::string& name) {
  return judge(name, pool_.make(name), 0.0);
}

// more_price: of what the candidate needs beside itself.
bool Chooser::judge(const std::string& name, PlanPool::Entry candidate, double more_price) {
  Trial trial;
  trial.name = name;
  trial.fit_gain = candidate.fit_gain;
  trial.price = candidate.tree.build_units +
                options_.prices.byte * static_cast<double>(candidate.tree.bytes) + more_price;
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
    // Trees beside another are to be surely better than that is alone.
    if (!candidate.tree.tree.local.empty() && decision_.kept != base())
      kept = kept && trial.standing.cost <= (1.0 - options_.race.least_gain) * decision_.cost;
    decision_.probes = std::max(decision_.probes, race.rays);
    if (kept || decision_.kept == base()) explain(race, trial, better, kept);
  }
  if (kept) forget_kept();
  if (kept || options_.keep_tried) {
    trial.tree = add(std::move(candidate.tree));
    if (kept) decision_.tree = trial.tree;
  }
  if (kept) {
    most_saved_ = trial.saving - trial.price;
    kept_price_ = trial.price;
  }
  decision_.trials.push_back(std::move(trial));
  return kept;
}

// What was kept so far is not.
void Chooser::forget_kept() {
  if (options_.keep_tried || decision_.tree == 0) return;
  for (Trial& trial : decision_.trials) {
    if (trial.tree == decision_.tree) trial.tree = 0;
  }
  trees_.pop_back();  // the last one added
  decision_.tree = 0;
}

Race Chooser::run_race(const OrderedTree& candidate) {
  return race(
      1, probes_.size(),
      [&](std::size_t tree, std::size_t first, std::size_t count) {
        if (tree != 0) return traced(candidate, first, count);
        return baseline_costs(first, count);
      },
      options_.race);
}

// Known from the race before, or found now.
std::vector<double> Chooser::baseline_costs(std::size_t first, std::size_t count) {
  for (std::size_t at = baseline_costs_.size(); at < first + count; at = baseline_costs_.size()) {
    const std::vector<double> more = traced(pool_.baseline().tree, at, first + count - at);
    baseline_costs_.insert(baseline_costs_.end(), more.begin(), more.end());
  }
  const auto from = baseline_costs_.begin() + static_cast<std::ptrdiff_t>(first);
  return {from, from + static_cast<std::ptrdiff_t>(count)};
}

std::vector<double> Chooser::traced(const OrderedTree& tree, std::size_t first, std::size_t count) {
  std::vector<double> costs =
      ray_costs(tree, triangles_, std::span(probes_).subspan(first, count), rays_.query);
  for (const double cost : costs) decision_.probe_units += options_.prices.trace * cost;
  return costs;
}

void Chooser::explain(const Race& race, const Trial& trial, bool better, bool kept) {
  decision_.baseline_cost = race.baseline;
  decision_.cost = race.baseline;
  if (kept) {
    decision_.kept = trial.name;
    decision_.cost = trial.standing.cost;
    decision_.reason = percent(1.0 - trial.standing.cost / trial.standing.baseline) +
                       " cheaper on probe rays; saves the work of " + number(trial.saving, 0) +
                       " box tests for a price of " + number(trial.price, 0);
  } else if (better && trial.saving <= 0.0) {
    decision_.reason = trial.name + " does " + percent(1.0 - trial.standing.cost / trial.standing.baseline) +
                       " less work on probe rays, too little to save time in packets or in a frame";
  } else if (better) {
    decision_.reason = trial.name + " is cheaper to trace but does not repay its price over " +
                       number(rays_.expected, 0) + " rays";
  } else {
    decision_.reason =
        "no candidate is surely " + percent(options_.race.least_gain) + " cheaper than the baseline";
  }
}

}  // namespace gnomon
