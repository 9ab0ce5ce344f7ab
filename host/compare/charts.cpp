#include "gnomon/compare/charts.h"

#include <algorithm>

#include "gnomon/compare/chart_list.h"

namespace gnomon::compare {
namespace {

std::size_t place_of(const DeviceReport& device, const std::string& method) {
  const auto found = std::find_if(device.methods.begin(), device.methods.end(),
                                  [&](const MethodFacts& facts) { return facts.name == method; });
  return static_cast<std::size_t>(found - device.methods.begin());
}

}  // namespace

void ChartList::add(const std::string& name, const std::string& title, const std::string& note,
                    const Svg& svg, const std::string& attributes) {
  charts.push_back({name, title, note, svg.inside(title, attributes),
                    svg.file(title + ", " + report.scene_name), !attributes.empty()});
}

std::vector<Chart> charts_of(const Report& report, const DeviceReport& device) {
  ChartList list{report, device, {}};
  add_time_charts(list);
  add_work_charts(list);
  add_scene_charts(list);
  return std::move(list.charts);
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
