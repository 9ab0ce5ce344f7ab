#include "build_timing.h"

namespace gnomon::app {

TimedBuild build_timed(const cl::Context& context, const Scene& scene, const BuildOptions& options,
                       const BuildRuns& runs, const Progress& progress) {
  TimedBuild result;
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
  result.stats = stats_of(result.host, options);
  result.hash = tree_hash(result.host);
  return result;
}

}  // namespace gnomon::app
