// Tracing a batch again and again: how fast, and how much work a ray is. Feeds `trace`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gnomon/base/stats.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/tree/hit_difference.h"

namespace gnomon::app {

struct TimedTrace {
  TraceFlavour flavour = TraceFlavour::kAuto;  // the one that traced
  std::vector<Hit> hits;                       // closest hits; empty for any-hit queries
  std::uint64_t hit_count = 0;
  std::uint64_t invalid_rays = 0;
  bool device_clock = false;    // seconds are device event times; else wall clock, transfers included
  std::vector<double> seconds;  // one per timed pass
  std::vector<double> wall_seconds;
  Spread mrays_per_s;
  std::optional<HitDifference> cost;  // of fast accuracy, in hits: from a watertight pass over the same rays
  double boxes_per_ray = 0.0;         // from a pass of its own with counters compiled in
  double triangles_per_ray = 0.0;
};

// `how`: flavour and accuracy. One pass to warm up, `repeat` timed ones, one that counts. wide: traced
// instead of `tree` where there is one. Throws as Tracer.
[[nodiscard]] TimedTrace trace_timed(const cl::Context& context, const DeviceBvh& tree,
                                     std::span<const Ray> rays, bool any_hit, const TraceOptions& how,
                                     std::uint64_t repeat, const Progress& progress,
                                     const DeviceWideBvh* wide = nullptr);

}  // namespace gnomon::app
