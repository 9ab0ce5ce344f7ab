// Timing several ways to do the same work: rounds in which each runs once, next to the others, in an order
// that turns with the rounds, and of as many rays as there is time for. Feeds run_device.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

struct Contestant {
  std::function<void()> work;
  Rounds rounds;
};

// Seconds since some start. For contests that must end in time; tests bring their own.
using Clock = std::function<double()>;
[[nodiscard]] double wall_now();

inline constexpr std::uint64_t kLeastRays = 1024;

// Up to `most` rounds, at least one: none begins when its end, as the longest before it tells, would lie
// after `deadline` of `now`. Where that would leave fewer than `most`, a contestant other than the first that
// takes more than half of the first round sits out the others, so that they are not ended by it. Contestants
// have run before, once at least: there is no round to warm up. after_round(done, most) may throw.
void run_contest(std::span<Contestant> contestants, int most, double deadline, const Clock& now,
                 const std::function<void(int, int)>& after_round = {});

// How many rays every one of `rounds` rounds can have by `deadline` of `now`: `wished`, or a half of that,
// and so on, but not fewer than kLeastRays. seconds_per_ray(count) traces a round of so many rays. Few rays
// cost more each than many, and a single measurement is at a busy machine's mercy: where few do not seem to
// fit, they are traced again, and then more of them, in an eighth of the time.
[[nodiscard]] std::uint64_t fitting_rays(std::uint64_t wished, int rounds, double deadline, const Clock& now,
                                         const std::function<double(std::uint64_t)>& seconds_per_ray);
}  // namespace gnomon::compare
