#include "gnomon/areas/concentration.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {
namespace {

// Six steps are a factor of nine, so that every radius's ring ends at another step.
constexpr std::size_t kStepsToRing = 6;
constexpr std::size_t kRadii = 36;
constexpr std::size_t kSteps = kRadii + kStepsToRing;

std::array<double, kSteps> steps() {
  std::array<double, kSteps> out{};
  const double factor = std::cbrt(3.0);
  out[kRadii - 1] = kWidestShare;
  for (std::size_t i = kRadii - 1; i-- > 0;) out[i] = out[i + 1] / factor;
  for (std::size_t i = kRadii; i < kSteps; ++i) out[i] = out[i - 1] * factor;
  return out;
}

// n times the divergence of a coin that shows `count` of n heads from one that is expected to show
// `expected`.
double chernoff(double n, double count, double expected) {
  if (count <= expected || expected <= 0.0 || expected >= n) return 0.0;
  double nats = count * std::log(count / expected);
  if (count < n) nats += (n - count) * std::log((n - count) / (n - expected));
  return nats > 0.0 ? nats : 0.0;
}

}  // namespace

Concentration most_concentrated(std::span<const double> shares, std::size_t used) {
  static const std::array<double, kSteps> edges = steps();
  std::array<std::size_t, kSteps + 1> within{};
  for (const double share : shares) {
    if (share > edges.back()) continue;
    ++within[static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), share) - edges.begin())];
  }
  for (std::size_t i = 1; i < kSteps; ++i) within[i] += within[i - 1];
  const auto n = static_cast<double>(shares.size());
  Concentration best;
  for (std::size_t i = 0; i < kRadii; ++i) {
    if (within[i] <= used) continue;
    const auto count = static_cast<double>(within[i] - used);
    const auto ring = static_cast<double>(within[i + kStepsToRing] - within[i]);
    // One ray more than the ring has, so that an empty ring is no proof that nothing could be there.
    const double expected = std::max(n * edges[i], (ring + 1.0) / 8.0);
    const double nats = chernoff(n, count, expected);
    if (nats > best.nats) best = {edges[i], within[i], expected, count / expected, nats};
  }
  return best;
}

}  // namespace gnomon
