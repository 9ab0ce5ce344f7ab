// What is made of rows: break-even, who is fastest from where, the Pareto front, and what is advised.
#include <catch2/catch.hpp>

#include "gnomon/compare/analysis.h"
#include "support/sample_report.h"

using namespace gnomon::compare;
using Catch::Contains;
using gnomon::compare::test::sample_report;

namespace {

Line line(const char* name, double build, double ray) {
  return {name, build, ray};
}

const TraceRow* trace_of(const DeviceReport& device, const std::string& method, const std::string& kind) {
  for (const TraceRow& row : device.traces)
    if (row.method == method && row.kind == kind) return &row;
  return nullptr;
}

}  // namespace

TEST_CASE("a dearer build that traces faster is paid back after the quotient of the differences") {
  const Line base = line("base", 1.0, 0.5);
  CHECK(break_even(base, line("other", 2.0, 0.25)) == 4.0);
  CHECK(break_even(base, line("cheaper and faster", 0.5, 0.25)) == 0.0);
  CHECK(break_even(base, line("the same", 1.0, 0.5)) == 0.0);
  CHECK_FALSE(break_even(base, line("dearer and slower", 2.0, 0.75)).has_value());
  CHECK_FALSE(break_even(base, line("dearer and as fast", 2.0, 0.5)).has_value());
  // Ahead for the first rays only: never from some number of rays on.
  CHECK_FALSE(break_even(base, line("cheaper and slower", 0.5, 0.75)).has_value());
}

TEST_CASE("the fastest method changes where lines of the lower envelope cross") {
  const auto reigns = fastest_by_rays({line("middle", 1.0, 1.0), line("quick to build", 0.0, 3.0),
                                       line("slow to build", 5.0, 0.5), line("never", 2.0, 2.0)});
  REQUIRE(reigns.size() == 3);
  CHECK(reigns[0].method == "quick to build");
  CHECK(reigns[0].from_rays == 0.0);
  CHECK(reigns[1].method == "middle");
  CHECK(reigns[1].from_rays == 0.5);
  CHECK(reigns[2].method == "slow to build");
  CHECK(reigns[2].from_rays == 8.0);
}

TEST_CASE("one line below all others reigns alone, and of equal ones the first") {
  const auto reigns = fastest_by_rays({line("a", 1.0, 1.0), line("b", 1.0, 1.0), line("c", 1.0, 2.0)});
  REQUIRE(reigns.size() == 1);
  CHECK(reigns[0].method == "a");
  CHECK(fastest_by_rays({}).empty());
  // Equal builds: the faster tracer has no rival from the first ray on.
  const auto equal = fastest_by_rays({line("a", 1.0, 2.0), line("b", 1.0, 1.0)});
  REQUIRE(equal.size() == 1);
  CHECK(equal[0].method == "b");
}

TEST_CASE("at any number of rays the reigning line is the least") {
  const std::vector<Line> lines{line("a", 3.0, 0.1), line("b", 0.5, 4.0), line("c", 1.0, 1.0),
                                line("d", 2.0, 0.4), line("e", 9.0, 0.09)};
  const auto reigns = fastest_by_rays(lines);
  for (double rays = 0.0; rays < 2000.0; rays += 0.37) {
    const Reign* now = nullptr;
    for (const Reign& reign : reigns)
      if (reign.from_rays <= rays) now = &reign;
    double least = 1e300;
    double reigning = 0.0;
    for (const Line& l : lines) {
      least = std::min(least, l.build_s + rays * l.ray_s);
      if (now != nullptr && l.method == now->method) reigning = l.build_s + rays * l.ray_s;
    }
    CAPTURE(rays);
    REQUIRE(now != nullptr);
    REQUIRE(reigning == Approx(least));
  }
}

