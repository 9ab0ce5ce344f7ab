#include "gnomon/compare/contest.h"

#include <time.h>

#include <algorithm>
#include <chrono>

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
  double longest = 0.0;
  for (int round = 0; round < most; ++round) {
    const double start = now();
    if (round > 0 && start + longest > deadline) return;
    for (std::size_t i = 0; i < contestants.size(); ++i)
      time_once(contestants[round % 2 == 0 ? i : contestants.size() - 1 - i]);
    longest = std::max(longest, now() - start);
    if (after_round) after_round(round + 1, most);
  }
}

}  // namespace gnomon::compare
