// Which of several trees costs given rays least: candidates beside a baseline on the same rays, as few as
// will tell. Feeds plans.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gnomon {

struct RaceOptions {
  double least_gain = 0.02;   // a candidate must be cheaper than the baseline by this share; [0, 1)
  double certainty = 2.0;     // standard errors that decide; > 0
  std::uint32_t batch = 64;   // rays between two looks; 1 or more
  std::uint32_t least = 128;  // rays before the first decision: fewer have no spread to speak of

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

enum class Verdict : std::uint32_t {
  kBetter,     // cheaper than the baseline by least_gain, certainly
  kNotBetter,  // certainly not
  kBeaten,     // another candidate is certainly cheaper
  kOpen,       // the rays ended before it was certain: counts as not better
};
[[nodiscard]] const char* to_string(Verdict verdict);

struct Standing {
  Verdict verdict = Verdict::kOpen;
  std::uint64_t rays = 0;  // it was traced with
  double cost = 0.0;       // mean over those rays
  double baseline = 0.0;   // the baseline's over the same
  double error = 0.0;      // standard error of cost - baseline
};

struct Race {
  std::vector<Standing> standings;     // one a candidate
  std::uint64_t rays = 0;              // the baseline was traced with
  double baseline = 0.0;               // its mean cost over them
  std::uint32_t winner = 0xffffffffU;  // the cheapest kBetter one; none
  double units = 0.0;                  // what all tracing cost
};

// Costs of rays [first, first + count) in tree `tree`: 0 the baseline, 1 + i candidate i.
using CostsOf = std::function<std::vector<double>(std::size_t tree, std::size_t first, std::size_t count)>;

// A sequential test on paired differences; candidates drop out as soon as their case is clear, and the race
// ends with the last open case. Rays should be in random order. Deterministic. Throws Error{kInvalidArgument}
// (options).
[[nodiscard]] Race race(std::size_t candidates, std::size_t rays, const CostsOf& costs_of,
                        const RaceOptions& options = {});

}  // namespace gnomon
