// The device tracer against the reference traversal and the oracle.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/trace_reference.h"
#include "support/device.h"
#include "support/shapes.h"

using gnomon::test::context;
using gnomon::test::ray;

namespace {

struct Traced {
  gnomon::TraceResult closest;
  gnomon::TraceResult any;
};

Traced trace(const std::vector<GnTriangle>& triangles, const std::vector<GnRay>& rays, bool counters = false,
             gnomon::TraceFlavour flavour = gnomon::TraceFlavour::kAuto) {
  const auto tree = gnomon::build_device(context(), triangles);
  gnomon::TraceOptions options;
  options.flavour = flavour;
  options.counters = counters;
  const gnomon::Tracer tracer(context(), tree, options);
  return {tracer.closest(rays), tracer.any(rays)};
}

gnomon::OracleReport judge(const std::vector<GnTriangle>& triangles, const std::vector<GnRay>& rays,
                           const Traced& traced) {
  gnomon::OracleOptions options;
  options.max_rays = rays.size();
  return gnomon::judge(triangles, rays, traced.closest.hits, traced.any.occluded, options);
}

// Lost hits, false hits, wrong triangles: none, on every device. Pairs of floats may call a ray that misses a
// corner by 2^-40 a hit, so without fp64 only losses are counted for rays aimed at corners.
void require_faultless(const std::vector<GnTriangle>& triangles, const std::vector<GnRay>& rays, bool aimed) {
  const gnomon::OracleReport report = judge(triangles, rays, trace(triangles, rays));
  REQUIRE(report.rays_judged == rays.size());
  REQUIRE(report.lost == 0);
  REQUIRE(report.any_closest_disagree == 0);
  if (context().device().fp64 || !aimed) {
    REQUIRE(report.mismatches() == 0);
    REQUIRE(report.max_t_error_ulp <= 1.0);
  }
}

}  // namespace

TEST_CASE("random rays through a soup are judged faultless", "[portable]") {
  require_faultless(gnomon::test::soup(600, 61), gnomon::test::random_rays(400, 62), false);
}

