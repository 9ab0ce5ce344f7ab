// Rays traced in an order of their own: that order, and the same answers in the caller's.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "gnomon/cl/launch.h"
#include "gnomon/device/ray_batches.h"
#include "gnomon/shared/ray_key.h"
#include "support/flavours.h"

using namespace gnomon;
using gnomon::test::context;
using gnomon::test::Rays;

namespace {

GnBounds cube(float lo, float hi) {
  return {{lo, lo, lo}, 0.0F, {hi, hi, hi}, 0.0F};
}

std::uint32_t key_of(const GnBounds& bounds, const GnRay& ray) {
  const float scale = gn_bin_scale(0.0F, bounds.hi[0] - bounds.lo[0], GN_RAY_CELLS);
  return gn_ray_key(bounds.lo, scale, ray.origin, ray.direction);
}

// As they are handed to a tracer.
Rays sorted_on_device(const Rays& rays, const GnBounds& bounds) {
  RaySort sort(context(), bounds);
  const auto count = static_cast<std::uint32_t>(rays.size());
  const auto buffer = context().create_buffer("rays", rays.size() * sizeof(GnRay));
  context().upload_values<GnRay>(buffer, rays);
  cl::StageTimes times;
  const Launch sorted =
      sort.begin({buffer.mem.get(), nullptr, nullptr, count}, sizeof(GnHit), false, {}, times);
  REQUIRE(sorted.count == count);
  Rays got(rays.size());
  REQUIRE(clEnqueueReadBuffer(context().queue(), sorted.rays, CL_TRUE, 0, got.size() * sizeof(GnRay),
                              got.data(), 0, nullptr, nullptr) == CL_SUCCESS);
  return got;
}

TraceOptions sorting(TraceFlavour flavour, std::uint32_t step_limit = 0) {
  TraceOptions options;
  options.flavour = flavour;
  options.sort_rays = true;
  options.step_limit = step_limit;
  return options;
}

void require_equal(const std::vector<GnHit>& a, const std::vector<GnHit>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(i, a[i].primitive, b[i].primitive);
    REQUIRE(std::memcmp(&a[i], &b[i], sizeof(GnHit)) == 0);
  }
}

}  // namespace

TEST_CASE("a ray's key is its cell on the curve and its octant; origins outside the scene go to its edge") {
  const GnBounds bounds = cube(-2.0F, 6.0F);
  const auto key = [&](float x, float y, float z, float dx = 1, float dy = 1, float dz = 1) {
    return key_of(bounds, {{x, y, z}, 0, {dx, dy, dz}, 1});
  };
  const std::uint32_t last = (1U << GN_RAY_KEY_BITS) - 8;
  REQUIRE(key(-2, -2, -2) == 0);
  REQUIRE(key(5.99F, 5.99F, 5.99F) == last);
  REQUIRE(key(6, 6, 6) == last);
  REQUIRE(key(-1.76F, -2, -2) == 0);
  REQUIRE(key(-1.74F, -2, -2) == 4U << 3U);
  REQUIRE(key(-2, -1.74F, -2) == 2U << 3U);
  REQUIRE(key(-2, -2, -1.74F) == 1U << 3U);
  REQUIRE(key(-1.24F, -2, -2) == (4U | 32U) << 3U);
  REQUIRE(key(-1e30F, -INFINITY, -7) == 0);
  REQUIRE(key(1e30F, INFINITY, 7) == last);
  REQUIRE(key(NAN, NAN, NAN) == 0);
  REQUIRE(key(-2, -2, -2, -1, 1, 0) == 4);
  REQUIRE(key(-2, -2, -2, 1, -1, NAN) == 2);
  REQUIRE(key(6, 6, 6, -0.0F, 1, -1e-40F) == last + 1);
}

