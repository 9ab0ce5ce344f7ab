// Measures methods on one device and scene: builds, traces, judges, predicts and draws. Never prints. What is
// finished is in the report at any moment, so that a run that ends early leaves rows, and another goes on
// from them. Feeds the command line and benches.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gnomon/compare/method.h"
#include "gnomon/compare/report.h"

namespace gnomon::compare {

struct RunOptions {
  std::vector<std::string> kinds = default_kinds();
  std::vector<std::string> methods;   // names, or beginnings of names; empty: all. kBaseline always runs
  std::uint64_t ray_count = 65'536;   // of each kind at most
  std::uint64_t judged_rays = 2'000;  // of each kind at most
  std::uint64_t predicted_rays = 500;
  std::uint64_t seed = 1;
  int rounds = 7;
  double seconds = 150.0;  // for this device; see run_device
  // The scene at about so many triangles; none: triangles are left out. Throws Error{kInvalidArgument} for
  // too few.
  std::function<Scene(std::uint64_t triangles)> at_size;
  PlanBuilder plan = reference_builder();  // of plans for single lights
  std::uint32_t picture_width = 320;
  std::uint32_t picture_height = 180;

  // Throws Error{kInvalidArgument} naming the option, its value and its range.
  void check() const;
};

// Fills `report`, whose finished steps it passes over. The budget: first builds may begin in its first six
// tenths, and one that would end later, by the mean of those before it, is left out; then builds, kinds of
// rays, judging, sizes, areas and pictures share what is left, with fewer rays and rounds where it is short,
// but never less than one round of kLeastRays rays; what is left after all of them goes to further rounds and
// more rays where these were cut short. What was left out is in the report. after_step: called whenever a
// step is finished and the report is worth keeping. A method whose first build fails is left out with its
// error; kBaseline's error, and any later one, is thrown. Throws Error{kCancelled} as `progress` asks.
void run_device(const cl::Context& context, const Scene& scene, const std::vector<Method>& methods,
                const RunOptions& options, DeviceReport& report, const std::function<void()>& after_step,
                const Progress& progress);

}  // namespace gnomon::compare