TEST_CASE("rays aimed at corners and edges of a soup far from the origin lose nothing", "[portable]") {
  for (const float offset : {0.0F, 1.0e3F, 1.0e5F}) {
    CAPTURE(offset);
    const auto triangles = gnomon::test::soup(300, 63, 0.5F, offset);
    gnomon::test::Random random(64);
    std::vector<GnRay> rays;
    for (std::uint32_t i = 0; i < 600; ++i) {
      const auto& t = triangles[random.below(300)];
      const float* a = gnomon::test::corner(t, random.below(3));
      const float* b = gnomon::test::corner(t, random.below(3));
      const float target[3] = {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
      rays.push_back(gnomon::test::aimed(
          {offset + random.between(-5, 15), offset + random.between(-5, 15), offset - 3}, target));
    }
    require_faultless(triangles, rays, true);
  }
}

TEST_CASE("axis-parallel rays through lattice points of a flat grid always hit", "[portable]") {
  const auto triangles = gnomon::test::grid(8, 2.0F);
  std::vector<GnRay> rays;
  for (int i = 0; i <= 16; ++i) {
    for (int j = 0; j <= 16; ++j) {
      const float x = 0.5F * static_cast<float>(i);
      const float z = 0.5F * static_cast<float>(j);
      for (const float zero : {0.0F, -0.0F}) rays.push_back(ray({x, 7, z}, {zero, -1, zero}));
    }
  }
  const Traced traced = trace(triangles, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(traced.closest.hits[i].t == 5.0F);
    REQUIRE(traced.any.occluded[i] == 1);
  }
}

// Few: the simulator that watches every access takes its time.
TEST_CASE("a few rays, some along axes through lattice points, keep to their buffers", "[memcheck]") {
  std::vector<GnRay> rays = gnomon::test::random_rays(30, 66);
  for (int i = 0; i <= 8; ++i) {
    for (const float zero : {0.0F, -0.0F})
      rays.push_back(ray({0.5F * static_cast<float>(i), 7, 1}, {zero, -1, zero}));
  }
  auto triangles = gnomon::test::grid(4, 2.0F);
  const auto more = gnomon::test::soup(60, 65);
  triangles.insert(triangles.end(), more.begin(), more.end());
  require_faultless(triangles, rays, true);
}

TEST_CASE("rays inside the plane of a flat grid miss it and end") {
  const auto triangles = gnomon::test::grid(8, 2.0F);
  const Traced traced = trace(triangles, {ray({-1, 2, 3}, {1, 0, 0}), ray({-1, 2, 3.5F}, {1, -0.0F, 0.25F})});
  for (const GnHit& hit : traced.closest.hits) REQUIRE(hit.primitive == GN_NONE);
}

TEST_CASE("tmin and tmax are inclusive and honoured", "[portable]") {
  const auto triangles = gnomon::test::grid(2, 0.0F);
  const float at = 3.0F;
  const auto below = std::nextafter(at, 0.0F);
  const auto above = std::nextafter(at, 9.0F);
  const auto one = [&](float tmin, float tmax) {
    const Traced traced = trace(triangles, {ray({0.7F, at, 0.4F}, {0, -1, 0}, tmin, tmax)});
    REQUIRE((traced.closest.hits[0].primitive != GN_NONE) == (traced.any.occluded[0] == 1));
    return traced.any.occluded[0] == 1;
  };
  REQUIRE(one(0.0F, INFINITY));
  REQUIRE(one(at, at));
  REQUIRE(one(0.0F, at));
  REQUIRE(one(at, INFINITY));
  REQUIRE_FALSE(one(0.0F, below));
  REQUIRE_FALSE(one(above, INFINITY));
  REQUIRE_FALSE(one(INFINITY, INFINITY));
  REQUIRE_FALSE(one(5.0F, 1.0F));
  REQUIRE_FALSE(one(0.0F, -1.0F));
}

TEST_CASE("a ray that starts on a surface meets it at t = 0, unless tmin says otherwise") {
  const auto triangles = gnomon::test::grid(2, 0.0F);
  const Traced traced =
      trace(triangles, {ray({0.7F, 0, 0.4F}, {0, 1, 0}), ray({0.7F, 0, 0.4F}, {0, 1, 0}, 1e-6F),
                        ray({1, 0, 1}, {0.3F, -1, 0.2F})});
  REQUIRE(traced.closest.hits[0].t == 0.0F);
  REQUIRE(traced.closest.hits[1].primitive == GN_NONE);
  REQUIRE(traced.closest.hits[2].t == 0.0F);
}

TEST_CASE("of equally near triangles the one with the lowest number is reported") {
  auto triangles = gnomon::test::soup(200, 65, 0.2F);
  const GnTriangle twin = gnomon::test::triangle({-5, -5, 20}, {25, -5, 20}, {5, 30, 20});
  for (const std::size_t place : {150U, 30U, 90U}) triangles[place] = twin;
  const Traced traced = trace(triangles, {ray({5, 5, 30}, {0, 0, -1}, 0, 11)});
  REQUIRE(traced.closest.hits[0].primitive == 30);
}

TEST_CASE("rays that are not traceable miss and are counted", "[portable][memcheck]") {
  const float nan = std::nanf("");
  std::vector<GnRay> rays = gnomon::test::random_rays(20, 66);
  rays.push_back(ray({nan, 0, 0}, {0, 0, 1}));
  rays.push_back(ray({0, 0, 0}, {0, nan, 0}));
  rays.push_back(ray({0, 0, INFINITY}, {0, 0, 1}));
  rays.push_back(ray({0, 0, 0}, {0, 0, 0}));
  rays.push_back(ray({0, 0, 0}, {0, 0, 1}, nan));
  rays.push_back(ray({5, 5, 0}, {0, 0, 2e-39F}));
  rays.push_back(ray({5, 5, 0}, {1e-38F, 0, 7e-31F}));
  rays.push_back(ray({5, 5, 0}, {0, 2e38F, 2e38F}));
  const Traced traced = trace(gnomon::test::soup(100, 67, 5.0F), rays);
  REQUIRE(traced.closest.invalid_rays == 8);
  REQUIRE(traced.any.invalid_rays == 8);
  for (std::size_t i = 20; i < rays.size(); ++i) {
    REQUIRE(traced.closest.hits[i].primitive == GN_NONE);
    REQUIRE(traced.closest.hits[i].t == INFINITY);
    REQUIRE(traced.any.occluded[i] == 0);
  }
}

TEST_CASE("directions from the shortest to the longest hit what unit ones do", "[portable]") {
  const auto triangles = gnomon::test::soup(300, 75, 2.0F);
  const std::vector<GnRay> units = gnomon::test::random_rays(200, 76);
  const Traced expected = trace(triangles, units);
  for (const int power : {-99, -60, -1, 50, 100}) {
    std::vector<GnRay> rays = units;
    for (GnRay& r : rays) {
      for (float& x : r.direction) x = std::ldexp(x, power);
    }
    const Traced traced = trace(triangles, rays);
    CAPTURE(power);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i, units[i].direction);
      const float* d = rays[i].direction;
      if (std::max({std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])}) < 0x1p-100F) continue;
      REQUIRE(traced.closest.hits[i].primitive == expected.closest.hits[i].primitive);
      REQUIRE(traced.closest.hits[i].t == std::ldexp(expected.closest.hits[i].t, -power));
      REQUIRE(traced.any.occluded[i] == expected.any.occluded[i]);
    }
  }
}

