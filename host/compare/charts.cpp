#include "gnomon/compare/charts.h"

#include <algorithm>
#include <functional>
#include <map>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

class Charts {
 public:
  Charts(const Report& report, const DeviceReport& device)
      : report_(report), device_(device), lines_(lines_of(device, kAllKinds, report.clock)) {}

  std::vector<Chart> all() {
    if (!lines_.empty()) {
      pareto(
          "pareto-accuracy", "Time against accuracy", "wrong answers in a million judged",
          [this](const std::string& m) { return 1e6 * wrong_of(device_, m).share(); }, "none");
      pareto(
          "pareto-memory", "Time against memory", "MiB that tracing reads",
          [this](const std::string& m) { return memory(m) / (1024.0 * 1024.0); }, std::nullopt);
      gain();
      build_against_trace();
      break_evens();
    }
    work("boxes", "Boxes tested per ray", "boxes per ray, each ray by itself",
         [](const TraceRow& row) { return row.boxes_per_ray; });
    work("triangles", "Triangles tested per ray", "triangles per ray, each ray by itself",
         [](const TraceRow& row) { return row.triangles_per_ray; });
    for (const std::string& kind : predicted_kinds()) prediction(kind);
    errors();
    return std::move(charts_);
  }

 private:
  void add(const std::string& name, const std::string& title, const std::string& note, const Svg& svg,
           const std::string& attributes = "") {
    charts_.push_back({name, title, note, svg.inside(title, attributes),
                       svg.file(title + ", " + report_.scene_name), !attributes.empty()});
  }

  [[nodiscard]] const Line* base() const {
    const auto found =
        std::find_if(lines_.begin(), lines_.end(), [](const Line& line) { return line.method == kBaseline; });
    return found == lines_.end() ? nullptr : &*found;
  }

  [[nodiscard]] double memory(const std::string& method) const {
    for (const BuildRow& row : device_.builds)
      if (row.method == method) return static_cast<double>(row.bytes);
    return 0.0;
  }

  // Time over the baseline's: it lies between the ratios of builds and of traces whatever the number of rays,
  // so that the axis can stand still while points move.
  void pareto(const std::string& name, const std::string& title, const std::string& y_label,
              const std::function<double(const std::string&)>& y, const std::optional<std::string>& zero) {
    if (base() == nullptr) return;
    Scatter s;
    s.x_label = "time of build and rays, over that of " + std::string(kBaseline);
    s.y_label = y_label;
    s.front = true;
    s.even = 1.0;
    s.zero_label = zero;
    std::vector<std::string> kinds = kinds_of(device_);
    kinds.emplace_back(kAllKinds);
    for (const std::string& kind : kinds) {
      const auto lines = lines_of(device_, kind, report_.clock);
      for (const Line& b : lines) {
        if (b.method != kBaseline) continue;
        for (const Line& line : lines) {
          s.x_range.push_back(line.build_s / b.build_s);
          s.x_range.push_back(line.ray_s / b.ray_s);
        }
      }
    }
    const double whole = base()->build_s + kFirstRays * base()->ray_s;
    for (const Line& line : lines_) {
      const double time = line.build_s + kFirstRays * line.ray_s;
      s.dots.push_back({letter_of(device_, line.method), group_of(device_, line.method), time / whole,
                        y(line.method), line.method});
    }
    std::string attributes;
    const Svg svg = draw(s, &attributes);
    add(name, title,
        "Left and down is better; the line joins methods that no other beats in both. The slider above moves "
        "them: few rays, "
        "and the build decides; many, and tracing does.",
        svg, attributes);
  }

  void gain() {
    RowPlot plot;
    plot.x_label = "times as fast as " + std::string(kBaseline);
    plot.series = kinds_of(device_);
    plot.spans = true;
    plot.even = 1.0;
    for (const Line& line : lines_) {
      if (line.method == kBaseline) continue;
      RowPlot::Row row{letter_of(device_, line.method) + "  " + line.method, {}, ""};
      for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Spread s = trace_gain(device_, kBaseline, line.method, plot.series[i], report_.clock);
        if (s.count == 0) continue;
        row.marks.push_back({i, s.median, s.min, s.max,
                             plot.series[i] + ": " + fixed(s.median, 2) + " (" + fixed(s.min, 2) + " to " +
                                 fixed(s.max, 2) + "), " + std::to_string(s.count) + " rounds"});
      }
      plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    add("gain", "Speed of tracing beside " + std::string(kBaseline),
        "Right of the dashed line is faster. Marks are medians of paired rounds, bars reach from the least "
        "to the greatest: "
        "one that crosses the line claims nothing.",
        draw(plot));
  }

  void build_against_trace() {
    Scatter s;
    s.x_label = "build, ms";
    s.y_label = "trace, ns per ray, mean over kinds";
    s.front = true;
    for (const Line& line : lines_)
      s.dots.push_back(
          {letter_of(device_, line.method), group_of(device_, line.method), 1e3 * line.build_s,
           1e9 * line.ray_s,
           line.method + ": " + time_text(line.build_s) + ", " + time_text(line.ray_s) + " per ray"});
    add("build-trace", "Build time against trace time", "Left and down is better.", draw(s));
  }

