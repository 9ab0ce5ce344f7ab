#include "trace_timing.h"

#include <algorithm>
#include <chrono>

namespace gnomon::app {
namespace {

TraceResult trace_once(const Tracer& tracer, std::span<const Ray> rays, bool any_hit,
                       const Progress& progress) {
  return any_hit ? tracer.any(rays, progress) : tracer.closest(rays, progress);
}

std::uint64_t count_hits(const TraceResult& result) {
  const auto hits = std::count_if(result.hits.begin(), result.hits.end(),
                                  [](const Hit& hit) { return hit.primitive != GN_NONE; });
  const auto occluded = std::count(result.occluded.begin(), result.occluded.end(), 1U);
  return static_cast<std::uint64_t>(hits + occluded);
}

void count_work(TimedTrace& timed, const TraceResult& counted) {
  if (counted.counters.empty()) return;
  std::uint64_t boxes = 0;
  std::uint64_t triangles = 0;
  for (const GnRayCounters& ray : counted.counters) {
    boxes += ray.boxes;
    triangles += ray.triangles;
  }
  const auto rays = static_cast<double>(counted.counters.size());
  timed.boxes_per_ray = static_cast<double>(boxes) / rays;
  timed.triangles_per_ray = static_cast<double>(triangles) / rays;
}

}  // namespace

TimedTrace trace_timed(const cl::Context& context, const DeviceBvh& tree, std::span<const Ray> rays,
                       bool any_hit, const TraceOptions& how, std::uint64_t repeat, const Progress& progress,
                       const DeviceWideBvh* wide) {
  TraceOptions options = how;
  const auto tracer_of = [&] {
    return wide != nullptr ? Tracer(context, *wide, options) : Tracer(context, tree, options);
  };
  const Tracer tracer = tracer_of();
  TimedTrace timed;
  timed.flavour = tracer.flavour();
  TraceResult last = trace_once(tracer, rays, any_hit, progress);
  std::vector<double> device_seconds;
  for (std::uint64_t i = 0; i < repeat; ++i) {
    const auto start = std::chrono::steady_clock::now();
    last = trace_once(tracer, rays, any_hit, progress);
    timed.wall_seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    device_seconds.push_back(1e-3 * last.kernel_ms);
  }
  // Some drivers report no event times, or zeros.
  timed.device_clock =
      std::all_of(device_seconds.begin(), device_seconds.end(), [](double s) { return s > 0.0; });
  timed.seconds = timed.device_clock ? device_seconds : timed.wall_seconds;
  std::vector<double> speeds;
  for (const double seconds : timed.seconds)
    speeds.push_back(1e-6 * static_cast<double>(rays.size()) / seconds);
  timed.mrays_per_s = spread_of(speeds);
  timed.hit_count = count_hits(last);
  timed.invalid_rays = last.invalid_rays;
  if (how.accuracy == Accuracy::kFast) {
    options.accuracy = Accuracy::kWatertight;
    const TraceResult exact = trace_once(tracer_of(), rays, any_hit, progress);
    timed.cost =
        any_hit ? difference_of(exact.occluded, last.occluded) : difference_of(exact.hits, last.hits);
    options.accuracy = how.accuracy;
  }
  timed.hits = std::move(last.hits);

  options.counters = true;
  count_work(timed, trace_once(tracer_of(), rays, any_hit, progress));
  return timed;
}

}  // namespace gnomon::app