TEST_CASE("a hit beyond the largest float is none", "[portable]") {
  const Traced traced = trace(gnomon::test::grid(2, 0x1p30F),
                              {ray({0.7F, 0, 0.4F}, {0, 0x1p-97F, 0}), ray({0.7F, 0, 0.4F}, {0, 0x1p-98F, 0}),
                               ray({0.7F, 0, 0.4F}, {0, -0x1p-97F, 0}, -INFINITY),
                               ray({0.7F, 0, 0.4F}, {0, -0x1p-98F, 0}, -INFINITY)});
  REQUIRE(traced.closest.hits[0].t == 0x1p127F);
  REQUIRE(traced.any.occluded[0] == 1);
  REQUIRE(traced.closest.hits[2].t == -0x1p127F);
  REQUIRE(traced.any.occluded[2] == 1);
  for (const std::size_t beyond : {1U, 3U}) {
    REQUIRE(traced.closest.hits[beyond].primitive == GN_NONE);
    REQUIRE(traced.any.occluded[beyond] == 0);
  }
}

TEST_CASE("an empty scene is missed by every ray, and no rays give no answers", "[portable]") {
  const Traced traced = trace({}, gnomon::test::random_rays(50, 68));
  for (const GnHit& hit : traced.closest.hits) REQUIRE(hit.primitive == GN_NONE);
  const Traced none = trace(gnomon::test::soup(10, 69), {});
  REQUIRE(none.closest.hits.empty());
  REQUIRE(none.any.occluded.empty());
}

TEST_CASE("every awkward input is traced faultlessly", "[serial][portable]") {
  for (const auto& [name, triangles] : gnomon::test::awkward_inputs()) {
    if (triangles.empty()) continue;
    CAPTURE(name);
    gnomon::test::Random random(70);
    std::vector<GnRay> rays;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
      const float* a = t.v0;
      const float size = std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2]), 1.0F}) * 0.01F + 5.0F;
      const float target[3] = {(t.v0[0] + t.v1[0] + t.v2[0]) / 3, (t.v0[1] + t.v1[1] + t.v2[1]) / 3,
                               (t.v0[2] + t.v1[2] + t.v2[2]) / 3};
      rays.push_back(
          gnomon::test::aimed({a[0] + random.between(-size, size), a[1] + random.between(-size, size),
                               a[2] + random.between(-size, size)},
                              target));
    }
    require_faultless(triangles, rays, true);
  }
}

TEST_CASE("hits and work counters equal the reference traversal's, bit for bit, where double is at hand") {
  const auto triangles = gnomon::test::soup(5000, 71);
  const auto rays = gnomon::test::random_rays(3000, 72);
  const auto bvh = gnomon::build_reference(triangles);
  const Traced traced = trace(triangles, rays, true, gnomon::TraceFlavour::kThread);
  const auto closest = gnomon::trace_reference(bvh, triangles, rays, false);
  const auto any = gnomon::trace_reference(bvh, triangles, rays, true);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(traced.closest.hits[i].primitive == closest.hits[i].primitive);
    REQUIRE((traced.any.occluded[i] == 1) == (any.hits[i].primitive != GN_NONE));
    differing += std::memcmp(&traced.closest.hits[i], &closest.hits[i], sizeof(GnHit)) != 0 ? 1 : 0;
    // Divisions may be rounded otherwise on a GPU, which moves a box entry by an ulp: visits are exact on
    // CPUs.
    if (context().device().is_cpu) {
      REQUIRE(traced.closest.counters[i].boxes == closest.counters[i].boxes);
      REQUIRE(traced.closest.counters[i].triangles == closest.counters[i].triangles);
      REQUIRE(traced.any.counters[i].boxes == any.counters[i].boxes);
    }
  }
  if (context().device().fp64) REQUIRE(differing == 0);
}

TEST_CASE("counting work changes no answer") {
  const auto triangles = gnomon::test::soup(800, 73);
  const auto rays = gnomon::test::random_rays(500, 74);
  const Traced plain = trace(triangles, rays, false);
  const Traced counted = trace(triangles, rays, true);
  REQUIRE(std::memcmp(plain.closest.hits.data(), counted.closest.hits.data(), rays.size() * sizeof(GnHit)) ==
          0);
  REQUIRE(plain.any.occluded == counted.any.occluded);
  REQUIRE(plain.closest.counters.empty());
}

TEST_CASE("a deep tree gets a stack as deep") {
  std::vector<GnTriangle> triangles;
  for (const auto& [name, shapes] : gnomon::test::awkward_inputs()) {
    if (name == "doubling distances") triangles = shapes;
  }
  gnomon::BuildOptions options;
  options.max_leaf_size = 1;
  options.bins = 2;
  const auto tree = gnomon::build_device(context(), triangles, options);
  REQUIRE(tree.max_depth > 32);
  const gnomon::Tracer tracer(context(), tree, {});
  std::vector<GnRay> rays;
  for (const GnTriangle& t : triangles) {
    const float x = t.v0[0];
    rays.push_back(ray({x * 1.3F, x * 0.1F, x}, {0, 0, -1}));
  }
  const auto result = tracer.closest(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(result.hits[i].primitive == i);
  }
}
