#include "gnomon/measure/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gnomon/base/stats.h"
#include "gnomon/measure/prediction.h"

namespace gnomon {

double Comparison::errors_off() const {
  if (measured == published) return 0.0;
  const double of_difference = std::sqrt(2.0) * standard_error;
  return of_difference > 0.0 ? (measured - published) / of_difference
                             : std::numeric_limits<double>::infinity();
}

void ReproduceSummary::add(const SetUp& set_up, const SetUpReport& report,
                           const PublishedResults& published) {
  const RayMeasure thesis = ray_measures_of(set_up.area).front();
  for (const TreeRun& run : report.trees) {
    runs_.push_back({set_ups_, run.rays == thesis, run.rays, run.builder, run.local.mean});
    const auto row = published.find(key_of(set_up, run.builder));
    if (row == published.end()) continue;
    comparisons_.push_back({set_up.label(), run.builder, row->second.flag, row->second.local_cost,
                            run.local.mean, run.local.standard_error, row->second.predicted_sah,
                            run.predicted_surface});
  }
  predictions_.insert(predictions_.end(), report.predictions.begin(), report.predictions.end());
  ++set_ups_;
}

double ReproduceSummary::median_deviation(bool flagged) const {
  std::vector<double> deviations;
  for (const Comparison& row : comparisons_) {
    if (row.flag.empty() != flagged) deviations.push_back(row.deviation());
  }
  return spread_of(deviations).median;
}

std::uint64_t ReproduceSummary::compared(bool flagged) const {
  return static_cast<std::uint64_t>(
      std::count_if(comparisons_.begin(), comparisons_.end(),
                    [&](const Comparison& row) { return row.flag.empty() != flagged; }));
}

std::vector<Comparison> ReproduceSummary::large_deviations() const {
  std::vector<Comparison> out;
  for (const Comparison& row : comparisons_) {
    if (row.deviation() > kLargeDeviation) out.push_back(row);
  }
  return out;
}

double ReproduceSummary::rms_errors_off() const {
  std::vector<double> squares;
  for (const Comparison& row : comparisons_) {
    if (row.flag.empty()) squares.push_back(row.errors_off() * row.errors_off());
  }
  return std::sqrt(mean_of(squares).mean);
}

std::uint64_t ReproduceSummary::estimates_within(double bound) const {
  return static_cast<std::uint64_t>(
      std::count_if(comparisons_.begin(), comparisons_.end(), [&](const Comparison& row) {
        return row.flag.empty() &&
               std::abs(row.measured_sah - row.published_sah) <= bound * row.published_sah;
      }));
}

template <typename Wanted>
Duel ReproduceSummary::duel(const std::string& builder, const std::string& against, Wanted wanted) const {
  Duel out;
  out.builder = builder;
  out.against = against;
  double logs = 0.0;
  for (const Run& ours : runs_) {
    if (ours.builder != builder || !wanted(ours)) continue;
    const auto theirs = std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) {
      return run.set_up == ours.set_up && run.rays == ours.rays && run.builder == against;
    });
    if (theirs == runs_.end() || !(ours.cost > 0.0) || !(theirs->cost > 0.0)) continue;
    const double ratio = ours.cost / theirs->cost;
    logs += std::log(ratio);
    out.worst = std::max(out.worst, ratio);
    out.wins += ratio < 1.0 ? 1 : 0;
    out.count += 1;
    out.rays = ours.rays;
  }
  if (out.count > 0) out.geomean = std::exp(logs / static_cast<double>(out.count));
  return out;
}

std::vector<Duel> ReproduceSummary::variant_duels() const {
  std::vector<Duel> out;
  for (const char* const builder : {"Facing", "Longest", "Full", "TrueLongest"}) {
    Duel found = duel(builder, "Standard", [](const Run&) { return true; });
    if (found.count > 0) out.push_back(std::move(found));
  }
  return out;
}

Duel ReproduceSummary::three_axes_duel() const {
  return duel("PAH3", "SAH3", [](const Run& run) { return run.thesis_rays; });
}

std::vector<Duel> ReproduceSummary::three_axes_duels_by_measure() const {
  std::vector<Duel> out;
  for (const RayMeasure rays :
       {RayMeasure::kParallel, RayMeasure::kYawPitch, RayMeasure::kNearPlane, RayMeasure::kSolidAngle}) {
    Duel found = duel("PAH3", "SAH3", [&](const Run& run) { return run.rays == rays; });
    if (found.count > 0) out.push_back(std::move(found));
  }
  return out;
}

std::vector<PredictionErrors> ReproduceSummary::prediction_errors() const {
  std::vector<PredictionErrors> out;
  std::vector<std::vector<double>> errors;
  std::vector<std::vector<double>> noise;
  for (const PredictionRun& run : predictions_) {
    auto at = std::find_if(out.begin(), out.end(), [&](const PredictionErrors& e) {
      return e.rays == run.rays && e.measure == run.measure && e.surface == run.surface;
    });
    if (at == out.end()) {
      out.push_back({run.rays, run.measure, run.surface, 0.0, 0.0, 0.0, 0.0, 0.0, 0});
      errors.emplace_back();
      noise.emplace_back();
      at = out.end() - 1;
    }
    const auto place = static_cast<std::size_t>(at - out.begin());
    errors[place].push_back(prediction_error(run.real.mean, run.predicted));
    const double own_noise = run.predicted > 0.0 ? run.real.standard_error / run.predicted : 0.0;
    noise[place].push_back(own_noise);
    at->max_beyond_noise = std::max(at->max_beyond_noise, errors[place].back() - 2.0 * own_noise);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Spread spread = spread_of(errors[i]);
    out[i].mean = mean_of(errors[i]).mean;
    out[i].median = spread.median;
    out[i].max = spread.max;
    out[i].noise = mean_of(noise[i]).mean;
    out[i].count = spread.count;
  }
  return out;
}

}  // namespace gnomon
