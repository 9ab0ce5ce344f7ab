// Charts of what depends on the scene: how times grow with it, and what trees for one light save there.
#include <algorithm>
#include <functional>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/chart_list.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

void grow(ChartList& list, const std::string& name, const std::string& title, const std::string& label,
          const std::string& note, bool guide, const std::function<double(const SizeRow&)>& value) {
  CurvePlot plot;
  plot.x_label = "triangles";
  plot.y_label = label;
  plot.straight = true;
  for (const SizeRow& row : list.device.sizes) {
    const double at = value(row);
    if (!(at > 0.0)) continue;
    auto curve = std::find_if(plot.curves.begin(), plot.curves.end(),
                              [&](const CurvePlot::Curve& c) { return c.name == row.method; });
    if (curve == plot.curves.end()) curve = plot.curves.insert(plot.curves.end(), {row.method, {}});
    curve->points.emplace_back(static_cast<double>(row.triangles), at);
  }
  if (plot.curves.empty()) return;
  const auto& base = plot.curves.front().points;
  if (guide && base.size() > 1)
    plot.guide = {base.front(),
                  {base.back().first, base.front().second * base.back().first / base.front().first}};
  const bool thinned = list.device.sizes.front().thinned;
  list.add(
      name, title,
      note + (thinned
                  ? " Smaller sizes are this scene with triangles left out evenly: it has holes then, and "
                    "rays go further."
                  : " Smaller sizes are the same generator's."),
      draw(plot));
}

void areas(ChartList& list) {
  const std::vector<AreaRow>& rows = list.device.areas;
  RowPlot plot;
  plot.x_label = "times less work than " + std::string(kBaseline);
  plot.spans = true;
  plot.even = 1.0;
  for (const AreaRow& base : rows) {
    if (base.method != kBaseline || !(base.cost() > 0.0)) continue;
    RowPlot::Row line{base.area, {}, ""};
    for (const AreaRow& row : rows) {
      if (row.area != base.area || row.method == kBaseline || !(row.cost() > 0.0)) continue;
      auto series = std::find(plot.series.begin(), plot.series.end(), row.method);
      if (series == plot.series.end()) series = plot.series.insert(series, row.method);
      const double gain = base.cost() / row.cost();
      line.marks.push_back({static_cast<std::size_t>(series - plot.series.begin()), gain, 0.0, 0.0,
                            row.method + ": " + fixed(gain, 2) + ", " + significant(base.cost(), 4) +
                                " against " + significant(row.cost(), 4)});
    }
    plot.rows.push_back(std::move(line));
  }
  if (plot.rows.empty()) return;
  list.add("areas", "Gain by light",
           "Rays even over each light's area, closest hit, through trees made for that light alone: pah by "
           "projected "
           "areas, pah+sah half and half with surface area, auto what a plan keeps. Counts: 1.0 a box, 1.2 a "
           "triangle. Right of the dashed line is less work.",
           draw(plot));
}

}  // namespace

void add_scene_charts(ChartList& list) {
  const std::string& clock = list.report.clock;
  grow(list, "size-build", "Build time by triangles", "build, ms",
       "Medians. Along the dashed line time is proportional to triangles.", true,
       [&](const SizeRow& row) { return 1e3 * spread_of(seconds_of(row.build, clock)).median; });
  const std::string kind = list.device.sizes.empty() ? std::string() : list.device.sizes.front().kind;
  grow(list, "size-trace", "Trace time by triangles", "ns per ray, " + kind, "Medians.", false,
       [&](const SizeRow& row) {
         return 1e9 * spread_of(seconds_of(row.trace, clock)).median / static_cast<double>(row.rays);
       });
  areas(list);
}

}  // namespace gnomon::compare
