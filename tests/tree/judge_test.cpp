// The judge on hand-made device results: each kind of fault is counted in its own field, and in no other.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "gnomon/tree/pair_bound.h"
#include "judge_cases.h"

using gnomon::Hit;
using gnomon::OracleReport;
using gnomon::Ray;
using gnomon::Triangle;
using namespace judge_cases;

namespace {

float ulps_away(float value, int steps) {
  for (; steps > 0; --steps) value = std::nextafter(value, kInf);
  for (; steps < 0; ++steps) value = std::nextafter(value, -kInf);
  return value;
}

OracleReport judge_one(const Ray& ray, const Hit& hit) {
  return gnomon::judge(kWalls, std::vector<Ray>{ray}, std::vector<Hit>{hit}, {});
}

OracleReport judge_any(const Ray& ray, std::uint32_t any) {
  return gnomon::judge(kWalls, std::vector<Ray>{ray}, {}, std::vector<std::uint32_t>{any});
}

const Counts kLost{1, 0, 0, 0, 0, 0};
const Counts kFalse{0, 1, 0, 0, 0, 0};
const Counts kWrong{0, 0, 1, 0, 0, 0};
const Counts kTie{0, 0, 0, 1, 0, 0};
const Counts kDisagree{0, 0, 0, 0, 1, 0};
const Counts kAmbiguous{0, 0, 0, 0, 0, 1};

}  // namespace

TEST_CASE("a missed or farther hit is lost") {
  CHECK(counts(judge_one(ahead(), kMiss)) == kLost);
  CHECK(counts(judge_one(ahead(), hit_at(5, 1))) == kLost);
  CHECK(counts(judge_one(ahead(), hit_at(ulps_away(3, 5), 0))) == kLost);
  CHECK(counts(judge_one(ahead(), hit_at(kInf, 0))) == kLost);
  CHECK(judge_one(ahead(), kMiss).bad_rays == std::vector<std::uint64_t>{0});
  CHECK(judge_one(ahead(), kMiss).hits == 1);
}

TEST_CASE("a hit within the tolerance stands and is measured") {
  CHECK(counts(judge_one(ahead(), hit_at(ulps_away(3, 4), 0))) == kClean);
  CHECK(counts(judge_one(ahead(), hit_at(ulps_away(3, -4), 0))) == kClean);
  CHECK(judge_one(ahead(), hit_at(ulps_away(3, 4), 0)).max_t_error_ulp == 4.0);
  CHECK(judge_one(ahead(), {3, 0.25F, 0.375F, 0}).max_uv_error == 0.125);
  CHECK(judge_one(ahead(), {3, 0.25F, kNan, 0}).max_uv_error == std::numeric_limits<double>::infinity());
}

TEST_CASE("what lies beyond the largest float is not met, and what devices flush is not held against them") {
  const auto judge_in = [](const Triangle& wall, const Ray& ray, const Hit& hit) {
    return counts(
        gnomon::judge(std::vector<Triangle>{wall}, std::vector<Ray>{ray}, std::vector<Hit>{hit}, {}));
  };
  const Ray slow{{0, 0, 0}, 0, {0, 0, 0x1p-100F}, kInf};  // t = 2^130
  CHECK(judge_in(wall_at(0x1p30F), slow, kMiss) == kClean);
  CHECK(judge_in(wall_at(0x1p30F), slow, hit_at(kInf, 0)) == kFalse);
  const Ray back{{0, 0, 0}, -kInf, {0, 0, -0x1p-100F}, kInf};
  CHECK(judge_in(wall_at(0x1p30F), back, kMiss) == kClean);
  CHECK(judge_in(wall_at(0x1p30F), back, hit_at(-kInf, 0)) == kFalse);
  CHECK(judge_in(wall_at(0x1p27F), back, hit_at(-0x1p127F, 0)) == kClean);
  const Ray brim{{0, 0, 0}, 0, {0, 0, 0x1.000002p-100F}, kInf};  // t = FLT_MAX but for rounding
  CHECK(judge_in(wall_at(0x1p28F), brim, kMiss) == kAmbiguous);
  const Ray fast{{0, 0, 0}, -1, {0, 0, 0x1p100F}, kInf};  // t = 2^-134, flushed to zero by some
  CHECK(judge_in(wall_at(0x1p-34F), fast, hit_at(0x1p-134F, 0)) == kClean);
  CHECK(judge_in(wall_at(0x1p-34F), fast, hit_at(0, 0)) == kClean);
  CHECK(judge_in(wall_at(0x1p-34F), fast, hit_at(1, 0)) == kLost);
}

