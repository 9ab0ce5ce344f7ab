// Charts as they are drawn one after another. Not public. Feeds charts.cpp.
#pragma once

#include <string>
#include <vector>

#include "gnomon/compare/charts.h"
#include "gnomon/compare/svg.h"

namespace gnomon::compare {

struct ChartList {
  const Report& report;
  const DeviceReport& device;
  std::vector<Chart> charts;
  // attributes: what the page's script needs to move dots; empty: the chart stands still.
  void add(const std::string& name, const std::string& title, const std::string& note, const Svg& svg,
           const std::string& attributes = "");
};

// Time against accuracy and memory, gains, builds against traces, break-even.
void add_time_charts(ChartList& list);
// Boxes and triangles a ray, predictions, errors.
void add_work_charts(ChartList& list);
// Times by triangles, gains by light.
void add_scene_charts(ChartList& list);

}  // namespace gnomon::compare
