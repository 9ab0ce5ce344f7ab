// What rows say: which method wins from how many rays on, what it gains and how sure that is. Pure functions
// of a report. Feeds charts and words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gnomon/base/stats.h"
#include "gnomon/compare/report.h"

namespace gnomon::compare {

// All kinds of rays together: as many of each.
inline constexpr const char* kAllKinds = "all";

// A method's time as a line: build_s + rays * ray_s.
struct Line {
  std::string method;
  double build_s = 0.0;
  double ray_s = 0.0;
};

// Kinds that were traced, in order.
[[nodiscard]] std::vector<std::string> kinds_of(const DeviceReport& device);
// One per method that has been built and traced in every round asked for, in the methods' order. ray_s of
// kAllKinds is the mean over kinds. Medians over rounds.
[[nodiscard]] std::vector<Line> lines_of(const DeviceReport& device, const std::string& kind,
                                         const std::string& clock);

// The rays from which `other` is done sooner than `base`: 0 always, nothing never.
[[nodiscard]] std::optional<double> break_even(const Line& base, const Line& other);

// Who is done first, and from how many rays on: the lower envelope of the lines, from 0 rays on. Of equal
// ones the earlier in the list.
struct Reign {
  std::string method;
  double from_rays = 0.0;
};
[[nodiscard]] std::vector<Reign> fastest_by_rays(const std::vector<Line>& lines);

// Places of the points that no other beats in both values (less is better), by rising x. Of equal points the
// first.
struct Point {
  double x = 0.0;
  double y = 0.0;
};
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<Point>& points);

// base / own of rounds that both have.
[[nodiscard]] Spread ratios(const std::vector<double>& base, const std::vector<double>& own);
// How many times as fast the method traces as `base`, round by round: above 1 is faster.
[[nodiscard]] Spread trace_gain(const DeviceReport& device, const std::string& base,
                                const std::string& method, const std::string& kind, const std::string& clock);
[[nodiscard]] Spread build_gain(const DeviceReport& device, const std::string& base,
                                const std::string& method, const std::string& clock);
// How many times as fast the device is with kBaseline as the report's first, round by round; kind empty:
// building.
[[nodiscard]] Spread across_gain(const Report& report, const DeviceReport& device, const std::string& kind);
// Whether all rounds agree that it is faster (min above 1), slower (max below 1), or not.
enum class Verdict { kFaster, kSlower, kUndecided };
[[nodiscard]] Verdict verdict_of(const Spread& gain);
// The chance that the true median lies within the least and greatest of n rounds: 1 - 2^(1-n); 0 for none.
[[nodiscard]] double certainty(std::size_t rounds);

// Wrong answers and judged ones, over all kinds. Judged 0: not known.
struct Wrong {
  std::uint64_t wrong = 0;
  std::uint64_t judged = 0;
  [[nodiscard]] double share() const {
    return judged == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(judged);
  }
};
[[nodiscard]] Wrong wrong_of(const DeviceReport& device, const std::string& method);

// The first paragraphs of a page, in plain words; sentences without markup.
struct Advice {
  std::string use;       // what to use
  std::string how;       // the options of gnomon build that make it
  std::string gain;      // what it gains over kBaseline, by kind, and how sure
  std::string cost;      // what it costs
  std::string no_gain;   // where it is no better
  std::string accuracy;  // whose answers are right
  std::string best;      // the method recommended for many rays
  std::vector<std::string> all() const { return {use, how, gain, cost, no_gain, accuracy}; }
};
[[nodiscard]] Advice advise(const Report& report, const DeviceReport& device);

}  // namespace gnomon::compare
