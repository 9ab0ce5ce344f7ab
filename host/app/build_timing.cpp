#include "build_timing.h"

namespace gnomon::app {

TimedBuild build_timed(const cl::Context& context, const Scene& scene, const BuildOptions& options,
                       const BuildRuns& runs, const Progress& progress) {
  TimedBuild result;
  result.options = options;
  result.runs = runs;
  if (runs.warm_up) result.tree = build_device(context, scene.triangles, options, nullptr, progress);
  std::vector<BuildReport> reports(runs.repeat);
  std::vector<double> times;
  for (BuildReport& report : reports) {
    result.tree = {};  // make room for the next one
    result.tree = build_device(context, scene.triangles, options, &report, progress);
    times.push_back(report.total_ms);
  }
  result.total_ms = spread_of(times);
  result.median = reports[median_index(times)];
  result.host = download_bvh(context, result.tree);
  result.hash = tree_hash(result.host);
  result.fault = check_bvh(result.host, scene.triangles, options);
  if (!result.fault) result.stats = stats_of(result.host, options);
  return result;
}

TimedBuild build_for_use(const cl::Context& context, const Scene& scene, const BuildOptions& options,
                         const BuildRuns& runs, const Progress& progress) {
  TimedBuild result = build_timed(context, scene, options, runs, progress);
  if (!result.fault) return result;
  throw Error(ErrorCode::kDevice, context.device().name + " built a broken tree: " + result.fault->what +
                                      "; gnomon validate says more, another --device may do better");
}

}  // namespace gnomon::app
