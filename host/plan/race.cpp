#include "gnomon/plan/race.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

void require(bool ok, const char* option, const std::string& value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument,
              std::string("race option ") + option + " = " + value + " is outside its range " + range);
}

// Mean of a - scale * b over the rays both have, and its standard error.
struct Difference {
  double mean = 0.0;
  double error = 0.0;
};
Difference difference(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  const std::size_t count = std::min(a.size(), b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += a[i] - scale * b[i];
  const double mean = sum / static_cast<double>(count);
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = a[i] - scale * b[i] - mean;
    squares += off * off;
  }
  const auto n = static_cast<double>(count);
  return {mean, count > 1 ? std::sqrt(squares / (n - 1.0) / n) : INFINITY};
}

double mean_of_first(const std::vector<double>& values, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

class Runner {
 public:
  Runner(std::size_t candidates, const CostsOf& costs_of, const RaceOptions& options)
      : costs_of_(costs_of), options_(options), costs_(candidates + 1), running_(candidates, true) {
    race_.standings.resize(candidates);
  }

  Race run(std::size_t rays) {
    for (std::size_t first = 0; first < rays; first += options_.batch) {
      trace(first, std::min<std::size_t>(options_.batch, rays - first));
      if (costs_[0].size() >= options_.least) judge();
      if (std::find(running_.begin(), running_.end(), true) == running_.end()) break;
    }
    finish();
    return std::move(race_);
  }

 private:
  void trace(std::size_t first, std::size_t count) {
    for (std::size_t tree = 0; tree < costs_.size(); ++tree) {
      if (tree > 0 && !running_[tree - 1]) continue;
      const std::vector<double> found = costs_of_(tree, first, count);
      for (const double cost : found) race_.units += cost;
      costs_[tree].insert(costs_[tree].end(), found.begin(), found.end());
    }
  }

  [[nodiscard]] Verdict verdict_of(std::size_t i) const {
    const Difference d = difference(costs_[i + 1], costs_[0], 1.0 - options_.least_gain);
    if (d.mean + options_.certainty * d.error < 0.0) return Verdict::kBetter;
    return d.mean - options_.certainty * d.error > 0.0 ? Verdict::kNotBetter : Verdict::kOpen;
  }

  // A candidate that is better runs on while another one might be better still.
  void judge() {
    std::vector<Verdict> now(running_.size());
    for (std::size_t i = 0; i < running_.size(); ++i) {
      if (!running_[i]) continue;
      now[i] = verdict_of(i);
      if (now[i] == Verdict::kNotBetter) stop(i, now[i]);
    }
    for (std::size_t i = 0; i < running_.size(); ++i) {
      for (std::size_t j = 0; j < running_.size() && running_[i]; ++j) {
        if (i == j || !running_[j]) continue;
        const Difference d = difference(costs_[i + 1], costs_[j + 1], 1.0);
        const bool same = d.mean == 0.0 && d.error == 0.0 && j < i;
        if (same || d.mean - options_.certainty * d.error > 0.0) stop(i, Verdict::kBeaten);
      }
    }
    std::size_t left = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < running_.size(); ++i) {
      if (!running_[i]) continue;
      left += 1;
      last = i;
    }
    if (left == 1 && now[last] == Verdict::kBetter) stop(last, Verdict::kBetter);
  }

  void stop(std::size_t i, Verdict verdict) {
    running_[i] = false;
    race_.standings[i].verdict = verdict;
  }

  void finish() {
    race_.rays = costs_[0].size();
    race_.baseline = mean_of_first(costs_[0], costs_[0].size());
    for (std::size_t i = 0; i < running_.size(); ++i) {
      Standing& standing = race_.standings[i];
      standing.rays = costs_[i + 1].size();
      if (standing.rays == 0) continue;
      standing.cost = mean_of_first(costs_[i + 1], standing.rays);
      standing.baseline = mean_of_first(costs_[0], standing.rays);
      standing.error = difference(costs_[i + 1], costs_[0], 1.0).error;
      if (running_[i]) standing.verdict = verdict_of(i);
      if (standing.verdict != Verdict::kBetter) continue;
      const bool cheaper = race_.winner == 0xffffffffU || standing.cost < race_.standings[race_.winner].cost;
      if (cheaper) race_.winner = static_cast<std::uint32_t>(i);
    }
  }

  const CostsOf& costs_of_;
  const RaceOptions& options_;
  std::vector<std::vector<double>> costs_;
  std::vector<bool> running_;
  Race race_;
};

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kNotBetter:
      return "not better";
    case Verdict::kBeaten:
      return "beaten";
    case Verdict::kOpen:
      break;
  }
  return "open";
}

void RaceOptions::check() const {
  require(least_gain >= 0.0 && least_gain < 1.0, "least_gain", std::to_string(least_gain), "[0, 1)");
  require(certainty > 0.0 && std::isfinite(certainty), "certainty", std::to_string(certainty),
          "of finite numbers > 0");
  require(batch >= 1, "batch", std::to_string(batch), "from 1");
}

Race race(std::size_t candidates, std::size_t rays, const CostsOf& costs_of, const RaceOptions& options) {
  options.check();
  return Runner(candidates, costs_of, options).run(rays);
}

}  // namespace gnomon