TEST_CASE("a hit that is nearer than any triangle, or where nothing is, is false") {
  CHECK(counts(judge_one(ahead(), hit_at(ulps_away(3, -5), 0))) == kFalse);
  CHECK(counts(judge_one(ahead(), hit_at(1, 0))) == kFalse);
  CHECK(counts(judge_one(ahead(), hit_at(-3, 0))) == kFalse);
  CHECK(counts(judge_one(ahead(), hit_at(kNan, 0))) == kFalse);
  CHECK(counts(judge_one(ahead(10), hit_at(9, 2))) == kFalse);
  CHECK(counts(judge_one(ahead(10), hit_at(11, 2))) == kFalse);
  CHECK(counts(judge_one(ahead(10), kMiss)) == kClean);
  CHECK(counts(judge_one(ahead(0, 2), hit_at(3, 0))) == kFalse);
}

TEST_CASE("a right distance with a triangle that is not there is a wrong primitive") {
  CHECK(counts(judge_one(ahead(), hit_at(3, 1))) == kWrong);
  CHECK(counts(judge_one(ahead(), hit_at(3, 3))) == kWrong);
}

TEST_CASE("a primitive index out of range is a wrong primitive whatever else is reported") {
  for (const std::uint32_t index : {4U, 1000000U, GN_NONE - 1}) {
    CHECK(counts(judge_one(ahead(), hit_at(3, index))) == kWrong);
    CHECK(counts(judge_one(ahead(10), hit_at(kNan, index))) == kWrong);
  }
}

TEST_CASE("another triangle at the same distance is a tie, not a fault") {
  const std::vector<Triangle> doubled{wall_at(3), wall_at(3), wall_at(5)};
  const std::vector<Ray> rays{ahead(), ahead()};
  const std::vector<Hit> hits{hit_at(3, 0), hit_at(3, 1)};
  const OracleReport report = gnomon::judge(doubled, rays, hits, {});
  CHECK(counts(report) == kTie);
  CHECK(report.mismatches() == 0);
  const std::vector<Triangle> split{{{0, 0, 3}, {4, 0, 3}, {0, 4, 3}}, {{0, 0, 3}, {0, 4, 3}, {-4, 0, 3}}};
  CHECK(counts(gnomon::judge(split, std::vector<Ray>{{{0, 1, 0}, 0, {0, 0, 1}, kInf}},
                             std::vector<Hit>{{3, 0.25F, 0, 1}}, {})) == kTie);
}

TEST_CASE("a hit within the tolerance of tmin or tmax may be seen or not") {
  for (const int off : {-3, 0, 3}) {
    CAPTURE(off);
    const Ray only_first = ahead(0, ulps_away(3, off));
    CHECK(counts(judge_one(only_first, hit_at(3, 0))) == kAmbiguous);
    CHECK(counts(judge_one(only_first, kMiss)) == kAmbiguous);
    CHECK(judge_one(only_first, kMiss).hits == (off >= 0 ? 1 : 0));
    CHECK(judge_one(only_first, kMiss).range_rounded == (off >= 0 ? 1 : 0));
    CHECK(judge_one(only_first, hit_at(3, 0)).range_rounded == (off >= 0 ? 0 : 1));
    const Ray only_last = ahead(ulps_away(9, off));
    CHECK(counts(judge_one(only_last, hit_at(9, 2))) == kAmbiguous);
    CHECK(counts(judge_one(only_last, kMiss)) == kAmbiguous);
  }
  CHECK(counts(judge_one(ahead(0, ulps_away(3, 5)), kMiss)) == kLost);
  CHECK(counts(judge_one(ahead(0, ulps_away(3, -5)), kMiss)) == kClean);
  CHECK(counts(judge_one(ahead(ulps_away(9, -5)), kMiss)) == kLost);
  CHECK(counts(judge_one(ahead(ulps_away(9, 5)), hit_at(9, 2))) == kFalse);
}

TEST_CASE("behind a doubtful hit at tmin the next one must be seen") {
  const Ray ray = ahead(3);
  CHECK(counts(judge_one(ray, hit_at(3, 0))) == kAmbiguous);
  CHECK(counts(judge_one(ray, hit_at(5, 1))) == kAmbiguous);
  CHECK(counts(judge_one(ray, kMiss)) == kLost);
  CHECK(counts(judge_one(ray, hit_at(9, 2))) == kLost);
  CHECK(counts(judge_one(ray, hit_at(4, 1))) == kFalse);
}

TEST_CASE("a doubtful hit that is reported must exist") {
  CHECK(counts(judge_one(ahead(0, 3), hit_at(3, 1))) == kWrong);
  CHECK(counts(judge_one(ahead(0, 3), hit_at(3, 99))) == kWrong);
  CHECK(counts(judge_one(ahead(0, 3), hit_at(2, 0))) == kFalse);
  CHECK(counts(judge_one(ahead(0, 3), hit_at(5, 1))) == kFalse);
}

