// Packets: rays that run together, in every way a packet may be made of, against the other flavours and the
// oracle. Also that packets are what is tested. Their error bounds: packet_bounds_test.cpp.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "support/bundles.h"

using gnomon::TraceFlavour;
using namespace gnomon::test;

namespace {

// The largest share of rays that have the counts of the fifteen beside them: those of a packet do.
double share_in_packets(const Triangles& triangles, const Rays& rays, bool any_hit,
                        TraceFlavour flavour = TraceFlavour::kPacket) {
  gnomon::TraceOptions options;
  options.counters = true;
  options.flavour = flavour;
  const auto tree = gnomon::build_device(context(), triangles);
  const gnomon::Tracer tracer(context(), tree, options);
  const auto counters = (any_hit ? tracer.any(rays) : tracer.closest(rays)).counters;
  std::size_t alike = 0;
  for (std::size_t i = 0; i + 16 <= counters.size(); i += 16) {
    // The first ray counts what all share.
    bool same = true;
    for (std::size_t k = 2; k < 16; ++k)
      same &= counters[i + k].boxes == counters[i + 1].boxes &&
              counters[i + k].triangles == counters[i + 1].triangles;
    alike += same ? 16 : 0;
  }
  return static_cast<double>(alike) / static_cast<double>(counters.size());
}

}  // namespace

TEST_CASE("packets give the other flavours' bits and the oracle's answers on bundles of every kind",
          "[unlimited]") {
  for (const auto& [name, rays] : bundles(6)) {
    for (const float size : {0.1F, 1.0F, 6.0F}) {
      CAPTURE(name, size);
      const auto triangles = soup(1500, 201, size);
      require_equal_flavours(triangles, rays);
      require_faultless(triangles, rays, false);
    }
  }
}

// Packets are demanded here whatever the device: the entry device_test_rusticl_packets runs this test alone.
// Others of the simulator's tests watch the other flavours.
TEST_CASE("packets give the other flavours' bits on a small soup", "[memcheck][unlimited]") {
  const auto tree = gnomon::build_device(context(), soup(60, 202, 1.5F));
  for (const auto& [name, bundle] : bundles(1)) {
    CAPTURE(name);
    const Rays rays(bundle.begin(), bundle.begin() + 24);
    const Traced thread = trace(tree, rays, TraceFlavour::kThread);
    for (const bool portable : {false, true})
      require_same_answers(thread, trace(tree, rays, TraceFlavour::kPacket, portable));
  }
}

TEST_CASE("packets give the other flavours' bits on leaves of many blocks", "[unlimited]") {
  const auto triangles = soup(1200, 221, 1.0F);
  for (const auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    require_equal_flavours(triangles, rays, lazy_leaves_of(255));
  }
}

TEST_CASE("rays that run together are traced as packets", "[unlimited]") {
  if (!context().device().is_cpu) return;
  const auto triangles = soup(2000, 203, 1.0F);
  for (const auto& [name, rays] : bundles(12)) {
    CAPTURE(name);
    REQUIRE(share_in_packets(triangles, rays, false) > 0.8);
    REQUIRE(share_in_packets(triangles, rays, true) > 0.8);
  }
  // And others are not.
  REQUIRE(share_in_packets(triangles, random_rays(4096, 204), false) < 0.1);
}

TEST_CASE(
    "left to us, packets are made where they pay, and elsewhere one of each work-item's tells that they do "
    "not",
    "[unlimited]") {
  if (!context().device().is_cpu) return;
  const auto large = soup(2000, 203, 1.0F);
  const Rays close = camera_rays(16, {5, 4, 30}, {-0.1F, 0.05F, -1}, 0.1F);
  // Of these few are met: what rays by themselves would take is nearly all nodes.
  const auto thin = soup(20000, 219, 0.01F);
  const Rays beside = camera_rays(16, {5, 4, 30}, {-0.1F, 0.05F, -1}, 0.4F);
  const auto fine = soup(60000, 217, 0.05F);
  const Rays apart = sun_rays(6, {0.4F, -0.8F, 0.45F}, 9.0F);
  REQUIRE(share_in_packets(large, close, true, TraceFlavour::kAuto) > 0.9);
  REQUIRE(share_in_packets(thin, beside, true, TraceFlavour::kAuto) > 0.9);
  REQUIRE(share_in_packets(fine, apart, true) > 0.8);
  // Alike by chance are few: the first of eight packets is left.
  REQUIRE(share_in_packets(fine, apart, true, TraceFlavour::kAuto) < 0.25);
  REQUIRE(share_in_packets(fine, apart, true, TraceFlavour::kAuto) > 0.1);
  // For closest hits they always pay.
  REQUIRE(share_in_packets(fine, apart, false, TraceFlavour::kAuto) > 0.8);
}

