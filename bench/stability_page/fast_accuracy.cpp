#include "fast_accuracy.h"

namespace stability_page {
namespace {

using page::head_of;
using page::line_of;
using page::number;

std::string cost_line(const std::string& flavour, const std::string& kind, const Rows& rows) {
  Rows costs;
  std::vector<double> ratios;
  double worst = 0.0;
  for (const json& row : rows) {
    costs.push_back(row.at("cost"));
    worst = std::max(worst, row.at("cost").at("max_t_ulp").get<double>());
    if (row.contains("ratio")) ratios.push_back(row.at("ratio").at("median"));
  }
  std::string faster = "–";
  if (!ratios.empty()) {
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    faster = number(page::geomean(ratios), "%.2f") + " (" + number(*least, "%.2f") + "–" +
             number(*most, "%.2f") + ")";
  }
  return line_of({flavour, kind, std::to_string(rows.size()), faster, sum_of(costs, "hits"),
                  sum_of(costs, "lost"), sum_of(costs, "added"), sum_of(costs, "other_triangle"),
                  number(worst, "%.0f")});
}

}  // namespace

std::string fast_accuracy(const Rows& all) {
  Rows speeds;
  Rows hard;
  for (const json& row : all) (row.at("kind") == "speed" ? speeds : hard).push_back(row);
  std::string out =
      "\n## Fast accuracy\n\n`trace --accuracy fast` beside watertight tracing of the same rays in one "
      "process: how "
      "many times as fast, by process CPU time (geometric mean of batches' medians, least and most of "
      "them), and "
      "the hits that this costs. The last lines: the catalogue. Commit" +
      commits(all) + ", " + text_at(all.front(), "device") + ".\n" +
      head_of({"flavour", "rays of", "batches", "times as fast", "hits", "lost", "added",
               "of another triangle", "t off by, ulp"});
  const auto flavour_of = [](const json& row) { return text_at(row, "flavour"); };
  for (const auto& [flavour, rows] : grouped(speeds, flavour_of)) {
    for (const auto& [kind, some] : grouped(rows, [](const json& row) { return text_at(row, "rays_kind"); }))
      out += cost_line(flavour, kind, some);
    out += cost_line(flavour, "all kinds", rows);
  }
  for (const auto& [flavour, rows] : grouped(hard, flavour_of))
    out += cost_line(flavour, "the catalogue", rows);
  return out;
}

}  // namespace stability_page
