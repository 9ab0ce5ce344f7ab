// Many set-ups' runs in a few figures: how far we are from what was published, builders against each other,
// and how well costs were predicted. Feeds the command line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gnomon/measure/published_results.h"
#include "gnomon/measure/reproduce.h"

namespace gnomon {

// Our local cost of a variant beside the published one.
struct Comparison {
  std::string set_up;
  std::string variant;
  std::string flag;  // of the published row
  double published = 0.0;
  double measured = 0.0;
  double standard_error = 0.0;  // of measured
  double published_sah = 0.0;   // SAH's estimate of the tree: what differs in it is no sampling noise
  double measured_sah = 0.0;
  [[nodiscard]] double ratio() const { return measured / published; }
  [[nodiscard]] double deviation() const { return ratio() > 1.0 ? ratio() - 1.0 : 1.0 - ratio(); }
  // How far off in standard errors of the difference, when what was published is a mean over as many rays.
  // Over rows of equal trees its square is 1 in the mean.
  [[nodiscard]] double errors_off() const;
};

// Costs of one builder over those of another on the same rays. A win is a lower cost.
struct Duel {
  std::string builder;
  std::string against;
  RayMeasure rays = RayMeasure::kParallel;  // of the last set-up; meaningful where all have the same
  double geomean = 1.0;
  double worst = 0.0;
  std::uint64_t wins = 0;
  std::uint64_t count = 0;
};

// |real - predicted| / predicted of one measure on rays of another, over set-ups.
struct PredictionErrors {
  RayMeasure rays = RayMeasure::kParallel;
  RayMeasure measure = RayMeasure::kParallel;
  bool surface = false;
  double mean = 0.0;
  double median = 0.0;
  double max = 0.0;
  double noise = 0.0;  // mean of the real costs' relative standard errors: what sampling alone would make
  double max_beyond_noise = 0.0;  // of |real - predicted| less two standard errors, relative like the others
  std::uint64_t count = 0;
};

class ReproduceSummary {
 public:
  // Costs that deviate by more are listed.
  static constexpr double kLargeDeviation = 0.12;

  void add(const SetUp& set_up, const SetUpReport& report, const PublishedResults& published);

  // Of the rows that are what they say, or of the flagged ones; 0 for none.
  [[nodiscard]] double median_deviation(bool flagged) const;
  [[nodiscard]] std::uint64_t compared(bool flagged) const;
  [[nodiscard]] std::vector<Comparison> large_deviations() const;
  // Of the rows that are what they say: the root of the mean square of errors_off, and how many have SAH's
  // estimate within a relative `bound` of the published.
  [[nodiscard]] double rms_errors_off() const;
  [[nodiscard]] std::uint64_t estimates_within(double bound) const;
  [[nodiscard]] const std::vector<Comparison>& comparisons() const { return comparisons_; }
  // Published variants against Standard.
  [[nodiscard]] std::vector<Duel> variant_duels() const;
  // PAH3 against SAH3: on the thesis' rays, then on rays of each measure.
  [[nodiscard]] Duel three_axes_duel() const;
  [[nodiscard]] std::vector<Duel> three_axes_duels_by_measure() const;
  [[nodiscard]] std::vector<PredictionErrors> prediction_errors() const;

 private:
  struct Run {
    std::uint64_t set_up;
    bool thesis_rays;
    RayMeasure rays;
    std::string builder;
    double cost;
  };
  template <typename Wanted>
  [[nodiscard]] Duel duel(const std::string& builder, const std::string& against, Wanted wanted) const;

  std::uint64_t set_ups_ = 0;
  std::vector<Comparison> comparisons_;
  std::vector<Run> runs_;
  std::vector<PredictionRun> predictions_;
};

}  // namespace gnomon
