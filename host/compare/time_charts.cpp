// Charts of what methods' rounds took.
#include <algorithm>
#include <functional>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/chart_list.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

class TimeCharts {
 public:
  explicit TimeCharts(ChartList& list)
      : list_(list), lines_(lines_of(list.device, kAllKinds, list.report.clock)) {}

  void all() {
    if (lines_.empty()) return;
    pareto(
        "pareto-accuracy", "Time against accuracy", "wrong answers in a million judged",
        [this](const std::string& m) { return 1e6 * wrong_of(list_.device, m).share(); }, "none");
    pareto(
        "pareto-memory", "Time against memory", "MiB that tracing reads",
        [this](const std::string& m) { return memory(m) / (1024.0 * 1024.0); }, std::nullopt);
    gain();
    build_against_trace();
    break_evens();
  }

 private:
  [[nodiscard]] const Line* base() const {
    const auto found =
        std::find_if(lines_.begin(), lines_.end(), [](const Line& line) { return line.method == kBaseline; });
    return found == lines_.end() ? nullptr : &*found;
  }

  [[nodiscard]] double memory(const std::string& method) const {
    for (const BuildRow& row : list_.device.builds)
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
    std::vector<std::string> kinds = kinds_of(list_.device);
    kinds.emplace_back(kAllKinds);
    for (const std::string& kind : kinds) {
      const auto lines = lines_of(list_.device, kind, list_.report.clock);
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
      s.dots.push_back({letter_of(list_.device, line.method), group_of(list_.device, line.method),
                        time / whole, y(line.method), line.method});
    }
    std::string attributes;
    const Svg svg = draw(s, &attributes);
    list_.add(
        name, title,
        "Left and down is better; the line joins methods that no other beats in both. The slider above moves "
        "them: few rays, "
        "and the build decides; many, and tracing does.",
        svg, attributes);
  }

  void gain() {
    RowPlot plot;
    plot.x_label = "times as fast as " + std::string(kBaseline);
    plot.series = kinds_of(list_.device);
    plot.spans = true;
    plot.even = 1.0;
    for (const Line& line : lines_) {
      if (line.method == kBaseline) continue;
      RowPlot::Row row{letter_of(list_.device, line.method) + "  " + line.method, {}, ""};
      for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Spread s = trace_gain(list_.device, kBaseline, line.method, plot.series[i], list_.report.clock);
        if (s.count == 0) continue;
        row.marks.push_back({i, s.median, s.min, s.max,
                             plot.series[i] + ": " + fixed(s.median, 2) + " (" + fixed(s.min, 2) + " to " +
                                 fixed(s.max, 2) + "), " + std::to_string(s.count) + " rounds"});
      }
      plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    list_.add(
        "gain", "Speed of tracing beside " + std::string(kBaseline),
        "Right of the dashed line is faster. Marks are medians of paired rounds, bars reach from the least "
        "to the greatest: "
        "one that crosses the line claims nothing. Where rays take less than a twentieth of a second, a "
        "round "
        "traces them several times.",
        draw(plot));
  }

  void build_against_trace() {
    Scatter s;
    s.x_label = "build, ms";
    s.y_label = "trace, ns per ray, mean over kinds";
    s.front = true;
    for (const Line& line : lines_)
      s.dots.push_back(
          {letter_of(list_.device, line.method), group_of(list_.device, line.method), 1e3 * line.build_s,
           1e9 * line.ray_s,
           line.method + ": " + time_text(line.build_s) + ", " + time_text(line.ray_s) + " per ray"});
    list_.add("build-trace", "Build time against trace time", "Left and down is better.", draw(s));
  }

  void break_evens() {
    RowPlot plot;
    plot.x_label = "rays per build from which on it is done sooner";
    plot.series = kinds_of(list_.device);
    for (const Line& own : lines_) {
      if (own.method == kBaseline) continue;
      RowPlot::Row row{letter_of(list_.device, own.method) + "  " + own.method, {}, ""};
      std::vector<std::string> always;
      std::vector<std::string> never;
      for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const auto lines = lines_of(list_.device, plot.series[i], list_.report.clock);
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
        // It shares the line with the name: some 45 letters of the usual fonts.
        if (row.name.size() + row.remark.size() > 45)
          row.remark = std::to_string(never.size()) + " of " + std::to_string(all) + " kinds never";
      }
      plot.rows.push_back(std::move(row));
    }
    if (plot.rows.empty()) return;
    list_.add("break-even", "Rays that pay a build back",
              "Medians, whatever their spread: the first of these charts says which gains are sure. Never: "
              "it builds and "
              "traces slower, or is "
              "ahead for the first rays only.",
              draw(plot));
  }

  ChartList& list_;
  std::vector<Line> lines_;
};

}  // namespace

void add_time_charts(ChartList& list) {
  TimeCharts(list).all();
}

}  // namespace gnomon::compare
