// Races of candidates beside a baseline: who wins, how soon, and how rarely by chance.
#include "gnomon/plan/race.h"

#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "support/shapes.h"

using gnomon::Race;
using gnomon::race;
using gnomon::RaceOptions;
using gnomon::Verdict;

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

// Costs around 100 that spread by half; candidate i is `factors[i]` of the baseline, with noise of its own.
class Costs {
 public:
  Costs(std::vector<double> factors, std::uint32_t seed, double noise = 10.0) : factors_(std::move(factors)) {
    gnomon::test::Random random(seed);
    for (int i = 0; i < 1024; ++i) {
      base_.push_back(100.0 + double{random.between(-50.0F, 50.0F)});
      noise_.emplace_back();
      for (std::size_t k = 0; k < factors_.size(); ++k)
        noise_.back().push_back(noise * double{random.between(-1.0F, 1.0F)});
    }
  }

  std::vector<double> operator()(std::size_t tree, std::size_t first, std::size_t count) {
    std::vector<double> out;
    for (std::size_t i = first; i < first + count; ++i) {
      out.push_back(tree == 0 ? base_[i] : base_[i] * factors_[tree - 1] + noise_[i][tree - 1]);
      traced += 1;
    }
    return out;
  }

  std::size_t traced = 0;

 private:
  std::vector<double> factors_, base_;
  std::vector<std::vector<double>> noise_;
};

Race run(Costs& costs, std::size_t candidates, const RaceOptions& options = {}) {
  return race(
      candidates, 1024, [&](std::size_t t, std::size_t f, std::size_t c) { return costs(t, f, c); }, options);
}

}  // namespace

TEST_CASE("a much cheaper candidate wins after the fewest rays there may be") {
  Costs costs({0.5}, 1);
  const Race result = run(costs, 1);
  REQUIRE(result.winner == 0);
  REQUIRE(result.rays == 128);
  REQUIRE(costs.traced == 2 * 128);
  REQUIRE(result.standings[0].verdict == Verdict::kBetter);
  REQUIRE(result.standings[0].cost == Approx(0.5 * result.standings[0].baseline).margin(2.0));
  REQUIRE(result.baseline == result.standings[0].baseline);
  REQUIRE(result.units == Approx(128 * (result.baseline + result.standings[0].cost)));
}

TEST_CASE("a dearer one drops out early, a clear second is beaten, the best goes on") {
  Costs costs({1.3, 0.8, 0.5}, 2);
  const Race result = run(costs, 3);
  REQUIRE(result.winner == 2);
  REQUIRE(result.standings[0].verdict == Verdict::kNotBetter);
  REQUIRE(result.standings[1].verdict == Verdict::kBeaten);
  REQUIRE(result.rays < 1024);
}

TEST_CASE("of equals the first wins") {
  Costs costs({0.5, 0.5}, 3, 0.0);
  const Race result = run(costs, 2);
  REQUIRE(result.winner == 0);
  REQUIRE(result.standings[1].verdict == Verdict::kBeaten);
}

TEST_CASE("what is not certain is not kept") {
  // One per cent cheaper where two are asked for; then 2.05 with much noise.
  Costs slightly({0.99}, 4, 1.0);
  REQUIRE(run(slightly, 1).standings[0].verdict == Verdict::kNotBetter);
  Costs noisy({0.9795}, 5, 40.0);
  const Race open = run(noisy, 1);
  REQUIRE(open.rays == 1024);
  REQUIRE(open.standings[0].verdict == Verdict::kOpen);
  REQUIRE(open.winner == kNone);
  REQUIRE(run(noisy, 0).winner == kNone);
}

TEST_CASE("a candidate that is not better is hardly ever kept") {
  std::uint32_t same = 0;
  std::uint32_t dearer = 0;
  std::uint32_t better = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Costs as_dear({1.0}, 100 + seed, 40.0);
    same += run(as_dear, 1).winner != kNone ? 1 : 0;
    Costs worse({1.01}, 500 + seed, 40.0);
    dearer += run(worse, 1).winner != kNone ? 1 : 0;
    Costs cheaper({0.9}, 900 + seed, 40.0);
    better += run(cheaper, 1).winner != kNone ? 1 : 0;
  }
  CAPTURE(same, dearer, better);
  REQUIRE(same <= 9);
  REQUIRE(dearer <= 3);
  REQUIRE(better >= 297);
}

TEST_CASE("race options out of range are refused") {
  const auto costs = [](std::size_t, std::size_t, std::size_t count) { return std::vector<double>(count); };
  RaceOptions options;
  options.least_gain = 1.0;
  REQUIRE_THROWS_WITH(race(1, 10, costs, options), Catch::Contains("least_gain"));
  options = {};
  options.batch = 0;
  REQUIRE_THROWS_WITH(race(1, 10, costs, options), Catch::Contains("batch"));
  options = {};
  options.certainty = 0.0;
  REQUIRE_THROWS_WITH(race(1, 10, costs, options), Catch::Contains("certainty"));
}
