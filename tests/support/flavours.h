// The flavours of traversal held against each other, the references and the oracle; and rays that are awkward
// to trace. Feeds the device tests.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <vector>

#include "gnomon/device/trace_device.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/oracle.h"
#include "gnomon/tree/trace_wide_reference.h"
#include "support/device.h"
#include "support/wide_shapes.h"

namespace gnomon::test {

using Triangles = std::vector<GnTriangle>;
using Rays = std::vector<GnRay>;

struct Traced {
  TraceResult closest;
  TraceResult any;
};

inline Traced trace(const DeviceBvh& tree, const Rays& rays, TraceFlavour flavour, bool portable = false,
                    bool counters = false) {
  TraceOptions options;
  options.flavour = flavour;
  options.portable = portable;
  options.counters = counters;
  const Tracer tracer(context(), tree, options);
  if (flavour != TraceFlavour::kAuto) REQUIRE(tracer.flavour() == flavour);
  return {tracer.closest(rays), tracer.any(rays)};
}

inline void require_same_answers(const Traced& a, const Traced& b) {
  REQUIRE(a.closest.invalid_rays == b.closest.invalid_rays);
  REQUIRE(a.any.invalid_rays == b.any.invalid_rays);
  for (std::size_t i = 0; i < a.closest.hits.size(); ++i) {
    CAPTURE(i, a.closest.hits[i].t, b.closest.hits[i].t, a.closest.hits[i].primitive,
            b.closest.hits[i].primitive);
    REQUIRE(std::memcmp(&a.closest.hits[i], &b.closest.hits[i], sizeof(GnHit)) == 0);
    REQUIRE(a.any.occluded[i] == b.any.occluded[i]);
    REQUIRE((a.any.occluded[i] == 1) == (a.closest.hits[i].primitive != GN_NONE));
  }
}

// Visits and hits of the device are the reference's. Divisions may be rounded otherwise on a GPU.
inline void require_reference_work(const WideBvh& wide, const Rays& rays, const Traced& traced) {
  if (!context().device().is_cpu || !context().device().fp64) return;
  const auto closest = trace_wide_reference(wide, rays, false);
  const auto any = trace_wide_reference(wide, rays, true);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(std::memcmp(&traced.closest.hits[i], &closest.hits[i], sizeof(GnHit)) == 0);
    REQUIRE(traced.closest.counters[i].boxes == closest.counters[i].boxes);
    REQUIRE(traced.closest.counters[i].triangles == closest.counters[i].triangles);
    REQUIRE((traced.any.occluded[i] == 1) == (any.hits[i].primitive != GN_NONE));
    REQUIRE(traced.any.counters[i].boxes == any.counters[i].boxes);
    REQUIRE(traced.any.counters[i].triangles == any.counters[i].triangles);
  }
}

inline void require_reference_work(const DeviceBvh& tree, const Triangles& triangles, const Rays& rays,
                                   const Traced& traced) {
  require_reference_work(collapse_reference(download_bvh(context(), tree), triangles), rays, traced);
}

// Devices that end loops are never given packets unless a caller demands them, and Mesa takes minutes to
// compile those kernels: there the ctest entry device_test_rusticl_packets demands them, once.
inline bool takes_packets() {
  return context().device().loop_limit == 0;
}

// Returns the hits of the flavours, which are equal.
inline std::vector<GnHit> require_equal_flavours(const Triangles& triangles, const Rays& rays,
                                                 const BuildOptions& options = {}) {
  const auto tree = build_device(context(), triangles, options);
  const Traced thread = trace(tree, rays, TraceFlavour::kThread);
  const Traced wide = trace(tree, rays, TraceFlavour::kWide);
  for (const bool portable : {false, true}) {
    if (takes_packets()) {
      require_same_answers(thread, trace(tree, rays, TraceFlavour::kPacket, portable));
      require_same_answers(thread, trace(tree, rays, TraceFlavour::kAuto, portable));
    }
    require_same_answers(thread, trace(tree, rays, TraceFlavour::kWide, portable));
  }
  require_same_answers(thread, trace(tree, rays, TraceFlavour::kCompact));
  require_same_answers(thread, trace(tree, rays, TraceFlavour::kCompact, false, true));
  for (const bool portable : {false, true}) {
    const Traced counted = trace(tree, rays, TraceFlavour::kWide, portable, true);
    require_same_answers(thread, counted);
    require_reference_work(tree, triangles, rays, counted);
  }
  return wide.closest.hits;
}

inline void require_faultless(const Triangles& triangles, const Rays& rays, bool aimed) {
  const auto tree = build_device(context(), triangles);
  const Traced traced = trace(tree, rays, takes_packets() ? TraceFlavour::kPacket : TraceFlavour::kWide);
  OracleOptions options;
  options.max_rays = rays.size();
  const auto report = judge(triangles, rays, traced.closest.hits, traced.any.occluded, options);
  REQUIRE(report.rays_judged == rays.size());
  REQUIRE(report.lost == 0);
  REQUIRE(report.any_closest_disagree == 0);
  if (context().device().fp64 || !aimed) {
    REQUIRE(report.mismatches() == 0);
    REQUIRE(report.max_t_error_ulp <= 1.0);
  }
}

inline Rays aimed_rays(const Triangles& triangles, std::uint32_t count, std::uint32_t seed,
                       float offset = 0.0F) {
  Random random(seed);
  Rays rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto& t = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))];
    const float* a = corner(t, random.below(3));
    const float* b = corner(t, random.below(3));
    const float target[3] = {0.5F * (a[0] + b[0]), 0.5F * (a[1] + b[1]), 0.5F * (a[2] + b[2])};
    rays.push_back(aimed(
        {offset + random.between(-5, 15), offset + random.between(-5, 15), offset + random.between(-5, 15)},
        target));
  }
  return rays;
}

// Random rays whose ranges, directions and origins are awkward in turn.
inline Rays awkward_rays(std::uint32_t count, std::uint32_t seed) {
  Random random(seed);
  Rays rays = random_rays(count, seed + 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    GnRay& r = rays[i];
    const std::uint32_t axis = random.below(3);
    switch (i % 10) {
      case 0:
        r.direction[axis] = random.below(2) == 0 ? 0.0F : -0.0F;
        break;
      case 1:
        r.direction[axis] = r.direction[(axis + 1) % 3] = random.below(2) == 0 ? 0.0F : -0.0F;
        break;
      case 2:
        r.tmin = random.between(-15.0F, 0.0F);
        break;
      case 3:
        r.tmin = -INFINITY;
        break;
      case 4:
        r.tmin = random.between(0.0F, 10.0F);
        r.tmax = r.tmin + random.between(0.0F, 5.0F);
        break;
      case 5:
        r.tmin = random.between(-20.0F, -10.0F);
        r.tmax = random.between(-10.0F, 0.0F);
        break;
      case 6:
        r.direction[axis] *= 1e-40F;
        break;
      case 7:
        for (float& x : r.direction) x *= random.below(2) == 0 ? 1e-30F : 1e30F;
        break;
      case 8:
        r.direction[axis] = random.below(2) == 0 ? INFINITY : std::nanf("");
        break;
      default:
        r.tmax = random.between(-1.0F, 6.0F);
    }
  }
  return rays;
}

}  // namespace gnomon::test