TEST_CASE("the Pareto front has the points that none beats in both values") {
  const std::vector<Point> points{{2.0, 2.0}, {1.0, 3.0}, {3.0, 1.0}, {3.0, 3.0},
                                  {2.0, 2.0}, {1.0, 4.0}, {4.0, 1.0}};
  CHECK(pareto_front(points) == std::vector<std::size_t>{1, 0, 2});
  CHECK(pareto_front({}).empty());
}

TEST_CASE("gains are ratios of the same round, and claim nothing where rounds disagree") {
  auto report = sample_report();
  DeviceReport& device = report.devices[0];
  const auto gain = trace_gain(device, "sah-balanced", "sah-best", "primary", "wall");
  CHECK(gain.median == 2.0);
  CHECK(gain.min == 1.6);
  CHECK(gain.max == 2.0);
  CHECK(gain.count == 3);
  CHECK(verdict_of(gain) == Verdict::kFaster);
  CHECK(verdict_of(trace_gain(device, "sah-balanced", "sah-fast", "all", "wall")) == Verdict::kSlower);
  CHECK(verdict_of({1.2, 0.9, 1.4, 7}) == Verdict::kUndecided);
  CHECK(verdict_of({1.2, 1.2, 1.2, 1}) == Verdict::kUndecided);
  CHECK(certainty(7) == Approx(0.984375));
  CHECK(certainty(1) == 0.0);
  CHECK(certainty(0) == 0.0);
}

TEST_CASE("advice names who is fastest from how many rays on, and never one with other answers") {
  const auto report = sample_report();
  const Advice advice = advise(report, report.devices[0]);
  CAPTURE(advice.use, advice.gain, advice.cost, advice.no_gain, advice.accuracy);
  CHECK(advice.best == "sah-best");
  // Means over kinds: 6, 3 and 1.5 ms a ray. 0.5 s / 3 ms, and 3 s / 1.5 ms.
  CHECK_THAT(
      advice.use,
      Contains("for up to 167 rays per build use sah-fast, up to 2000 rays per build use sah-balanced, "
               "beyond 2000 rays use sah-best."));
  CHECK(advice.how ==
        "With gnomon build: sah-fast is --some (what sah-fast is), sah-balanced is --some (what sah-balanced "
        "is) and "
        "sah-best is --some (what sah-best is).");
  CHECK_THAT(advice.gain,
             Contains("2.00 (1.60 to 2.00) times as fast as sah-balanced") && Contains("75.0 % certainty"));
  CHECK_THAT(advice.cost, Contains("4.00 (4.00 to 4.00) times the build time (4.00 s against 1.00 s)") &&
                              Contains("2.00 times the memory (2.00 MiB against 1.00 MiB)") &&
                              Contains("after about 2000 rays"));
  CHECK_THAT(advice.no_gain, Contains("Not faster than sah-balanced for any kind: sah-fast."));
  // Three in 200, what none found leaves possible with 95 % certainty.
  CHECK_THAT(advice.accuracy, Contains("0 of 200 judged rays wrong (so fewer than 15000 in a million,") &&
                                  Contains("embree-default 4 of 200"));
}

