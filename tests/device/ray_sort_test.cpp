// Rays traced in an order of their own: that order, and the same answers in the caller's.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <map>

#include "gnomon/cl/launch.h"
#include "gnomon/device/ray_batches.h"
#include "gnomon/shared/light_key.h"
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

std::uint32_t light_key_of(const std::vector<RayLight>& lights, const GnBounds& bounds, const GnRay& ray) {
  std::vector<GnRayLight> packed;
  for (const auto& [sun, place] : lights) packed.push_back({{place[0], place[1], place[2]}, sun ? 1U : 0U});
  const float scale = gn_bin_scale(0.0F, bounds.hi[0] - bounds.lo[0], GN_PLACE_CELLS);
  const auto count = static_cast<std::uint32_t>(packed.size());
  return gn_light_keys(packed.data(), count, bounds.lo, scale, ray.origin, ray.direction);
}

const std::vector<RayLight> kLights{
    {false, {3.0F, 9.0F, 4.0F}}, {true, {-0.4F, -0.8F, -0.45F}}, {false, {-2.0F, 5.0F, 5.0F}}};

// From random places to these lights, the sun's from both ends, and some to none of them; in no order.
Rays shadow_rays_in_no_order(std::uint32_t count, std::uint32_t seed) {
  Rays rays = test::random_rays(count, seed);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % 4 == 3) continue;
    const auto& [sun, place] = kLights[i % 4];
    for (std::size_t k = 0; k < 3; ++k)
      rays[i].direction[k] = sun ? (i % 8 == 1 ? 2.0F : -1.0F) * place[k] : place[k] - rays[i].origin[k];
    rays[i].tmax = sun ? INFINITY : 0.9999F;
  }
  return rays;
}

TraceOptions lit(TraceFlavour flavour) {
  TraceOptions options;
  options.flavour = flavour;
  options.lights = kLights;
  return options;
}