TEST_CASE("a batch that packets do not divide, or with rays that do not belong, has the same answers",
          "[unlimited]") {
  const auto triangles = soup(1000, 205, 1.0F);
  for (auto& [name, rays] : bundles(4)) {
    CAPTURE(name);
    rays.resize(rays.size() - 41);
    rays[70].direction[1] = NAN;
    rays[200].tmin = -3.0F;
    rays[300].tmax = 0.5F * rays[300].tmin - 1.0F;
    for (float& x : rays[400].direction) x = -x;
    rays[500].tmin = 2.0F;
    rays[501].tmax = 2.0F;
    std::rotate(rays.begin(), rays.begin() + 7, rays.end());
    require_equal_flavours(triangles, rays);
  }
}

// Camera rays through corners, edges' middles and points of triangles, in order of direction; far from the
// origin and at scales whose numbers are as small and as large as coordinates may be.
TEST_CASE("packets lose no ray aimed at corners and edges, at any scale and distance", "[unlimited]") {
  Random random(206);
  for (const float scale : {1.0F, std::ldexp(1.0F, -40), std::ldexp(1.0F, 30)}) {
    for (const float offset : {0.0F, 1.0e3F, 1.0e5F}) {
      CAPTURE(scale, offset);
      Triangles triangles = grid(12, 0.8F);
      for (GnTriangle& t : triangles)
        for (float* v : {t.v0, t.v1, t.v2})
          for (int k = 0; k < 3; ++k) v[k] = scale * (v[k] + offset);
      const Point eye{scale * (offset + 5.2F), scale * (offset + 9.1F), scale * (offset + 4.7F)};
      Rays rays;
      for (int i = 0; i < 1500; ++i) {
        const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
        const float* a = corner(t, random.below(3));
        const float* b = corner(t, random.below(3));
        const float target[3] = {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
        rays.push_back(aimed(eye, target));
      }
      const auto cell = [](const GnRay& r) {
        return std::pair(std::floor(8 * r.direction[0] / r.direction[1]), r.direction[2] / r.direction[1]);
      };
      std::sort(rays.begin(), rays.end(), [&](const GnRay& a, const GnRay& b) { return cell(a) < cell(b); });
      require_equal_flavours(triangles, rays);
      require_faultless(triangles, rays, true);
    }
  }
}

TEST_CASE("a packet of shadow rays ends when all are occluded", "[unlimited]") {
  if (!context().device().is_cpu) return;
  Triangles triangles = soup(2000, 215, 0.5F);
  triangles.push_back(triangle({-900, 11, -900}, {900, 11, -900}, {0, 11, 1800}));
  gnomon::TraceOptions options;
  options.counters = true;
  options.flavour = TraceFlavour::kPacket;
  const auto tree = gnomon::build_device(context(), triangles);
  const gnomon::Tracer tracer(context(), tree, options);
  const auto work = [](const std::vector<GnRayCounters>& counters) {
    return std::accumulate(counters.begin(), counters.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const GnRayCounters& c) { return sum + c.triangles; });
  };
  // From within the soup upwards: the lid is the largest box, and met first.
  const Rays rays = tiled(6, [](float x, float y) { return ray({5 + 6 * x, -1, 5 + 6 * y}, {0, 1, 0}); });
  const auto any = tracer.any(rays);
  REQUIRE(std::count(any.occluded.begin(), any.occluded.end(), 1U) == static_cast<long>(rays.size()));
  REQUIRE(3 * work(any.counters) < work(tracer.closest(rays).counters));
}