  void break_evens() {
    RowPlot plot;
    plot.x_label = "rays per build from which on it is done sooner";
    plot.series = kinds_of(device_);
    for (const Line& own : lines_) {
      if (own.method == kBaseline) continue;
      RowPlot::Row row{letter_of(device_, own.method) + "  " + own.method, {}, ""};
      std::vector<std::string> always;
      std::vector<std::string> never;
      for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const auto lines = lines_of(device_, plot.series[i], report_.clock);
        const auto line = [&](const std::string& name) {
          return *std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.method == name; });
        };
        const auto even = break_even(line(kBaseline), line(own.method));
        if (!even) {
          never.push_back(plot.series[i]);
        } else if (*even == 0.0) {
          always.push_back(plot.series[i]);
        } else {
          row.marks.push_back({i, *even, 0.0, 0.0, plot.series[i] + ": " + count_text(*even) + " rays"});
        }
      }
      const auto all = plot.series.size();
      if (always.size() == all) {
        row.remark = "at once";
      } else if (never.size() == all) {
        row.remark = "never";
      } else {
        if (!never.empty()) row.remark = "never: " + list_text(never);
        if (!always.empty())
          row.remark += (row.remark.empty() ? "at once: " : "; at once: ") + list_text(always);
        if (row.remark.size() > 34)
          row.remark = std::to_string(never.size()) + " of " + std::to_string(all) + " kinds never";
      }
      plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    add("break-even", "Rays that pay a build back",
        "Medians, whatever their spread: the chart above says which gains are sure. Never: it builds and "
        "traces slower, or is "
        "ahead for the first rays only.",
        draw(plot));
  }

  void work(const std::string& name, const std::string& title, const std::string& label,
            const std::function<double(const TraceRow&)>& value) {
    RowPlot plot;
    plot.x_label = label;
    plot.series = kinds_of(device_);
    for (const MethodFacts& method : device_.methods) {
      RowPlot::Row row{letter_of(device_, method.name) + "  " + method.name, {}, ""};
      for (const TraceRow& trace : device_.traces) {
        if (trace.method != method.name || !trace.counted || value(trace) <= 0.0) continue;
        const auto series =
            std::find(plot.series.begin(), plot.series.end(), trace.kind) - plot.series.begin();
        row.marks.push_back({static_cast<std::size_t>(series), value(trace), 0.0, 0.0,
                             trace.kind + ": " + significant(value(trace), 4)});
      }
      if (!row.marks.empty()) plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    add(name, title, "Exact counts, the same on every machine.", draw(plot));
  }

  [[nodiscard]] std::vector<std::string> predicted_kinds() const {
    std::vector<std::string> kinds;
    for (const PredictionRow& row : device_.predictions)
      if (std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end()) kinds.push_back(row.kind);
    return kinds;
  }

  void prediction(const std::string& kind) {
    Scatter s;
    s.x_label = "predicted cost of a ray";
    s.y_label = "measured cost, " + kind + " rays";
    s.diagonal = true;
    std::uint64_t rays = 0;
    for (const PredictionRow& row : device_.predictions) {
      if (row.kind != kind || row.predicted <= 0.0 || row.measured <= 0.0) continue;
      rays = row.rays;
      s.dots.push_back({letter_of(device_, row.method), group_of(device_, row.method), row.predicted,
                        row.measured,
                        row.method + ": predicted " + significant(row.predicted) + ", measured " +
                            significant(row.measured) + " ± " + significant(row.standard_error)});
    }
    if (s.dots.empty()) return;
    add("prediction-" + file_word(kind), "Predicted and measured cost, " + kind + " rays",
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
    for (const MethodFacts& method : device_.methods) {
      Group own{{method.name}, {}, 0};
      for (const AccuracyRow& row : device_.accuracies) {
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
    add("errors", "How far off distances are",
        "Of hits on the right triangle, against exact arithmetic, in units of the last place of a float. "
        "Further left and "
        "lower is better.",
        draw(plot));
  }

  const Report& report_;
  const DeviceReport& device_;
  std::vector<Line> lines_;
  std::vector<Chart> charts_;
};

std::size_t place_of(const DeviceReport& device, const std::string& method) {
  const auto found = std::find_if(device.methods.begin(), device.methods.end(),
                                  [&](const MethodFacts& facts) { return facts.name == method; });
  return static_cast<std::size_t>(found - device.methods.begin());
}

}  // namespace

std::vector<Chart> charts_of(const Report& report, const DeviceReport& device) {
  return Charts(report, device).all();
}

std::string letter_of(const DeviceReport& device, const std::string& method) {
  const std::size_t place = place_of(device, method);
  const std::string letter(1, static_cast<char>('A' + place % 26));
  return place < 26 ? letter : letter + std::to_string(place / 26);
}

unsigned group_of(const DeviceReport& device, const std::string& method) {
  const std::size_t place = place_of(device, method);
  return place < device.methods.size() ? static_cast<unsigned>(device.methods[place].family) : 0;
}

}  // namespace gnomon::compare
