// Median and spread of repeated measurements. Not for sums over rays or nodes. Feeds the command line and
// benches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace gnomon {

struct Spread {
  double median = 0.0;  // of an even count: the mean of the middle two
  double min = 0.0;
  double max = 0.0;
  std::size_t count = 0;
};

// All zeros for no values.
[[nodiscard]] inline Spread spread_of(std::span<const double> values) {
  if (values.empty()) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  return {0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]), sorted.front(), sorted.back(), n};
}

// The place of the value that is the median, or the lower of the middle two: the run whose details to show.
[[nodiscard]] inline std::size_t median_index(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order.empty() ? 0 : order[(order.size() - 1) / 2];
}

}  // namespace gnomon
