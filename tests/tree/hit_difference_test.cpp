// Answers held against exact ones: every way to differ is counted once, by name.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "gnomon/tree/hit_difference.h"

using gnomon::difference_of;

namespace {

GnHit hit(float t, std::uint32_t primitive) {
  return {t, 0.25F, 0.25F, primitive};
}
const GnHit kMiss{std::numeric_limits<float>::infinity(), 0, 0, GN_NONE};

gnomon::HitDifference one(const GnHit& exact, const GnHit& other) {
  const std::vector<GnHit> a{exact};
  const std::vector<GnHit> b{other};
  return difference_of(std::span<const GnHit>(a), std::span<const GnHit>(b));
}

}  // namespace

TEST_CASE("hits that are lost, added, of another triangle or off are told apart") {
  CHECK(one(hit(3, 1), hit(3, 1)).wrong() == 0);
  CHECK(one(hit(3, 1), hit(3, 1)).max_t_ulp == 0.0);
  CHECK(one(kMiss, kMiss).wrong() == 0);
  CHECK(one(hit(3, 1), kMiss).lost == 1);
  CHECK(one(hit(3, 1), hit(3.01F, 2)).lost == 1);
  CHECK(one(kMiss, hit(3, 1)).added == 1);
  CHECK(one(hit(3, 1), hit(2.99F, 2)).added == 1);
  CHECK(one(hit(3, 1), hit(3.00001F, 2)).other_triangle == 1);
  CHECK(one(hit(3, 1), hit(3, 2)).wrong() == 0);  // a tie
  const auto off = one(hit(3, 1), hit(std::nextafter(3.0F, 4.0F), 1));
  CHECK(off.wrong() == 0);
  CHECK(off.max_t_ulp == 1.0);
  CHECK(one(hit(-3, 1), hit(-2.9F, 2)).lost == 1);
  for (const auto& d : {one(hit(3, 1), kMiss), one(kMiss, hit(3, 1)), one(hit(3, 1), hit(2.99F, 2))}) {
    CHECK(d.rays == 1);
    CHECK(d.wrong() == 1);
  }
}

TEST_CASE("any-hit answers are lost or added") {
  const std::vector<std::uint32_t> exact{1, 1, 0, 0};
  const std::vector<std::uint32_t> other{1, 0, 1, 0};
  const auto d = difference_of(std::span<const std::uint32_t>(exact), std::span<const std::uint32_t>(other));
  CHECK(d.hits == 2);
  CHECK(d.lost == 1);
  CHECK(d.added == 1);
}
