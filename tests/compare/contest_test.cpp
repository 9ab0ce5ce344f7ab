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
