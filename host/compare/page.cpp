#include "gnomon/compare/page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gnomon/base/stats.h"
#include "gnomon/compare/analysis.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/device_page.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/page_parts.h"
#include "gnomon/compare/report_json.h"
#include "gnomon/compare/svg.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

// Inside a script element: nothing in it may end that.
std::string script_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos; at += 5)
    text.replace(at, 4, "\\u003c!--");
  return text;
}

// One method on every device: what a portable kernel is worth where.
std::string devices_table(const Report& report) {
  if (report.devices.size() < 2) return "";
  const std::vector<std::string> kinds = kinds_of(report.devices.front());
  std::string head = "<th class=\"name\">device</th><th>tree</th><th>wrong</th><th>build</th>";
  for (const std::string& kind : kinds) head += "<th>" + escaped(kind) + "</th>";
  const auto gain = [&](const DeviceReport& device, const std::string& kind) {
    const Spread s = across_gain(report, device, kind);
    return s.count == 0 ? std::string("–")
                        : significant(s.median) + "<small>" + significant(s.min) + " to " +
                              significant(s.max) + "</small>";
  };
  std::string rows;
  for (const DeviceReport& device : report.devices) {
    rows += "<tr>" + html_cell(escaped(device.name) + "<small>" +
                                   escaped(device.platform + ", driver " + device.driver) + "</small>",
                               "name");
    const auto build = std::find_if(device.builds.begin(), device.builds.end(),
                                    [](const BuildRow& row) { return row.method == kBaseline; });
    const Wrong wrong = wrong_of(device, kBaseline);
    rows += html_cell(build == device.builds.end() ? "–" : escaped(build->tree_hash.substr(0, 8)));
    rows += html_cell(
        wrong.judged == 0 ? "–" : std::to_string(wrong.wrong) + " of " + std::to_string(wrong.judged));
    rows += html_cell(gain(device, ""));
    for (const std::string& kind : kinds) rows += html_cell(gain(device, kind));
    rows += html_cell(escaped(advise(report, device).best)) + "</tr>\n";
  }
  return "<h2>Over devices</h2>\n<div class=\"wide\"><table class=\"devices\">\n<caption>" +
         std::string(kBaseline) +
         ": times as fast as the first device, in rounds that took turns (median, least to greatest); the "
         "tree's "
         "hash, which is to be the same everywhere; last, what to use there for many "
         "rays</caption>\n<thead><tr>" +
         head + "<th>use</th></tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table></div>\n";
}

// The rows, without the pictures, which are on the page already.
std::string data_of(const Report& report) {
  Report bare = report;
  for (DeviceReport& device : bare.devices) device.pictures.png.clear();
  return to_json_text(bare);
}

std::string repeat_section(const Report& report) {
  std::string facts = html_fact("commit", report.commit) + html_fact("version", report.version) +
                      html_fact("scene", report.scene + ", " + std::to_string(report.triangles) +
                                             " triangles, hash " + report.scene_hash);
  for (const DeviceReport& device : report.devices) facts += DevicePage(report, device).facts();
  for (const auto& [name, value] : report.options) facts += html_fact(name, value);
  facts += html_fact("clock", report.clock == "cpu" ? "processor time of all threads" : "waiting time");
  return "<h2>To repeat it</h2>\n<pre>" + html_command(report.command) + "</pre>\n<dl>\n" + facts +
         "</dl>\n<p class=\"soft\">Rounds take turns: in each, every method runs once next to the others, "
         "and every other "
         "round runs backwards; a ratio is of times in one round. Rays and their answers stay in the "
         "device's memory while "
         "ours is timed; a peer's ray structures are filled inside its time. Builds are from triangles in "
         "host memory until "
         "rays can be traced. All rows are in this file, as JSON, in the element with the id rows.</p>\n";
}

}  // namespace

std::string report_page(const Report& report) {
  const std::string title = "gnomon compare: " + report.scene_name;
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
      "dark\">\n<link "
      "rel=\"icon\" href=\"data:,\">\n<title>" +
      escaped(title) + "</title>\n<style>" + std::string(page_style()) + chart_style() +
      "</style>\n</head>\n<body>\n<h1>" + escaped(title) + "</h1>\n";
  if (!report.complete())
    out +=
        "<p class=\"warn\">This report is not complete: it was interrupted. The same command goes on from "
        "what is there.</p>\n";
  out += devices_table(report);
  Json data{{"baseline", kBaseline}, {"devices", Json::array()}};
  for (std::size_t i = 0; i < report.devices.size(); ++i) {
    const DevicePage page(report, report.devices[i]);
    out += "<section id=\"device-" + std::to_string(i) + "\">\n";
    if (report.devices.size() > 1) out += "<h2>" + escaped(report.devices[i].name) + "</h2>\n";
    out += page.advice() + page.body() + "</section>\n";
    data["devices"].push_back({{"name", report.devices[i].name}, {"lines", page.lines()}});
  }
  out += repeat_section(report);
  out += "<script type=\"application/json\" id=\"lines\">" + script_safe(data.dump()) + "</script>\n";
  out += "<script type=\"application/json\" id=\"rows\">" + script_safe(data_of(report)) + "</script>\n";
  return out + "<script>\n" + std::string(page_script()) + "</script>\n</body>\n</html>\n";
}

std::vector<std::pair<std::string, std::string>> chart_files(const Report& report) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t i = 0; i < report.devices.size(); ++i) {
    const std::string number =
        report.devices.size() > 1 ? std::string("-").append(std::to_string(i + 1)) : std::string();
    for (Chart& chart : charts_of(report, report.devices[i]))
      files.emplace_back(chart.name + number, std::move(chart.file));
  }
  return files;
}

}  // namespace gnomon::compare
