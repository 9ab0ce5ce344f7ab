// The judge's tree against looking at every triangle: no meeting is missed, and the judge says the same of
// right and of wrong answers whichever way it looks.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "gnomon/tree/candidate_tree.h"
#include "gnomon/tree/oracle.h"
#include "support/shapes.h"

using namespace gnomon;
using namespace gnomon::test;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Random rays and rays at corners and edges, some along axes, with ranges and lengths of all kinds.
std::vector<GnRay> rays_for(const std::vector<GnTriangle>& triangles, std::uint32_t count,
                            std::uint32_t seed) {
  Random random(seed);
  std::vector<GnRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const GnTriangle& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float* a = corner(t, random.below(3));
    const float* b = corner(t, random.below(3));
    const float share = random.below(2) == 0 ? 1.0F : 0.5F;
    std::array<float, 3> target{};
    std::array<float, 3> direction{};
    float size = 1e-25F;
    for (std::size_t k = 0; k < 3; ++k) {
      target[k] = share * a[k] + (1 - share) * b[k];
      size = std::max({size, std::fabs(a[k] - b[k]), std::fabs(corner(t, 2)[k] - a[k])});
    }
    for (float& d : direction) d = size * random.between(-1.0F, 1.0F) * (random.below(4) == 0 ? 0.0F : 1.0F);
    std::array<float, 3> origin{};
    const float away = random.between(-3.0F, 3.0F);
    for (std::size_t k = 0; k < 3; ++k) origin[k] = target[k] - away * direction[k];
    GnRay r = ray(origin, direction);
    const std::uint32_t range = random.below(6);
    if (range == 0) r.tmin = -std::numeric_limits<float>::infinity();
    if (range == 1) r.tmin = r.tmax = away;
    if (range == 2) r.tmax = away;
    if (range == 3) r.tmin = std::fabs(away) * random.between(-2.0F, 1.5F);
    rays.push_back(r);
  }
  return rays;
}

// Some scaled and moved, some flat, some all alike.
std::vector<std::vector<GnTriangle>> scenes() {
  std::vector<std::vector<GnTriangle>> out;
  for (const auto& [name, triangles] : awkward_inputs()) {
    if (!triangles.empty()) out.push_back(triangles);
  }
  out.push_back(soup(3000, 21, 0.8F));
  out.push_back(soup(1000, 22, 0.5F, 1e5F));
  for (const int power : {-60, -20, 30}) {
    std::vector<GnTriangle> scaled = soup(500, 23, 2.0F);
    for (GnTriangle& t : scaled) {
      for (float* v : {t.v0, t.v1, t.v2}) {
        for (std::size_t k = 0; k < 3; ++k) v[k] = std::ldexp(v[k], power);
      }
    }
    out.push_back(scaled);
  }
  return out;
}

std::vector<std::uint64_t> all_of(const OracleReport& r) {
  return {r.rays_judged,          r.hits,           r.lost, r.false_hits, r.wrong_primitive, r.ties,
          r.any_closest_disagree, r.range_ambiguous};
}

}  // namespace

TEST_CASE("the tree offers every triangle that a ray meets in its range") {
  std::uint64_t met = 0;
  std::uint32_t seed = 31;
  for (const auto& triangles : scenes()) {
    const CandidateTree tree(triangles);
    for (const GnRay& r : rays_for(triangles, 300, ++seed)) {
      std::set<std::uint32_t> offered;
      tree.visit(r, r.tmin, r.tmax, [&](std::uint32_t i) {
        offered.insert(i);
        return kInf;
      });
      for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const ExactHit hit = exact_intersect(r, triangles[i]);
        if (!hit.inside || hit.t < r.tmin || hit.t > r.tmax || offered.contains(i)) continue;
        CAPTURE(seed, i, r.origin, r.direction, r.tmin, r.tmax, hit.t);
        FAIL("a triangle was kept from the ray");
      }
      met += offered.size();
    }
  }
  REQUIRE(met > 10000);
}

