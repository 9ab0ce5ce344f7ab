// The judge at work on whole batches: perfect results, threads, sampling, budget, progress and refusals.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <random>
#include <string_view>

#include "judge_cases.h"

using gnomon::Hit;
using gnomon::OracleOptions;
using gnomon::OracleReport;
using gnomon::Ray;
using gnomon::Triangle;
using namespace judge_cases;

namespace {

// Random triangles and rays with the answers a perfect device would give.
struct Perfect {
  std::vector<Triangle> triangles;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<std::uint32_t> any;

  Perfect(std::size_t triangle_count, std::size_t ray_count, float size) {
    std::mt19937_64 engine(21);
    const auto unit = [&] { return static_cast<float>(engine() >> 40) * 0x1p-23F - 1.0F; };
    for (std::size_t i = 0; i < triangle_count; ++i) {
      const float at[3] = {unit(), unit(), unit()};
      Triangle triangle{};
      for (float* corner : {triangle.v0, triangle.v1, triangle.v2}) {
        for (int axis = 0; axis < 3; ++axis) corner[axis] = at[axis] + size * unit();
      }
      triangles.push_back(triangle);
    }
    for (std::size_t i = 0; i < ray_count; ++i) {
      rays.push_back({{unit(), unit(), unit()}, 0.0F, {unit(), unit(), unit()}, i % 3 == 0 ? 0.5F : kInf});
      const gnomon::OracleHit closest = gnomon::oracle_closest(rays[i], triangles);
      any.push_back(closest.primitive != GN_NONE ? 1 : 0);
      hits.push_back(kMiss);
      if (any[i] == 0) continue;
      const gnomon::ExactHit exact = gnomon::exact_intersect(rays[i], triangles[closest.primitive]);
      hits[i] = {static_cast<float>(exact.t), static_cast<float>(exact.u), static_cast<float>(exact.v),
                 closest.primitive};
    }
  }
};

}  // namespace

TEST_CASE("a perfect result has no mismatches and errors of half an ulp") {
  const Perfect p(900, 700, 0.3F);
  const OracleReport report = gnomon::judge(p.triangles, p.rays, p.hits, p.any);
  CHECK(report.mismatches() == 0);
  CHECK(counts(report) == kClean);
  CHECK(report.bad_rays.empty());
  CHECK(report.rays_given == 700);
  CHECK(report.rays_judged == 700);
  CHECK_FALSE(report.budget_exhausted);
  CHECK(report.hits == static_cast<std::uint64_t>(std::count(p.any.begin(), p.any.end(), 1U)));
  CHECK(report.hits > 300);
  CHECK(report.hits < 700);
  CHECK(report.max_t_error_ulp > 0.3);
  CHECK(report.max_t_error_ulp <= 0.5 + 1e-6);
  CHECK(report.max_uv_error > 0.0);
  CHECK(report.max_uv_error < 1e-7);
}

TEST_CASE("the report does not depend on the number of threads") {
  Perfect p(200, 500, 0.3F);
  for (std::size_t i = 0; i < 500; i += 7) p.hits[i].t += 0.25F;
  for (std::size_t i = 3; i < 500; i += 11) p.any[i] ^= 1U;
  OracleOptions options;
  options.threads = 1;
  const OracleReport one = gnomon::judge(p.triangles, p.rays, p.hits, p.any, options);
  CHECK(one.mismatches() > 20);
  CHECK(one.bad_rays.size() == 16);
  for (const unsigned threads : {0U, 2U, 7U, 1000U}) {
    options.threads = threads;
    const OracleReport many = gnomon::judge(p.triangles, p.rays, p.hits, p.any, options);
    CHECK(counts(many) == counts(one));
    CHECK(many.hits == one.hits);
    CHECK(many.bad_rays == one.bad_rays);
    CHECK(many.max_t_error_ulp == one.max_t_error_ulp);
    CHECK(many.max_uv_error == one.max_uv_error);
  }
}

