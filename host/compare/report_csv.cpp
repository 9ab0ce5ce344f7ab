#include <algorithm>
#include <array>
#include <charconv>

#include "gnomon/base/stats.h"
#include "gnomon/compare/report_json.h"

namespace gnomon::compare {
namespace {

// The shortest text that reads back as the same number.
std::string text_of(double value) {
  std::array<char, 40> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

template <typename Row>
const Row* find(const std::vector<Row>& rows, const std::string& method, const std::string& kind) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const Row& r) { return r.method == method && r.kind == kind; });
  return found == rows.end() ? nullptr : &*found;
}

std::string spread_cells(const std::vector<double>& seconds, double scale) {
  const Spread s = spread_of(seconds);
  if (s.count == 0) return ",,,,";
  return "," + text_of(scale * s.median) + "," + text_of(scale * s.min) + "," + text_of(scale * s.max) + "," +
         std::to_string(s.count);
}

std::string line(const Report& report, const DeviceReport& device, const BuildRow& build,
                 const std::string& kind) {
  std::string out = cell(device.name) + "," + cell(device.driver) + "," + cell(report.scene) + "," +
                    report.scene_hash + "," + cell(build.method) + "," + cell(kind);
  out += spread_cells(seconds_of(build.rounds, report.clock), 1.0) + "," + std::to_string(build.bytes) + "," +
         (build.tree_hash.empty() ? "," : text_of(build.sah_cost) + "," + build.tree_hash);
  const TraceRow* trace = find(device.traces, build.method, kind);
  out += trace == nullptr ? ",,,,,"
                          : "," + std::to_string(trace->rays) +
                                spread_cells(seconds_of(trace->rounds, report.clock),
                                             1e9 / static_cast<double>(trace->rays));
  out += trace == nullptr || !trace->counted
             ? ",,"
             : "," + text_of(trace->boxes_per_ray) + "," + text_of(trace->triangles_per_ray);
  const AccuracyRow* accuracy = find(device.accuracies, build.method, kind);
  out += accuracy == nullptr
             ? ",,,,,,"
             : "," + std::to_string(accuracy->judged) + "," + std::to_string(accuracy->lost) + "," +
                   std::to_string(accuracy->false_hits) + "," + std::to_string(accuracy->wrong_primitive) +
                   "," + std::to_string(accuracy->any_closest_disagree) + "," +
                   text_of(accuracy->max_t_error_ulp);
  const PredictionRow* prediction = find(device.predictions, build.method, kind);
  out += prediction == nullptr ? ",,,"
                               : "," + text_of(prediction->predicted) + "," + text_of(prediction->measured) +
                                     "," + text_of(prediction->standard_error);
  return out + "," + cell(report.version) + "," + cell(report.commit) + "," + cell(report.command) + "\n";
}

}  // namespace

std::string to_csv(const Report& report) {
  std::string out =
      "device,driver,scene,scene_hash,method,rays,build_s,build_s_min,build_s_max,build_rounds,bytes,sah_"
      "cost,tree_hash,"
      "ray_count,trace_ns_per_ray,trace_ns_min,trace_ns_max,trace_rounds,boxes_per_ray,triangles_per_ray,"
      "judged,lost,"
      "false_hits,wrong_primitive,any_closest_disagree,max_t_error_ulp,predicted_cost,measured_cost,"
      "measured_standard_error,version,commit,command\n";
  for (const DeviceReport& device : report.devices) {
    std::vector<std::string> kinds;
    for (const TraceRow& row : device.traces)
      if (std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end()) kinds.push_back(row.kind);
    if (kinds.empty()) kinds.emplace_back();
    for (const BuildRow& build : device.builds)
      for (const std::string& kind : kinds) out += line(report, device, build, kind);
  }
  return out;
}

}  // namespace gnomon::compare