TEST_CASE("a triangle beyond all doubt outside the range is not there, however near the reported t") {
  const std::vector<Triangle> walls{wall_at(ulps_away(3, -5)), wall_at(ulps_away(3, -3))};
  const std::vector<Ray> rays{ahead(3)};
  const float between = ulps_away(3, -4);
  CHECK(counts(gnomon::judge(walls, rays, std::vector<Hit>{hit_at(between, 1)}, {})) == kAmbiguous);
  CHECK(counts(gnomon::judge(walls, rays, std::vector<Hit>{hit_at(between, 0)}, {})) == kWrong);
}

TEST_CASE("a doubtful hit at tmax behind a certain one changes nothing") {
  CHECK(counts(judge_one(ahead(0, 5), hit_at(3, 0))) == kClean);
  CHECK(counts(judge_one(ahead(0, 5), hit_at(5, 1))) == kLost);
  CHECK(counts(judge_one(ahead(0, 5), kMiss)) == kLost);
}

TEST_CASE("any-hit answers alone are held against the oracle") {
  CHECK(counts(judge_any(ahead(), 1)) == kClean);
  CHECK(counts(judge_any(ahead(), 0)) == kLost);
  CHECK(counts(judge_any(ahead(10), 0)) == kClean);
  CHECK(counts(judge_any(ahead(10), 1)) == kFalse);
  for (const std::uint32_t answer : {0U, 1U}) {
    CHECK(counts(judge_any(ahead(0, 3), answer)) == kAmbiguous);
    CHECK(judge_any(ahead(0, 3), answer).range_rounded == 1 - answer);
  }
  CHECK(counts(judge_any(ahead(3), 0)) == kLost);
  CHECK(counts(judge_any(ahead(3), 1)) == kClean);
}

TEST_CASE("any-hit answers beside closest hits are held against those") {
  const std::vector<Ray> rays{ahead(), ahead(10), ahead(), ahead(), ahead(0, 3)};
  const std::vector<Hit> hits{hit_at(3, 0), kMiss, hit_at(3, 0), hit_at(3, 0), kMiss};
  const std::vector<std::uint32_t> right{1, 0, 1, 1, 0};
  CHECK(counts(gnomon::judge(kWalls, rays, hits, right)) == kAmbiguous);
  std::vector<std::uint32_t> wrong = right;
  wrong[2] = 0;
  const OracleReport report = gnomon::judge(kWalls, {rays.data(), 4}, {hits.data(), 4}, {wrong.data(), 4});
  CHECK(counts(report) == kDisagree);
  CHECK(report.mismatches() == 1);
  CHECK(report.bad_rays == std::vector<std::uint64_t>{2});
  CHECK(counts(gnomon::judge(kWalls, {rays.data(), 1}, std::vector<Hit>{kMiss},
                             std::vector<std::uint32_t>{0})) == kLost);
}

TEST_CASE("a ray that cannot be traced must miss") {
  for (const Ray& ray :
       {Ray{{kNan, 0, 0}, 0, {0, 0, 1}, kInf}, Ray{{0, 0, 0}, 0, {0, 0, 0}, kInf}, ahead(kNan)}) {
    CHECK(counts(judge_one(ray, kMiss)) == kClean);
    CHECK(counts(judge_one(ray, hit_at(3, 0))) == kFalse);
    CHECK(counts(judge_any(ray, 1)) == kFalse);
  }
}

TEST_CASE("of a device without double, t may be off by its derived bound and no more") {
  // A needle, met in its middle from the side: 1e-8 as wide as long.
  const std::vector<GnTriangle> triangles{{{-1, 0, 5}, {1, 0.1F, 9}, {0, 0.05000002F, 7}}};
  const std::vector<GnRay> rays{{{-3.0F, 0.05000001F, -6.0F}, 0.0F, {3.0F, 0.0F, 13.0F}, 1e30F}};
  const gnomon::ExactHit exact = gnomon::exact_intersect(rays[0], triangles[0]);
  REQUIRE(exact.inside);
  const double bound = gnomon::pair_error_bound(rays[0], triangles[0]);
  REQUIRE(bound > 100.0 * 0x1p-24);
  const auto faults_at = [&](double t, bool pairs) {
    gnomon::OracleOptions options;
    options.pairs_of_floats = pairs;
    const std::vector<GnHit> hits{{static_cast<float>(t), 0.25F, 0.25F, 0}};
    return gnomon::judge(triangles, rays, hits, {}, options).mismatches();
  };
  for (const double sense : {1.0, -1.0}) {
    CHECK(faults_at(exact.t + sense * 0.9 * bound, true) == 0);
    CHECK(faults_at(exact.t + sense * 0.9 * bound, false) == 1);
    CHECK(faults_at(exact.t + sense * (1.5 * bound + 1e-5), true) == 1);
  }
}