TEST_CASE("the sample is strided evenly over the batch and bad rays are named by their index") {
  const std::vector<Ray> rays(1000, ahead());
  std::vector<Hit> hits(1000, hit_at(3, 0));
  for (const std::size_t bad : {900U, 100U, 500U, 501U}) hits[bad] = kMiss;
  OracleOptions options;
  options.max_rays = 10;
  const OracleReport report = gnomon::judge(kWalls, rays, hits, {}, options);
  CHECK(report.rays_given == 1000);
  CHECK(report.rays_judged == 10);
  CHECK(report.lost == 3);
  CHECK(report.bad_rays == std::vector<std::uint64_t>{100, 500, 900});
  CHECK_FALSE(report.budget_exhausted);
  options.max_rays = 0;
  CHECK(gnomon::judge(kWalls, rays, hits, {}, options).rays_judged == 0);
}

TEST_CASE("the time budget ends the judging with what is judged") {
  const std::vector<Triangle> many(20000, wall_at(3));
  const std::vector<Ray> rays(100000, ahead());
  const std::vector<Hit> hits(100000, hit_at(3, 0));
  OracleOptions options;
  options.max_rays = 100000;
  options.time_budget = std::chrono::milliseconds(150);
  const auto start = std::chrono::steady_clock::now();
  const OracleReport report = gnomon::judge(many, rays, hits, {}, options);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  CHECK(report.budget_exhausted);
  CHECK(report.rays_judged > 0);
  CHECK(report.rays_judged < 100000);
  CHECK(report.hits == report.rays_judged);
  options.time_budget = std::chrono::milliseconds(0);
  CHECK(gnomon::judge(many, rays, hits, {}, options).rays_judged == 0);
  options.time_budget = std::chrono::milliseconds::max();
  options.max_rays = 5;
  CHECK(gnomon::judge(many, rays, hits, {}, options).rays_judged == 5);
}

TEST_CASE("progress rises to one") {
  const std::vector<Ray> rays(2000, ahead());
  const std::vector<Hit> hits(2000, hit_at(3, 0));
  std::vector<double> shares;
  const auto watch = [&](std::string_view stage, double done) {
    CHECK(stage == "oracle");
    shares.push_back(done);
    return true;
  };
  CHECK(gnomon::judge(kWalls, rays, hits, {}, {}, watch).rays_judged == 2000);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == 1.0);
  shares.clear();
  CHECK(gnomon::judge(kWalls, {}, {}, {}, {}, watch).rays_judged == 0);
  CHECK(shares == std::vector<double>{1.0});
}

TEST_CASE("cancelling stops all threads soon, with an error") {
  const std::vector<Triangle> many(200000, {{50, 0, 3}, {51, 0, 3}, {50, 1, 3}});
  const std::vector<Ray> rays(1000000, ahead());
  OracleOptions options;
  options.max_rays = rays.size();
  options.threads = 3;
  int calls = 0;
  const auto cancel = [&](std::string_view, double) { return ++calls < 2; };
  const auto start = std::chrono::steady_clock::now();
  try {
    (void)gnomon::judge(many, rays, {}, {}, options, cancel);
    FAIL("not cancelled");
  } catch (const gnomon::Error& error) {
    CHECK(error.code() == gnomon::ErrorCode::kCancelled);
  }
  CHECK(calls == 2);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));  // the budget is 20 s
}

TEST_CASE("unequal lengths are refused with both numbers") {
  const std::vector<Ray> rays(3, ahead());
  const std::vector<Hit> two(2, kMiss);
  CHECK_THROWS_WITH(gnomon::judge(kWalls, rays, two, {}), Catch::Contains("2 closest hits for 3 rays"));
  const std::vector<std::uint32_t> four(4, 0U);
  CHECK_THROWS_WITH(gnomon::judge(kWalls, rays, {}, four), Catch::Contains("4 any-hit answers for 3 rays"));
  CHECK(gnomon::judge(kWalls, {}, {}, {}).rays_judged == 0);
  CHECK(gnomon::judge(kWalls, rays, {}, {}).hits == 3);
}