TEST_CASE("a dearer build is advised only where it traces faster in every round than the one before it") {
  auto report = sample_report();
  DeviceReport& device = report.devices[0];
  // Faster than the baseline in every round and than sah-best in all but one, by medians in both kinds.
  gnomon::compare::test::add(
      device, {"auto", Family::kMixture, {8.0, 8.0, 8.0}, {0.5, 0.5, 1.5}, {1.0, 1.0, 3.0}, 2 << 20, 0});
  Advice advice = advise(report, device);
  CAPTURE(advice.use, advice.no_gain);
  CHECK(advice.best == "sah-best");
  CHECK_THAT(advice.use, !Contains("auto"));
  CHECK_THAT(advice.no_gain,
             Contains("No difference was shown between tracing by auto and by sah-best, which builds "
                      "sooner: 2.00 (0.83 to 2.00) times as fast."));
  for (const char* kind : {"primary", "bounce"})
    const_cast<TraceRow*>(trace_of(device, "auto", kind))->rounds.wall_s[2] = 0.5;
  advice = advise(report, device);
  CHECK(advice.best == "auto");
  CHECK_THAT(advice.no_gain, !Contains("No difference"));
  // One that is built no sooner, as far as rounds show, has nothing before the one that traces faster.
  for (BuildRow& row : device.builds)
    if (row.method == "sah-best") row.rounds = {{4.0, 4.0, 9.0}, {4.0, 4.0, 9.0}};
  CHECK_THAT(advise(report, device).use, !Contains("sah-best") && Contains("use auto."));
  // What is built in a single round is not held to that.
  for (BuildRow& row : device.builds)
    if (row.method == "auto") row.rounds = {{8.0}, {8.0}};
  advice = advise(report, device);
  CHECK_THAT(advice.use, Contains("sah-best") && Contains("use auto."));
  CHECK_THAT(advice.cost,
             Contains("It costs 8.00 times the build time (8.00 s against 1.00 s, of one round)"));
}

TEST_CASE("advice names the kinds of rays for which the best is not surely better") {
  auto report = sample_report();
  DeviceReport& device = report.devices[0];
  CHECK_THAT(advise(report, device).no_gain, Contains("faster in every round for every kind"));
  // Slower than the baseline's 2 s once, faster twice; over both kinds it wins every round.
  const_cast<TraceRow*>(trace_of(device, "sah-best", "primary"))->rounds.wall_s = {1.0, 1.0, 2.1};
  const Advice advice = advise(report, device);
  CAPTURE(advice.no_gain);
  CHECK(advice.best == "sah-best");
  CHECK_THAT(advice.no_gain,
             Contains("It is no better than sah-balanced for primary rays: there the rounds do not agree"));
}

TEST_CASE("advice says that nothing is better where the rounds do not agree") {
  auto report = sample_report();
  DeviceReport& device = report.devices[0];
  for (const char* kind : {"primary", "bounce"}) {
    auto* trace = const_cast<TraceRow*>(trace_of(device, "sah-best", kind));
    REQUIRE(trace != nullptr);
    trace->rounds.wall_s = {1.0, 1.0, kind == std::string("primary") ? 2.1 : 4.2};
  }
  const Advice advice = advise(report, device);
  CAPTURE(advice.use, advice.no_gain);
  CHECK(advice.best == "sah-balanced");
  CHECK(advice.gain.empty());
  CHECK_THAT(advice.use, Contains("sah-fast") && !Contains("sah-best"));
  CHECK_THAT(advice.no_gain,
             Contains("No method here with the same answers traces faster than sah-balanced"));
}

TEST_CASE("a faster method of ours with other answers is not advised") {
  auto report = sample_report();
  for (AccuracyRow& row : report.devices[0].accuracies)
    if (row.method == "sah-best" && row.kind == "bounce") row.same_as = "";
  const Advice advice = advise(report, report.devices[0]);
  CHECK(advice.best == "sah-balanced");
  CHECK_THAT(advice.accuracy, Contains("sah-best 0 of 200"));
}

TEST_CASE("the clock decides which seconds count") {
  auto report = sample_report();
  report.clock = "cpu";
  for (TraceRow& row : report.devices[0].traces)
    if (row.method == "sah-best") row.rounds.cpu_s = {9.0, 9.0, 9.0};
  CHECK(advise(report, report.devices[0]).best == "sah-balanced");
  report.clock = "wall";
  CHECK(advise(report, report.devices[0]).best == "sah-best");
}

TEST_CASE("there is nothing to advise before anything is traced") {
  auto report = sample_report();
  report.devices[0].traces.clear();
  const Advice advice = advise(report, report.devices[0]);
  CHECK_THAT(advice.use, Contains("nothing to advise"));
  CHECK(advice.best.empty());
}
