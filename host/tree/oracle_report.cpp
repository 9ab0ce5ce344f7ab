// Sums of judgements.
#include <algorithm>
#include <limits>

#include "gnomon/tree/oracle.h"

namespace gnomon {

void ErrorCounts::add(double ulp) {
  const double step = ulp * static_cast<double>(kPerUlp);
  const std::size_t last = steps.size() - 1;
  steps[step < static_cast<double>(last) ? static_cast<std::size_t>(step) : last] += 1;  // NaN is the last
}

double ErrorCounts::quantile(double share) const {
  std::uint64_t all = 0;
  for (const std::uint64_t count : steps) all += count;
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    seen += steps[i];
    if (all == 0 || static_cast<double>(seen) < share * static_cast<double>(all)) continue;
    if (i + 1 == steps.size()) return std::numeric_limits<double>::infinity();
    return static_cast<double>(i + 1) / static_cast<double>(kPerUlp);
  }
  return 0.0;
}

void OracleReport::add(const OracleReport& other) {
  rays_given += other.rays_given;
  rays_judged += other.rays_judged;
  budget_exhausted = budget_exhausted || other.budget_exhausted;
  hits += other.hits;
  lost += other.lost;
  false_hits += other.false_hits;
  wrong_primitive += other.wrong_primitive;
  ties += other.ties;
  any_closest_disagree += other.any_closest_disagree;
  range_ambiguous += other.range_ambiguous;
  range_rounded += other.range_rounded;
  max_t_error_ulp = std::max(max_t_error_ulp, other.max_t_error_ulp);
  for (std::size_t i = 0; i < t_errors.steps.size(); ++i) t_errors.steps[i] += other.t_errors.steps[i];
  max_uv_error = std::max(max_uv_error, other.max_uv_error);
  bad_rays.insert(bad_rays.end(), other.bad_rays.begin(), other.bad_rays.end());
}

}  // namespace gnomon
