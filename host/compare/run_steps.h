// The steps of a run on one device, and what they share: the report, the time, the methods at work. Not
// public. Feeds run_device.cpp.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/compare/run_device.h"

namespace gnomon::compare {

struct Entered {
  const Method* method;
  std::unique_ptr<Entrant> entrant;
};

// What is left of the time goes to these, in this order, by weight.
inline constexpr double kBuildWeight = 6.0;
inline constexpr double kTraceWeight = 2.0;  // each kind
inline constexpr double kJudgeWeight = 1.0;  // each kind
inline constexpr double kSizesWeight = 2.0;
inline constexpr double kAreasWeight = 2.0;
inline constexpr double kPictureWeight = 1.0;

class RunState {
 public:
  RunState(const cl::Context& context, const Scene& scene, const RunOptions& options, DeviceReport& report,
           const std::function<void()>& after_step, const Progress& progress);

  const cl::Context& context;
  const Scene& scene;
  const RunOptions& options;
  DeviceReport& report;
  std::vector<Entered> entered;
  Entrant* baseline = nullptr;
  std::vector<std::string> cut_kinds;  // of rays: fewer of them, or of rounds, than wished, for want of time

  [[nodiscard]] bool is_done(const std::string& step) const;
  void finish(const std::string& step);
  // As if these rays had not been traced and judged yet.
  void forget(const std::string& kind);
  void keep() { after_step_(); }
  void leave_out(const std::string& method, const std::string& what, const std::string& reason);
  void say_rounds(const std::string& step, std::size_t rounds);

  [[nodiscard]] double spent() const;
  // Until when the next step may go on, if all steps still to come share what is left by weight.
  [[nodiscard]] double deadline(double weight, double weights_left) const;
  // Of all steps from tracing this kind on.
  [[nodiscard]] double weights_from(std::size_t kind) const;
  [[nodiscard]] std::size_t place_of(const std::string& kind) const;
  [[nodiscard]] std::string budget() const;
  void tell(const std::string& stage, double done) const;
  [[nodiscard]] Progress stage_of(const std::string& stage, double done) const;
  [[nodiscard]] Batch make_batch_of(const std::string& kind, std::uint64_t count) const;

 private:
  const std::function<void()>& after_step_;
  const Progress& progress_;
  double start_;
};

template <typename Row>
Row& row_of(std::vector<Row>& rows, const std::string& method) {
  return *std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.method == method; });
}

// Builds each method's tree once, which also compiles its kernels, keeps what it is like and holds its
// heuristic's prediction against rays. Fills `entered`.
void enter_methods(RunState& run, const std::vector<Method>& methods);
void time_builds(RunState& run);
void time_traces(RunState& run, const std::string& kind, double until);
// The contests again, where time was short for them and the rest of a run left some. Further rounds of builds
// are added to those before.
void add_rounds_of_builds(RunState& run, double until);
// Whether there is time by `until` for twice the rays of this kind, or for the rounds that it lacks.
[[nodiscard]] bool has_time_for_more(const RunState& run, const std::string& kind, double until);
void time_sizes(RunState& run);
void count_areas(RunState& run);

}  // namespace gnomon::compare
