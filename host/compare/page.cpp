#include "gnomon/compare/page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "gnomon/base/stats.h"
#include "gnomon/compare/analysis.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/page_parts.h"
#include "gnomon/compare/report_json.h"
#include "gnomon/compare/svg.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastRaysLog = 3.0;
constexpr double kMostRaysLog = 12.0;

std::string element(const std::string& name, const std::string& content, const std::string& classes = "") {
  return "<" + name + (classes.empty() ? "" : " class=\"" + classes + "\"") + ">" + content + "</" + name +
         ">\n";
}

std::string cell(const std::string& content, const std::string& classes = "") {
  return "<td" + (classes.empty() ? "" : " class=\"" + classes + "\"") + ">" + content + "</td>";
}

// Inside a script element: nothing in it may end that.
std::string script_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  for (std::size_t at = 0; (at = text.find("<!--", at)) != std::string::npos; at += 5)
    text.replace(at, 4, "\\u003c!--");
  return text;
}

std::string picture(const std::string& png, const std::string& alternative) {
  return "<img alt=\"" + escaped(alternative) + "\" src=\"data:image/png;base64," + to_base64(png) + "\">";
}

class DevicePage {
 public:
  DevicePage(const Report& report, const DeviceReport& device) : report_(report), device_(device) {}

  [[nodiscard]] std::string advice() const {
    std::string out;
    for (const std::string& sentence : advise(report_, device_).all())
      if (!sentence.empty()) out += element("p", escaped(sentence));
    return "<div class=\"advice\">\n" + out + "</div>\n";
  }

  [[nodiscard]] std::string body() const {
    const std::vector<Chart> charts = charts_of(report_, device_);
    std::string out;
    if (std::any_of(charts.begin(), charts.end(), [](const Chart& chart) { return chart.moves; })) {
      out += "<h2>Time, accuracy and memory</h2>\n<div>\n" + control() + "<div class=\"charts two\">\n";
      for (const Chart& chart : charts)
        if (chart.moves) out += figure(chart);
      out += "</div>\n" + table() + "</div>\n";
    } else {
      out += table();
    }
    out += "<h2>What each method gains and does</h2>\n<div class=\"charts\">\n";
    for (const Chart& chart : charts)
      if (!chart.moves) out += figure(chart);
    return out + "</div>\n" + pictures() + left_out();
  }

  // The script's lines, by kind.
  [[nodiscard]] Json lines() const {
    Json out = Json::object();
    std::vector<std::string> kinds = kinds_of(device_);
    kinds.insert(kinds.begin(), kAllKinds);
    for (const std::string& kind : kinds) {
      Json& of_kind = out[kind] = Json::array();
      for (const Line& line : lines_of(device_, kind, report_.clock))
        of_kind.push_back({{"letter", letter_of(device_, line.method)},
                           {"method", line.method},
                           {"build_s", line.build_s},
                           {"ray_s", line.ray_s}});
    }
    return out;
  }

  [[nodiscard]] std::string facts() const {
    return fact("device", device_.name + " (" + device_.platform + ")") + fact("driver", device_.driver) +
           fact("OpenCL", device_.opencl) + fact("compute units", std::to_string(device_.compute_units));
  }

  static std::string fact(const std::string& name, const std::string& value) {
    return "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
  }

 private:
  static std::string figure(const Chart& chart) {
    return "<figure id=\"" + chart.name + "\">\n<h3>" + escaped(chart.title) + "</h3>\n" + chart.inside +
           "<figcaption>" + escaped(chart.note) + "</figcaption>\n</figure>\n";
  }

  [[nodiscard]] std::string control() const {
    std::string out =
        "<div class=\"control\">\n<label>rays of <select aria-label=\"kind of rays\"><option "
        "value=\"all\">all "
        "kinds, as many of each</option>";
    for (const std::string& kind : kinds_of(device_))
      out += "<option value=\"" + escaped(kind) + "\">" + escaped(kind) + "</option>";
    return out + "</select></label>\n<input type=\"range\" aria-label=\"rays per build\" min=\"" +
           fixed(kLeastRaysLog, 0) + "\" max=\"" + fixed(kMostRaysLog, 0) + "\" step=\"0.05\" value=\"" +
           fixed(std::log10(kFirstRays), 0) + "\">\n<output>" + count_text(kFirstRays) +
           " rays after one build</output>\n</div>\n";
  }

