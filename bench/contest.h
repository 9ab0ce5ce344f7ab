// Timing several ways to do the same work against each other: rounds in which each runs once, in an order
// that turns with the rounds, process CPU time and wall time. Feeds gnomon_bench.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "paired.h"

namespace gnomon::bench {

struct Contestant {
  std::string name;
  std::function<void()> work;
  std::vector<double> cpu_seconds{};
  std::vector<double> wall_seconds{};
};

inline void time_once(Contestant& contestant) {
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  contestant.work();
  contestant.cpu_seconds.push_back(cpu_seconds() - cpu);
  contestant.wall_seconds.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count());
}

// One round to warm up, then `rounds` that count.
inline void run_contest(std::vector<Contestant>& contestants, int rounds) {
  for (Contestant& contestant : contestants) contestant.work();
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const bool forwards = round % 2 == 0;
      time_once(contestants[forwards ? i : contestants.size() - 1 - i]);
    }
  }
}

// b's time over a's, round by round: above 1, a is faster.
inline std::vector<double> speed_ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(b[i] / a[i]);
  return ratios;
}

}  // namespace gnomon::bench