// As they are handed to a tracer.
Rays sorted_on_device(const Rays& rays, const GnBounds& bounds, const std::vector<RayLight>& lights = {}) {
  RaySort sort(context(), bounds, lights);
  const auto count = static_cast<std::uint32_t>(rays.size());
  const auto buffer = context().create_buffer("rays", rays.size() * sizeof(GnRay));
  context().upload_values<GnRay>(buffer, rays);
  cl::StageTimes times;
  const Launch sorted = sort.begin({buffer.mem.get(), nullptr, nullptr, count},
                                   lights.empty() ? sizeof(GnHit) : 4, false, {}, times);
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

TEST_CASE("a caller who asks for times gets those of sorting, too") {
  const auto tree = build_device(context(), test::soup(300, 46));
  const Rays rays = test::random_rays(2000, 47);
  const auto count = static_cast<std::uint32_t>(rays.size());
  const cl::Buffer ray_buffer = context().create_buffer("rays", rays.size() * sizeof(GnRay));
  const cl::Buffer answers = context().create_buffer("answers", rays.size() * sizeof(GnHit));
  context().upload_values<GnRay>(ray_buffer, rays);
  const auto stages = [&](const TraceOptions& options) {
    const Tracer tracer(context(), tree, options);
    cl::StageTimes times;
    cl::wait(tracer.enqueue_closest(ray_buffer.mem.get(), answers.mem.get(), count, {}, &times));
    std::map<std::string, double> out;
    for (const auto& [stage, ms] : times.milliseconds()) out[stage] = ms;
    return out;
  };
  const auto plain = stages({});
  REQUIRE(plain.size() == 1);
  REQUIRE(plain.at("trace") > 0.0);
  const auto sorted = stages(sorting(TraceFlavour::kAuto));
  REQUIRE(sorted.at("trace") > 0.0);
  REQUIRE(sorted.at("sort rays") > 0.0);
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

TEST_CASE("by lights a ray's key is its light and its place among that light's rays") {
  const GnBounds bounds = cube(0.0F, 128.0F);
  const std::vector<RayLight> lights{{true, {0, -1, 0}}, {false, {10, 20, 30}}};
  const auto key = [&](float x, float y, float z, float dx, float dy, float dz) {
    return light_key_of(lights, bounds, {{x, y, z}, 0, {dx, dy, dz}, 1});
  };
  // Along the sun's way, either way: the origin's cell.
  REQUIRE(key(0, 0, 0, 0, 3, 0) == 0);
  REQUIRE(key(0, 0, 0, 0, -1, 0) == 0);
  REQUIRE(key(1.5F, 0, 0, 0, 1, 0) == 4);
  REQUIRE(key(0, 1.5F, 0, 0, 1, 0) == 2);
  REQUIRE(key(0, 0, 2.5F, 0, 1, 0) == 8);
  REQUIRE(key(500, 127.5F, 1e30F, 0, 1, 0) == (1U << 21U) - 1);
  // Through the point: largest axis, octant, cell of what the others are to it.
  const std::uint32_t point = 1U << GN_LIGHT_PLACE_BITS;
  REQUIRE(key(0, 20, 30, 1, 0, 0) == point);
  REQUIRE(key(20, 20, 30, -1, 0, 0) == (point | 4U << 16U));
  REQUIRE(key(8, 0, 30, 0.5F, 5, 0) == (point | 1U << 19U | 321U));           // the 25th of 256
  REQUIRE(key(9.4F, 20, 20, 0.15F, 0, 2.5F) == (point | 2U << 19U | 0xaaU));  // the 15th
  REQUIRE(key(0, 10, 20, 1, 1, 1) == (point | 0xffffU));
  // Of two lights that it goes with, the first's.
  const std::vector<RayLight> twice{{false, {0, 0, 5}}, {false, {0, 0, 5}}, {true, {0, 0, 1}}};
  REQUIRE(light_key_of(twice, bounds, {{0, 0, 1}, 0, {0, 0, 1}, 1}) == 2U << 19U);
  // Of neither, however near: by origins, after all lights.
  const std::uint32_t none = GN_MOST_RAY_LIGHTS << GN_LIGHT_PLACE_BITS;
  REQUIRE(key(0, 0, 0, 0.01F, 1, 0) == none);
  REQUIRE(key(1.5F, 20, 30, 1, 0.01F, 0) ==
          (none | light_key_of({{true, {1, 0, 0}}}, bounds, {{1.5F, 20, 30}, 0, {1, 0, 0}, 1})));
  REQUIRE(key(NAN, 0, 0, NAN, 1, 0) == none);
  REQUIRE(key(NAN, NAN, NAN, 0, 1, 0) == 0);
}

TEST_CASE("rays go to the tracer light by light, those of a key in the batch's order", "[portable]") {
  const GnBounds bounds = cube(0.0F, 10.0F);
  for (const std::uint32_t count : {1U, 2U, 1003U, 70'001U}) {
    if (count > 2000 && context().device().loop_limit != 0) continue;
    CAPTURE(count);
    Rays rays = shadow_rays_in_no_order(count, 51);
    for (std::uint32_t i = 0; i < count; ++i) rays[i].tmin = static_cast<float>(i);
    if (count > 1000) rays[7].origin[0] = rays[9].direction[1] = NAN;
    Rays expected = rays;
    std::stable_sort(expected.begin(), expected.end(), [&](const GnRay& a, const GnRay& b) {
      return light_key_of(kLights, bounds, a) < light_key_of(kLights, bounds, b);
    });
    const Rays got = sorted_on_device(rays, bounds, kLights);
    std::array<int, GN_MOST_RAY_LIGHTS + 1> rays_of_light{};
    for (std::size_t i = 0; i < got.size(); ++i) {
      CAPTURE(i, got[i].tmin, expected[i].tmin);
      REQUIRE(std::memcmp(&got[i], &expected[i], sizeof(GnRay)) == 0);
      ++rays_of_light[light_key_of(kLights, bounds, got[i]) >> GN_LIGHT_PLACE_BITS];
    }
    if (count < 1000) continue;
    for (const std::size_t light : {0U, 1U, 2U, GN_MOST_RAY_LIGHTS})
      REQUIRE(rays_of_light[light] > static_cast<int>(count / 4) - 10);
  }
}

TEST_CASE("rays sorted by lights get the answers they get unsorted, in their places, however they are traced",
          "[portable][memcheck]") {
  const auto triangles = test::soup(150, 41);
  const auto tree = build_device(context(), triangles);
  Rays rays = shadow_rays_in_no_order(203, 52);
  rays[5].direction[0] = NAN;
  rays[9].origin[1] = INFINITY;
  const auto plain = test::trace(tree, rays, TraceFlavour::kThread);
  for (const TraceFlavour flavour : {TraceFlavour::kAuto, TraceFlavour::kThread}) {
    CAPTURE(to_string(flavour));
    const Tracer tracer(context(), tree, lit(flavour));
    const auto any = tracer.any(rays);
    REQUIRE(any.occluded == plain.any.occluded);
    REQUIRE(any.invalid_rays == 2);
    require_equal(tracer.closest(rays).hits, plain.closest.hits);
  }
}

TEST_CASE("rays that make no packets in the batch's order make them light by light", "[unlimited]") {
  const auto tree = build_device(context(), test::soup(700, 53));
  Rays rays = shadow_rays_in_no_order(40'000, 54);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].tmin = 0.0F;
    for (float& x : rays[i].direction) x = i % 8 == 1 ? -x : x;  // all towards the sun
  }
  const auto work = [&](TraceFlavour flavour, const std::vector<RayLight>& lights) {
    TraceOptions counting;
    counting.flavour = flavour;
    counting.lights = lights;
    counting.counters = true;
    return Tracer(context(), tree, counting).any(rays).counters;
  };
  // Rays that no packet takes do what they do in the wide flavour.
  const auto singly = work(TraceFlavour::kWide, {});
  const auto in_packets = [&](const std::vector<RayLight>& lights) {
    const auto counters = work(TraceFlavour::kPacket, lights);
    std::size_t rays_of_packets = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (i % 4 != 3 && counters[i].boxes != singly[i].boxes) ++rays_of_packets;
    }
    return rays_of_packets;
  };
  REQUIRE(in_packets({}) == 0);
  REQUIRE(in_packets(kLights) > rays.size() * 3 / 8);  // of three quarters that go to lights
}

TEST_CASE("rays are sorted by up to 31 lights, or refused") {
  const auto tree = build_device(context(), test::soup(20, 55));
  TraceOptions options;
  options.lights.resize(GN_MOST_RAY_LIGHTS);
  const Rays rays = test::random_rays(20, 56);
  REQUIRE(Tracer(context(), tree, options).any(rays).occluded == Tracer(context(), tree).any(rays).occluded);
  options.lights.emplace_back();
  REQUIRE_THROWS_WITH((Tracer(context(), tree, options)), Catch::Contains("up to 31 lights, not by 32"));
}