  // What letters stand for, and figures of each.
  [[nodiscard]] std::string table() const {
    std::string rows;
    const std::vector<Line> lines = lines_of(device_, kAllKinds, report_.clock);
    double base_time = 0.0;
    for (const Line& line : lines)
      if (line.method == kBaseline) base_time = line.build_s + kFirstRays * line.ray_s;
    for (const MethodFacts& method : device_.methods) {
      const auto line =
          std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.method == method.name; });
      const auto build = std::find_if(device_.builds.begin(), device_.builds.end(),
                                      [&](const BuildRow& r) { return r.method == method.name; });
      if (build == device_.builds.end()) continue;
      const Wrong wrong = wrong_of(device_, method.name);
      const double time = line == lines.end() ? 0.0 : line->build_s + kFirstRays * line->ray_s;
      const std::string letter = letter_of(device_, method.name);
      const Spread seconds = spread_of(seconds_of(build->rounds, report_.clock));
      rows += "<tr data-letter=\"" + letter + "\">" + cell(letter) +
              cell(escaped(method.name) + "<small>" + escaped(method.what) +
                       (method.options.empty() ? "" : ": <code>" + escaped(method.options) + "</code>") +
                       "</small>",
                   "name") +
              cell(line == lines.end() ? "–" : time_text(time), "time") +
              cell(line == lines.end() || base_time == 0.0 ? "–" : fixed(time / base_time, 2), "ratio") +
              cell(seconds.count == 0 ? "–" : time_text(seconds.median)) +
              cell(line == lines.end() ? "–" : time_text(line->ray_s)) +
              cell(bytes_text(static_cast<double>(build->bytes))) +
              cell(build->sah_cost > 0.0 ? significant(build->sah_cost, 4) : "–") +
              cell(wrong.judged == 0 ? "–"
                                     : std::to_string(wrong.wrong) + " of " + std::to_string(wrong.judged)) +
              "</tr>\n";
    }
    return "<h3>What the letters stand for</h3>\n<div class=\"wide\"><table>\n<thead><tr><th></th><th "
           "class=\"name\">method</th><th>build and rays</th><th>over " +
           std::string(kBaseline) +
           "</th><th>build</th><th>a ray</th><th>memory</th><th>SAH "
           "cost</th><th>wrong</th></tr></thead>\n<tbody>\n" +
           rows +
           "</tbody>\n</table></div>\n<p class=\"soft\">Marks: circles for surface area heuristics, squares "
           "for "
           "heuristics of one source of rays, diamonds for mixtures, triangles for peers. Times are medians, "
           "of " +
           (report_.clock == "cpu" ? "processor time of all threads" : "waiting time") +
           "; a ray's is the mean over the kinds. Wrong: a hit lost, a false one, one more than 4 ulp off, "
           "or one on a "
           "triangle that is not there, against exact arithmetic.</p>\n";
  }

  [[nodiscard]] std::string pictures() const {
    const Pictures& p = device_.pictures;
    if (p.png.empty()) return "";
    std::string out =
        "<h2>Where the work is</h2>\n<p class=\"soft\">Boxes that the ray through each pixel tests, from "
        "dark "
        "(none) to pale (" +
        fixed(p.white, 0) + " and more), one scale for all.</p>\n<div class=\"maps\">\n";
    const auto add = [&](const std::string& name, const std::string& caption) {
      const auto png = p.png.find(name);
      if (png == p.png.end()) return;
      out += "<figure>" + picture(png->second, name.empty() ? "the scene" : "boxes tested, " + name) +
             "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
    };
    add("", "The scene: " + report_.scene_name);
    for (const MethodFacts& method : device_.methods) {
      const auto mean = p.mean.find(method.name);
      if (mean != p.mean.end())
        add(method.name, letter_of(device_, method.name) + "  " + method.name + ": " +
                             fixed(mean->second, 1) + " boxes a ray");
    }
    return out + "</div>\n";
  }

  [[nodiscard]] std::string left_out() const {
    std::string items;
    for (const LeftOut& left : device_.left_out)
      items += element(
          "li", escaped((left.method.empty() ? "" : left.method + ", ") + left.what + ": " + left.reason));
    if (!report_.peer_note.empty()) items += element("li", escaped(report_.peer_note));
    return items.empty() ? "" : "<h2>What was left out</h2>\n<ul>\n" + items + "</ul>\n";
  }

  const Report& report_;
  const DeviceReport& device_;
};

// One method on every device: what a portable kernel is worth where.
std::string devices_table(const Report& report) {
  if (report.devices.size() < 2) return "";
  const std::vector<std::string> kinds = kinds_of(report.devices.front());
  std::string head = "<th class=\"name\">device</th><th>build</th>";
  for (const std::string& kind : kinds) head += "<th>" + escaped(kind) + "</th>";
  std::string rows;
  for (const DeviceReport& device : report.devices) {
    rows += "<tr>" + cell(escaped(device.name) + "<small>" +
                              escaped(device.platform + ", driver " + device.driver) + "</small>",
                          "name");
    const auto lines = lines_of(device, kAllKinds, report.clock);
    const auto base =
        std::find_if(lines.begin(), lines.end(), [](const Line& l) { return l.method == kBaseline; });
    rows += cell(base == lines.end() ? "–" : time_text(base->build_s));
    for (const std::string& kind : kinds) {
      std::string speed = "–";
      for (const Line& line : lines_of(device, kind, report.clock))
        if (line.method == kBaseline && line.ray_s > 0.0) speed = significant(1e-6 / line.ray_s);
      rows += cell(speed);
    }
    rows += cell(escaped(advise(report, device).best)) + "</tr>\n";
  }
  return "<h2>Over devices</h2>\n<div class=\"wide\"><table>\n<caption>" + std::string(kBaseline) +
         ": build time, and millions of rays a second by kind; last, what to use for many "
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
  std::string facts = DevicePage::fact("commit", report.commit) +
                      DevicePage::fact("version", report.version) +
                      DevicePage::fact("scene", report.scene + ", " + std::to_string(report.triangles) +
                                                    " triangles, hash " + report.scene_hash);
  for (const DeviceReport& device : report.devices) facts += DevicePage(report, device).facts();
  for (const auto& [name, value] : report.options) facts += DevicePage::fact(name, value);
  facts +=
      DevicePage::fact("clock", report.clock == "cpu" ? "processor time of all threads" : "waiting time");
  return "<h2>To repeat it</h2>\n<pre>" + escaped(report.command) + "</pre>\n<dl>\n" + facts +
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