TEST_CASE("the tree drops almost all of a large scene, and stops where it is told") {
  const std::vector<GnTriangle> triangles = soup(20000, 41, 0.1F);
  const CandidateTree tree(triangles);
  std::uint64_t whole = 0;
  std::uint64_t near = 0;
  for (const GnRay& r : random_rays(200, 42)) {
    tree.visit(r, 0.0, kInf, [&](std::uint32_t) {
      ++whole;
      return kInf;
    });
    tree.visit(r, 0.0, kInf, [&](std::uint32_t) {
      ++near;
      return 1.0;
    });
  }
  REQUIRE(whole < 200 * 200);
  REQUIRE(near < whole);
}

TEST_CASE("the judge says the same with the tree and without, of right answers and of wrong ones") {
  std::uint64_t faults = 0;
  std::uint64_t ties = 0;
  std::uint64_t lost_alone = 0;  // by any hit without closest hits beside it
  std::uint32_t seed = 51;
  for (const auto& triangles : scenes()) {
    const std::vector<GnRay> rays = rays_for(triangles, 400, ++seed);
    const CandidateTree tree(triangles);
    Random random(seed);
    std::vector<GnHit> hits;
    std::vector<std::uint32_t> any;
    for (const GnRay& r : rays) {
      const OracleHit best = oracle_closest(r, triangles);
      GnHit hit{static_cast<float>(best.t), 0, 0, best.primitive};
      const std::uint32_t fault = random.below(12);
      if (fault == 0) hit = {std::numeric_limits<float>::infinity(), 0, 0, GN_NONE};
      if (fault == 1) hit.t *= 1.5F;
      if (fault == 2) hit.t *= 0.75F;
      if (fault == 3) hit.primitive = random.below(static_cast<std::uint32_t>(triangles.size()));
      hits.push_back(hit);
      any.push_back(fault == 4 ? 0U : static_cast<std::uint32_t>(best.primitive != GN_NONE));
    }
    OracleOptions options;
    options.time_budget = std::chrono::hours(1);
    const OracleReport slow = judge(triangles, rays, hits, any, options);
    options.tree = &tree;
    const OracleReport fast = judge(triangles, rays, hits, any, options);
    CAPTURE(seed);
    REQUIRE(all_of(fast) == all_of(slow));
    REQUIRE(fast.bad_rays == slow.bad_rays);
    REQUIRE(fast.max_t_error_ulp == slow.max_t_error_ulp);
    REQUIRE(fast.t_errors.steps == slow.t_errors.steps);
    lost_alone += judge(triangles, rays, {}, any, options).lost;
    faults += slow.mismatches();
    ties += slow.ties;
  }
  REQUIRE(faults > 500);
  REQUIRE(ties > 10);
  REQUIRE(lost_alone > 50);
}

TEST_CASE("no triangles and triangles that are not finite are no candidates") {
  std::vector<GnTriangle> triangles = soup(3, 61);
  triangles[1].v1[2] = std::nanf("");
  const GnRay r = ray({-5, 5, 5}, {1, 0, 0});
  CandidateTree(std::vector<GnTriangle>{}).visit(r, 0.0, kInf, [](std::uint32_t) -> double {
    FAIL("of an empty tree");
    return 0.0;
  });
  std::set<std::uint32_t> offered;
  for (const auto& t : triangles) {
    CandidateTree(triangles).visit(aimed({-9, 5, 5}, t.v0), 0.0, kInf, [&](std::uint32_t i) {
      offered.insert(i);
      return kInf;
    });
  }
  REQUIRE(offered == std::set<std::uint32_t>{0, 2});
}

TEST_CASE("quantiles of errors are the upper ends of their steps") {
  ErrorCounts counts;
  REQUIRE(counts.quantile(0.99) == 0.0);
  for (int i = 0; i < 98; ++i) counts.add(0.0);
  counts.add(0.5);
  counts.add(3.01);
  REQUIRE(counts.quantile(0.5) == 1.0 / 16);
  REQUIRE(counts.quantile(0.99) == 9.0 / 16);
  REQUIRE(counts.quantile(1.0) == 49.0 / 16);
  counts.add(8.0);
  counts.add(std::nan(""));
  REQUIRE(counts.quantile(1.0) == kInf);
}
