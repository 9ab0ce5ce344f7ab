// Charts of what rays were tested against, what heuristics expected, and how far off answers are.
#include <algorithm>
#include <functional>
#include <map>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/chart_list.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

class WorkCharts {
 public:
  explicit WorkCharts(ChartList& list) : list_(list) {}

  void all() {
    work("boxes", "Boxes tested per ray", "boxes per ray, each ray by itself",
         [](const TraceRow& row) { return row.boxes_per_ray; });
    work("triangles", "Triangles tested per ray", "triangles per ray, each ray by itself",
         [](const TraceRow& row) { return row.triangles_per_ray; });
    for (const std::string& kind : predicted_kinds()) prediction(kind);
    errors();
  }

 private:
  void work(const std::string& name, const std::string& title, const std::string& label,
            const std::function<double(const TraceRow&)>& value) {
    RowPlot plot;
    plot.x_label = label;
    plot.series = kinds_of(list_.device);
    for (const MethodFacts& method : list_.device.methods) {
      RowPlot::Row row{letter_of(list_.device, method.name) + "  " + method.name, {}, ""};
      for (const TraceRow& trace : list_.device.traces) {
        if (trace.method != method.name || !trace.counted || value(trace) <= 0.0) continue;
        const auto series =
            std::find(plot.series.begin(), plot.series.end(), trace.kind) - plot.series.begin();
        row.marks.push_back({static_cast<std::size_t>(series), value(trace), 0.0, 0.0,
                             trace.kind + ": " + significant(value(trace), 4)});
      }
      if (!row.marks.empty()) plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    list_.add(name, title, "Exact counts, the same on every machine.", draw(plot));
  }

  [[nodiscard]] std::vector<std::string> predicted_kinds() const {
    std::vector<std::string> kinds;
    for (const PredictionRow& row : list_.device.predictions)
      if (std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end()) kinds.push_back(row.kind);
    return kinds;
  }

  void prediction(const std::string& kind) {
    Scatter s;
    s.x_label = "predicted cost of a ray";
    s.y_label = "measured cost, " + kind + " rays";
    s.diagonal = true;
    std::uint64_t rays = 0;
    for (const PredictionRow& row : list_.device.predictions) {
      if (row.kind != kind || row.predicted <= 0.0 || row.measured <= 0.0) continue;
      rays = row.rays;
      s.dots.push_back({letter_of(list_.device, row.method), group_of(list_.device, row.method),
                        row.predicted, row.measured,
                        row.method + ": predicted " + significant(row.predicted) + ", measured " +
                            significant(row.measured) + " ± " + significant(row.standard_error)});
    }
    if (s.dots.empty()) return;
    list_.add("prediction-" + file_word(kind), "Predicted and measured cost, " + kind + " rays",
              "On the dashed line the method's own heuristic was right about " + std::to_string(rays) +
                  " rays; above it they cost more than predicted. Cost: 2 a pierced box with children, 1.2 a "
                  "triangle of a pierced "
                  "leaf, nothing pruned.",
              draw(s));
  }

  // Kinds may be names of files.
  static std::string file_word(const std::string& kind) {
    std::string word;
    for (const char c : kind)
      word += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    return word;
  }

  // The share of hits whose t is off by more than x, for each set of methods with the same answers.
  void errors() {
    struct Group {
      std::vector<std::string> methods;
      std::map<double, std::uint64_t> steps;  // by upper end; 0: beyond the last
      std::uint64_t hits = 0;
    };
    std::vector<Group> groups;
    for (const MethodFacts& method : list_.device.methods) {
      Group own{{method.name}, {}, 0};
      for (const AccuracyRow& row : list_.device.accuracies) {
        if (row.method != method.name) continue;
        for (const auto& [end, hits] : row.t_error_steps) {
          own.steps[end] += hits;
          own.hits += hits;
        }
      }
      if (own.hits == 0) continue;
      const auto same =
          std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.steps == own.steps; });
      if (same == groups.end()) {
        groups.push_back(std::move(own));
      } else {
        same->methods.push_back(method.name);
      }
    }
    CurvePlot plot;
    plot.x_label = "error of t, ulp";
    plot.y_label = "share of hits with a larger error";
    for (const Group& group : groups) {
      CurvePlot::Curve curve;
      curve.name = group.methods.front();
      if (group.methods.size() > 1)
        curve.name += " and " + std::to_string(group.methods.size() - 1) + " with the same";
      std::uint64_t larger = group.hits;
      for (const auto& [end, hits] : group.steps) {
        if (end == 0.0) continue;
        larger -= hits;
        if (larger > 0)
          curve.points.emplace_back(end, static_cast<double>(larger) / static_cast<double>(group.hits));
        else
          break;
      }
      if (curve.points.empty())
        curve.name += ": none over " + significant(group.steps.rbegin()->first) + " ulp";
      plot.curves.push_back(std::move(curve));
    }
    if (plot.curves.empty()) return;
    list_.add(
        "errors", "How far off distances are",
        "Of hits on the right triangle, against exact arithmetic, in units of the last place of a float. "
        "Further left and "
        "lower is better.",
        draw(plot));
  }

  ChartList& list_;
};

}  // namespace

void add_work_charts(ChartList& list) {
  WorkCharts(list).all();
}

}  // namespace gnomon::compare
