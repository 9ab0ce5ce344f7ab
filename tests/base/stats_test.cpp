// Median and spread.
#include "gnomon/base/stats.h"

#include <array>
#include <catch2/catch.hpp>

using gnomon::median_index;
using gnomon::spread_of;

TEST_CASE("the median of an odd count is its middle value, of an even one the mean of the middle two") {
  const std::array<double, 5> odd{5.0, 1.0, 4.0, 2.0, 100.0};
  CHECK(spread_of(odd).median == 4.0);
  CHECK(spread_of(odd).min == 1.0);
  CHECK(spread_of(odd).max == 100.0);
  CHECK(spread_of(odd).count == 5);
  const std::array<double, 4> even{8.0, 2.0, 4.0, 1.0};
  CHECK(spread_of(even).median == 3.0);
  CHECK(spread_of(std::array<double, 1>{7.0}).median == 7.0);
}

TEST_CASE("no values, all zeros") {
  CHECK(spread_of({}).count == 0);
  CHECK(spread_of({}).median == 0.0);
  CHECK(median_index({}) == 0);
}

TEST_CASE("median_index is the place of a value that was really measured") {
  CHECK(median_index(std::array<double, 3>{3.0, 1.0, 2.0}) == 2);
  CHECK(median_index(std::array<double, 4>{4.0, 1.0, 3.0, 2.0}) == 3);  // the lower of 2 and 3
  CHECK(median_index(std::array<double, 1>{9.0}) == 0);
}
