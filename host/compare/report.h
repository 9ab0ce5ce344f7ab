// What a comparison found, as values: which methods were entered, and a row for each measurement. Not for
// measuring (run_device.h) and not for drawing (page.h): pages are made from these values alone. Feeds both,
// and report_json.h, which documents the file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gnomon::compare {

// Of the rows; raised when a field changes its meaning.
inline constexpr int kSchema = 1;

// Whose method it is, and so how charts mark it.
enum class Family {
  kSurface,  // ours, for rays from everywhere
  kRays,     // ours, for the rays of a light or a camera
  kMixture,  // ours, for both
  kPeer,     // another library's
};
[[nodiscard]] const char* to_string(Family family);

// One way to build and trace, as entered.
struct MethodFacts {
  std::string name;  // "sah-balanced": stable for ever
  Family family = Family::kSurface;
  std::string what;     // what it is, in a sentence
  std::string options;  // that build it with `gnomon build`; empty for peers
  bool exact = false;   // promises that no hit is lost or false
  bool operator==(const MethodFacts&) const = default;
};

// Seconds of each round. Round i of one contestant and round i of another ran next to each other.
struct Rounds {
  std::vector<double> wall_s;
  std::vector<double> cpu_s;  // of all threads of the process
  bool operator==(const Rounds&) const = default;
};

// Building one tree, from triangles in host memory until rays can be traced.
struct BuildRow {
  std::string method;
  Rounds rounds;
  std::uint64_t bytes = 0;          // that tracing reads: nodes and triangles in the traced layout
  std::uint64_t scratch_bytes = 0;  // gone when the build is over; 0: not known
  std::string tree_hash;            // of the binary tree; empty for peers
  std::uint64_t nodes = 0;          // of the binary tree; 0 for peers
  std::uint32_t max_depth = 0;
  double sah_cost = 0.0;  // relative to the root; 0 for peers
  std::string flavour;    // of the tracer
  bool operator==(const BuildRow&) const = default;
};

// Tracing one batch.
struct TraceRow {
  std::string method;
  std::string kind;  // of rays
  bool any_hit = false;
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  std::uint64_t passes = 1;    // of these rays in each round
  Rounds rounds;               // means over them
  bool counted = false;        // peers do not say
  double boxes_per_ray = 0.0;  // each ray by itself
  double triangles_per_ray = 0.0;
  bool operator==(const TraceRow&) const = default;
};

// One batch's answers against the oracle.
struct AccuracyRow {
  std::string method;
  std::string kind;
  std::string
      same_as;  // this method's answers were the same bits, so that one judgement holds for both; or empty
  std::uint64_t judged = 0;
  std::uint64_t hits = 0;
  std::uint64_t lost = 0;
  std::uint64_t false_hits = 0;
  std::uint64_t wrong_primitive = 0;
  std::uint64_t any_closest_disagree = 0;
  double max_t_error_ulp = 0.0;  // over agreeing hits
  // [upper end in ulp, hits] for steps that are not empty; the last end is 0 where the step has none.
  std::vector<std::pair<double, std::uint64_t>> t_error_steps;
  [[nodiscard]] std::uint64_t wrong() const {
    return lost + false_hits + wrong_primitive + any_closest_disagree;
  }
  bool operator==(const AccuracyRow&) const = default;
};

// What the method's own heuristic expected a ray to cost, and what rays cost: 2 a box pierced by the infinite
// ray that has children, 1.2 a triangle of a pierced leaf (host/measure/all_pierced.h). Nothing is pruned in
// either.
struct PredictionRow {
  std::string method;
  std::string kind;
  std::uint64_t rays = 0;
  double predicted = 0.0;
  double measured = 0.0;
  double standard_error = 0.0;  // of measured
  bool operator==(const PredictionRow&) const = default;
};

// What a method that chooses trees chose for one kind of rays (gnomon/plan/choose.h). Costs are counts: 1.0 a
// box test of the binary tree, 1.2 a triangle test.
struct DecisionRow {
  std::string method;
  std::string kind;
  std::string query;            // closest, any
  double expected = 0.0;        // rays that a tree must repay itself over
  std::string kept;             // the tree's name
  std::string reason;           // in words
  std::uint64_t probes = 0;     // rays it was judged by
  double baseline_cost = 0.0;   // of a probe ray in the baseline
  double cost = 0.0;            // and in what was kept
  double planning_share = 0.0;  // work of the whole planning over that of building its baseline
  bool operator==(const DecisionRow&) const = default;
};

// A method's times on the scene at one size. All sizes and methods took turns in one contest.
struct SizeRow {
  std::string method;
  std::string kind;  // of rays
  std::uint64_t triangles = 0;
  std::uint64_t rays = 0;
  bool thinned = false;  // the scene with triangles left out, not made anew at that size
  Rounds build;
  Rounds trace;
  bool operator==(const SizeRow&) const = default;
};

// What rays of one light cost in a method's tree, each by itself; beside kBaseline's row of the same area.
struct AreaRow {
  std::string method;
  std::string area;  // the light
  std::uint64_t rays = 0;
  double boxes_per_ray = 0.0;
  double triangles_per_ray = 0.0;
  // 1.0 a box and 1.2 a triangle, as plans reckon.
  [[nodiscard]] double cost() const { return boxes_per_ray + 1.2 * triangles_per_ray; }
  bool operator==(const AreaRow&) const = default;
};

// kBaseline on this device, in rounds that took turns with the report's other devices.
struct AcrossRow {
  std::string kind;  // of rays; empty: a build
  std::uint64_t rays = 0;
  Rounds rounds;
  bool operator==(const AcrossRow&) const = default;
};

// A method, or one of its measurements, that is not there, and why.
struct LeftOut {
  std::string method;  // empty: all of them
  std::string what;    // "build", "trace bounce" ...
  std::string reason;
  bool operator==(const LeftOut&) const = default;
};

// Pictures as PNG files; names are methods, "" is the scene's picture.
struct Pictures {
  std::map<std::string, std::string> png;  // bytes
  double white = 0.0;                      // boxes a ray at the bright end of every heat map
  std::map<std::string, double> mean;      // boxes a ray
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const Pictures&) const = default;
};

struct DeviceReport {
  std::string name, driver, platform, opencl, kind;  // kind: cpu, gpu, other
  std::uint32_t compute_units = 0;
  std::vector<MethodFacts> methods;
  std::vector<BuildRow> builds;
  std::vector<TraceRow> traces;
  std::vector<AccuracyRow> accuracies;
  std::vector<PredictionRow> predictions;
  std::vector<DecisionRow> decisions;
  std::vector<SizeRow> sizes;
  std::vector<AreaRow> areas;
  std::vector<AcrossRow> across;
  std::vector<LeftOut> left_out;
  Pictures pictures;
  std::vector<std::string> done;  // steps that are finished: a rerun passes over them
  bool complete = false;
  bool operator==(const DeviceReport&) const = default;
};

struct Report {
  std::string version, commit;
  std::string command;  // that repeats it
  std::string scene, scene_name, scene_hash;
  std::uint64_t triangles = 0;
  std::vector<std::pair<std::string, std::string>> options;  // name and value, seeds among them
  std::string clock = "wall";  // wall or cpu: which rounds charts and words go by
  std::string peer_note;       // why a peer is not there; empty: it is
  std::vector<DeviceReport> devices;
  [[nodiscard]] bool complete() const;
  bool operator==(const Report&) const = default;
};

// The rounds that the report's clock counts.
[[nodiscard]] const std::vector<double>& seconds_of(const Rounds& rounds, const std::string& clock);

}  // namespace gnomon::compare
