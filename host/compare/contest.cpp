#include "gnomon/compare/contest.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace gnomon::compare {
namespace {

double cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void time_once(Contestant& contestant) {
  const double wall = wall_now();
  const double cpu = cpu_now();
  contestant.work();
  contestant.rounds.cpu_s.push_back(cpu_now() - cpu);
  contestant.rounds.wall_s.push_back(wall_now() - wall);
}

}  // namespace

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run_contest(std::span<Contestant> contestants, int most, double deadline, const Clock& now,
                 const std::function<void(int, int)>& after_round) {
  const std::size_t count = contestants.size();
  std::size_t sits_out = count;
  double longest = 0.0;
  for (int round = 0; round < most; ++round) {
    const double start = now();
    if (round > 0 && start + longest > deadline) return;
    std::vector<double> took(count, 0.0);
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t i = round % 2 == 0 ? place : count - 1 - place;
      if (i == sits_out) continue;
      const double begun = now();
      time_once(contestants[i]);
      took[i] = now() - begun;
    }
    const double whole = now() - start;
    longest = std::max(longest, whole);
    if (round == 0 && start + most * whole > deadline) {
      const auto slowest = std::max_element(took.begin(), took.end());
      if (slowest != took.begin() && *slowest > 0.5 * whole) {
        sits_out = static_cast<std::size_t>(slowest - took.begin());
        longest = whole - *slowest;
      }
    }
    if (after_round) after_round(round + 1, most);
  }
}

std::uint64_t fitting_rays(std::uint64_t wished, int rounds, double deadline, const Clock& now,
                           const std::function<double(std::uint64_t)>& seconds_per_ray) {
  constexpr double kUsed = 0.9;         // of the time, as rounds vary
  constexpr double kTried = 0.125;      // of it, to find out
  constexpr std::uint64_t kGrowth = 8;  // of the rays that tell
  const std::uint64_t least = std::min(kLeastRays, wished);
  const auto left = [&] { return std::max(0.0, deadline - now()); };
  // Beside the rounds there is one that counts boxes and triangles.
  const auto fit = [&](double per_ray) { return kUsed * left() / (per_ray * (rounds + 1)); };
  static_cast<void>(seconds_per_ray(least));  // warms up
  double per_ray = seconds_per_ray(least);
  for (std::uint64_t tried = least; fit(per_ray) < static_cast<double>(wished);) {
    if (per_ray * static_cast<double>(tried) > kTried * left()) break;
    per_ray = std::min(per_ray, seconds_per_ray(tried));
    tried *= kGrowth;
    if (fit(per_ray) >= static_cast<double>(wished) || tried > wished ||
        per_ray * static_cast<double>(tried) > kTried * left())
      break;
    per_ray = std::min(per_ray, seconds_per_ray(tried));
  }
  const double fits = fit(per_ray);
  std::uint64_t count = wished;
  while (count > least && static_cast<double>(count) > fits) count /= 2;
  return std::max(count, least);
}

}  // namespace gnomon::compare
