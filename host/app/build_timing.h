// Building a tree and timing it honestly: compiling kernels at first use is not build time. Feeds the
// subcommands that build.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gnomon/base/stats.h"
#include "gnomon/device/build_device.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/bvh_check.h"

namespace gnomon::app {

struct BuildRuns {
  std::uint64_t repeat = 1;  // timed runs, at least 1
  bool warm_up = false;      // one run before them that does not count
};

struct TimedBuild {
  BuildOptions options;  // that decided the tree
  bool fitted = false;   // to rays, by a plan, from where the options led
  std::string file;      // it came from; empty: it was built here, in the time below
  DeviceBvh tree;
  BuildRuns runs;
  Spread total_ms;
  BuildReport median;  // of the run with the median time
  Bvh host;            // the tree's copy
  std::string hash;
  std::optional<BvhFault> fault;
  BvhStats stats;  // zeros for a faulty tree, whose links may lead in circles
};

// Throws as build_device. Says in `fault` what is wrong with the tree; only those who look into that may go
// on then.
[[nodiscard]] TimedBuild build_timed(const cl::Context& context, const Scene& scene,
                                     const BuildOptions& options, const BuildRuns& runs,
                                     const Progress& progress);

// The same for those who count on a right tree: throws Error{kDevice} for a faulty one, since tracing it
// could hang the device.
[[nodiscard]] TimedBuild build_for_use(const cl::Context& context, const Scene& scene,
                                       const BuildOptions& options, const BuildRuns& runs,
                                       const Progress& progress);

}  // namespace gnomon::app