TEST_CASE("rays go to the tracer by their keys, those of a key in the batch's order", "[portable]") {
  const GnBounds bounds = cube(0.0F, 10.0F);
  for (const std::uint32_t count : {1U, 2U, 1000U, 70'000U}) {
    if (count > 1000 && context().device().loop_limit != 0) continue;
    CAPTURE(count);
    Rays rays = test::random_rays(count, 31);
    // Many of the same cell; tmin numbers them.
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i % 3 == 0) std::copy_n(rays[0].origin, 3, rays[i].origin);
      rays[i].tmin = static_cast<float>(i);
    }
    if (count == 1000) rays[7].origin[0] = NAN;
    Rays expected = rays;
    std::stable_sort(expected.begin(), expected.end(),
                     [&](const GnRay& a, const GnRay& b) { return key_of(bounds, a) < key_of(bounds, b); });
    const Rays got = sorted_on_device(rays, bounds);
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i, got[i].tmin, expected[i].tmin);
      REQUIRE(std::memcmp(&got[i], &expected[i], sizeof(GnRay)) == 0);
    }
  }
}

TEST_CASE("sorted rays get the answers they get unsorted, in their places, however they are traced",
          "[portable][memcheck]") {
  const auto triangles = test::soup(150, 41);
  const auto tree = build_device(context(), triangles);
  Rays rays = test::random_rays(203, 42);
  rays[5].direction[0] = NAN;
  rays[9].origin[1] = INFINITY;
  const auto plain = test::trace(tree, rays, TraceFlavour::kThread);
  REQUIRE(plain.closest.invalid_rays == 2);
  for (const TraceFlavour flavour : {TraceFlavour::kAuto, TraceFlavour::kThread}) {
    CAPTURE(to_string(flavour));
    const Tracer tracer(context(), tree, sorting(flavour));
    const auto closest = tracer.closest(rays);
    require_equal(closest.hits, plain.closest.hits);
    REQUIRE(closest.invalid_rays == 2);
    REQUIRE(tracer.any(rays).occluded == plain.any.occluded);
  }
}

TEST_CASE("sorting works in passes and from the caller's buffers") {
  const auto triangles = test::soup(700, 43);
  const auto tree = build_device(context(), triangles);
  const Rays rays = test::random_rays(3000, 44);
  const auto plain = test::trace(tree, rays, TraceFlavour::kThread);
  const Tracer stepper(context(), tree, sorting(TraceFlavour::kThread, 20));
  require_equal(stepper.closest(rays).hits, plain.closest.hits);

  const Tracer tracer(context(), tree, sorting(TraceFlavour::kAuto));
  REQUIRE(tracer.closest({}).hits.empty());
  const auto ray_buffer = context().create_buffer("rays", rays.size() * sizeof(GnRay));
  const auto answers = context().create_buffer("answers", rays.size() * sizeof(GnHit));
  context().upload_values<GnRay>(ray_buffer, rays);
  // Another number each time: what is kept between batches must do for the larger one.
  for (const std::uint32_t count : {0U, 100U, 3000U, 50U}) {
    CAPTURE(count);
    cl::wait(tracer.enqueue_closest(ray_buffer.mem.get(), answers.mem.get(), count));
    auto expected = plain.closest.hits;
    expected.resize(count);
    require_equal(context().download_values<GnHit>(answers, count), expected);
    cl::wait(tracer.enqueue_any(ray_buffer.mem.get(), answers.mem.get(), count));
    auto occluded = plain.any.occluded;
    occluded.resize(count);
    REQUIRE(context().download_values<std::uint32_t>(answers, count) == occluded);
  }
}

TEST_CASE("sorting works on wide trees, and each ray's counters are its own", "[unlimited]") {
  const auto triangles = test::soup(700, 43);
  const auto tree = build_device(context(), triangles);
  const Rays rays = test::random_rays(3000, 44);
  const auto plain = test::trace(tree, rays, TraceFlavour::kWide, false, true);
  TraceOptions counting = sorting(TraceFlavour::kWide);
  counting.counters = true;
  const auto wide = collapse_device(context(), tree);
  const auto counted = Tracer(context(), wide, counting).closest(rays);
  require_equal(counted.hits, plain.closest.hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(counted.counters[i].boxes == plain.closest.counters[i].boxes);
    REQUIRE(counted.counters[i].triangles == plain.closest.counters[i].triangles);
  }
}

TEST_CASE("sorting in a scene without triangles is no matter") {
  const auto tree = build_device(context(), std::vector<GnTriangle>{});
  const Rays rays = test::random_rays(20, 45);
  for (const GnHit& hit : Tracer(context(), tree, sorting(TraceFlavour::kAuto)).closest(rays).hits)
    REQUIRE(hit.primitive == GN_NONE);
}
