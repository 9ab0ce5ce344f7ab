// Building a tree and timing it honestly: compiling kernels at first use is not build time. Feeds the
// subcommands that build.
#pragma once

#include <string>
#include <vector>

#include "gnomon/base/stats.h"
#include "gnomon/device/build_device.h"
#include "gnomon/scene/scene.h"

namespace gnomon::app {

struct BuildRuns {
  std::uint64_t repeat = 1;  // timed runs, at least 1
  bool warm_up = false;      // one run before them that does not count
};

struct TimedBuild {
  DeviceBvh tree;
  BuildRuns runs;
  Spread total_ms;
  BuildReport median;  // of the run with the median time
  Bvh host;            // the tree's copy
  BvhStats stats;
  std::string hash;
};

// Throws as build_device.
[[nodiscard]] TimedBuild build_timed(const cl::Context& context, const Scene& scene,
                                     const BuildOptions& options, const BuildRuns& runs,
                                     const Progress& progress);

}  // namespace gnomon::app
