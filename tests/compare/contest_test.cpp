// Rounds that take turns and end in time.
#include <catch2/catch.hpp>
#include <string>

#include "gnomon/compare/contest.h"

using namespace gnomon::compare;

TEST_CASE("every round runs all once, next to each other, and every other round backwards") {
  std::string order;
  std::vector<Contestant> contest{
      {[&] { order += 'a'; }, {}}, {[&] { order += 'b'; }, {}}, {[&] { order += 'c'; }, {}}};
  run_contest(contest, 4, 1e9, [] { return 0.0; });
  CHECK(order == "abccbaabccba");
  for (const Contestant& contestant : contest) {
    REQUIRE(contestant.rounds.wall_s.size() == 4);
    REQUIRE(contestant.rounds.cpu_s.size() == 4);
  }
}

TEST_CASE("no round begins that would end after the deadline, but one always runs") {
  double time = 0.0;
  int runs = 0;
  std::vector<Contestant> contest{{[&] { time += 2.0, ++runs; }, {}}};
  run_contest(contest, 100, 7.0, [&] { return time; });
  CHECK(runs == 3);  // the fourth would end at 8
  run_contest(contest, 100, 0.0, [&] { return time; });
  CHECK(runs == 4);
}

TEST_CASE("what is called after a round may end the contest") {
  std::vector<Contestant> contest{{[] {}, {}}};
  REQUIRE_THROWS_AS(run_contest(
                        contest, 5, 1e9, [] { return 0.0; },
                        [](int done, int most) {
                          REQUIRE(most == 5);
                          if (done == 2) throw 1;
                        }),
                    int);
  CHECK(contest[0].rounds.wall_s.size() == 2);
}

TEST_CASE(
    "one that takes most of a round sits out the others where they would not fit with it, never the first") {
  double time = 0.0;
  const auto takes = [&](double seconds) { return [&time, seconds] { time += seconds; }; };
  const auto rounds_of = [&](std::vector<Contestant> contest, double deadline) {
    time = 0.0;
    run_contest(contest, 5, deadline, [&] { return time; });
    std::vector<std::size_t> rounds;
    for (const Contestant& contestant : contest) rounds.push_back(contestant.rounds.wall_s.size());
    return rounds;
  };
  using Counts = std::vector<std::size_t>;
  CHECK(rounds_of({{takes(1), {}}, {takes(10), {}}, {takes(2), {}}}, 65.0) == Counts{5, 5, 5});
  CHECK(rounds_of({{takes(1), {}}, {takes(10), {}}, {takes(2), {}}}, 64.0) == Counts{5, 1, 5});
  CHECK(rounds_of({{takes(1), {}}, {takes(10), {}}, {takes(2), {}}}, 20.0) == Counts{3, 1, 3});
  // Not half of a round: nobody sits out, and rounds are fewer.
  CHECK(rounds_of({{takes(5), {}}, {takes(5), {}}, {takes(5), {}}}, 64.0) == Counts{4, 4, 4});
  CHECK(rounds_of({{takes(10), {}}, {takes(1), {}}}, 40.0) == Counts{3, 3});
}

TEST_CASE("rays fit as many of them cost, not as the first few do") {
  double time = 0.0;
  std::vector<std::uint64_t> tried;
  // A fiftieth of a second beside a second for a million, as launches take it.
  const auto seconds_per_ray = [&](std::uint64_t count) {
    tried.push_back(count);
    const double seconds = 0.02 + 1e-6 * static_cast<double>(count);
    time += seconds;
    return seconds / static_cast<double>(count);
  };
  const auto fitting = [&](std::uint64_t wished, double deadline) {
    time = 0.0;
    tried.clear();
    return fitting_rays(
        wished, 7, deadline, [&] { return time; }, seconds_per_ray);
  };
  CHECK(fitting(1'000'000, 12.0) == 1'000'000);  // by the first 1024 alone, in 21 ms, 62500
  CHECK(tried.back() == 65'536);
  CHECK(time + 8.0 * 1.02 < 12.0);  // seven rounds of these, and one that counts, end in time
  CHECK(fitting(1'000'000, 6.0) == 500'000);
  CHECK(time + 8.0 * 0.52 < 6.0);
  CHECK(fitting(1'000'000, 0.0) == kLeastRays);
  CHECK(tried.size() == 2);
  CHECK(fitting(100, 0.0) == 100);
  CHECK(tried == std::vector<std::uint64_t>{100, 100});
  CHECK(fitting(4096, 1e9) == 4096);
  CHECK(tried == std::vector<std::uint64_t>{kLeastRays, kLeastRays});  // all fit: nothing more is asked
}

TEST_CASE("one measurement that the machine delayed does not take rays away") {
  double time = 0.0;
  int calls = 0;
  const auto seconds_per_ray = [&](std::uint64_t count) {
    const double seconds = 1e-6 * static_cast<double>(count) + (++calls == 2 ? 0.1 : 0.0);
    time += seconds;
    return seconds / static_cast<double>(count);
  };
  CHECK(fitting_rays(
            65'536, 7, 3.0, [&] { return time; }, seconds_per_ray) == 65'536);
  CHECK(time < 0.12);
}
