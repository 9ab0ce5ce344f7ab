#include "gnomon/compare/device_page.h"

#include <algorithm>
#include <cmath>

#include "gnomon/base/stats.h"
#include "gnomon/compare/analysis.h"
#include "gnomon/compare/base64.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastRaysLog = 3.0;
constexpr double kMostRaysLog = 12.0;

std::string picture(const std::string& png, const std::string& alternative) {
  return "<img alt=\"" + escaped(alternative) + "\" src=\"data:image/png;base64," + to_base64(png) + "\">";
}

// Text in which words that `keep` picks are not broken where a line ends, as browsers do behind hyphens.
// `keep` gets a word without the punctuation behind it.
template <typename Keep>
std::string unbroken(const std::string& text, Keep keep) {
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    const std::size_t letters = word.find_last_not_of(",.:;)") + 1;
    out += keep(word.substr(0, letters)) ? "<span class=\"whole\">" + escaped(word.substr(0, letters)) +
                                               "</span>" + escaped(word.substr(letters))
                                         : escaped(word);
    if (end < text.size()) out += ' ';
    from = end + 1;
  }
  return out;
}

bool is_option(const std::string& word) {
  return word.starts_with("--");
}

std::string figure(const Chart& chart) {
  return "<figure id=\"" + chart.name + "\">\n<h3>" + escaped(chart.title) + "</h3>\n" + chart.inside +
         "<figcaption>" + escaped(chart.note) + "</figcaption>\n</figure>\n";
}

}  // namespace

std::string html_element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">\n";
}

std::string html_cell(const std::string& content, const std::string& classes) {
  return "<td" + (classes.empty() ? "" : " class=\"" + classes + "\"") + ">" + content + "</td>";
}

std::string html_fact(const std::string& name, const std::string& value) {
  return "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
}

std::string html_command(const std::string& command) {
  constexpr std::size_t kMostWhole = 24;  // letters that a column of a phone holds
  std::string out;
  for (std::size_t from = 0; from < command.size();) {
    const std::size_t next = command.find(" -", from + 1);
    const std::string part = command.substr(from, std::min(next, command.size()) - from);
    if (part.size() <= kMostWhole) {
      out += "<span class=\"whole\">" + escaped(part) + "</span>";
    } else {
      out += unbroken(part, is_option);
    }
    from += part.size();
    if (from < command.size()) {
      out += ' ';
      ++from;
    }
  }
  return out;
}

std::string DevicePage::advice() const {
  const auto is_whole = [this](const std::string& word) {
    return is_option(word) || std::any_of(device_.methods.begin(), device_.methods.end(),
                                          [&](const MethodFacts& method) { return method.name == word; });
  };
  std::string out;
  for (const std::string& sentence : advise(report_, device_).all())
    if (!sentence.empty()) out += html_element("p", unbroken(sentence, is_whole));
  return "<div class=\"advice\">\n" + out + "</div>\n";
}

std::string DevicePage::body() const {
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
  return out + "</div>\n" + decisions() + pictures() + left_out();
}

// The script's lines, by kind.
Json DevicePage::lines() const {
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

std::string DevicePage::facts() const {
  return html_fact("device", device_.name + " (" + device_.platform + ")") +
         html_fact("driver", device_.driver) + html_fact("OpenCL", device_.opencl) +
         html_fact("compute units", std::to_string(device_.compute_units));
}

std::string DevicePage::control() const {
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
std::string DevicePage::table() const {
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
    rows +=
        "<tr data-letter=\"" + letter + "\">" + html_cell(letter) +
        html_cell(escaped(method.name) + "<small>" + unbroken(method.what, is_option) +
                      (method.options.empty() ? "" : ": <code>" + html_command(method.options) + "</code>") +
                      "</small>",
                  "name") +
        html_cell(line == lines.end() ? "–" : time_text(time), "time") +
        html_cell(line == lines.end() || base_time == 0.0 ? "–" : fixed(time / base_time, 2), "ratio") +
        html_cell(seconds.count == 0 ? "–" : time_text(seconds.median)) +
        html_cell(line == lines.end() ? "–" : time_text(line->ray_s)) +
        html_cell(bytes_text(static_cast<double>(build->bytes))) +
        html_cell(build->sah_cost > 0.0 ? significant(build->sah_cost, 4) : "–") +
        html_cell(wrong.judged == 0 ? "–"
                                    : std::to_string(wrong.wrong) + " of " + std::to_string(wrong.judged)) +
        "</tr>\n";
  }
  return "<h3>What the letters stand for</h3>\n<div class=\"wide\"><table>\n<thead><tr><th></th><th "
         "class=\"name\">method</th><th>build&nbsp;and rays</th><th>over " +
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

std::string DevicePage::pictures() const {
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
      add(method.name, letter_of(device_, method.name) + "  " + method.name + ": " + fixed(mean->second, 1) +
                           " boxes a ray");
  }
  return out + "</div>\n";
}

std::string DevicePage::left_out() const {
  std::string items;
  for (const LeftOut& left : device_.left_out)
    items += html_element(
        "li", escaped((left.method.empty() ? "" : left.method + ", ") + left.what + ": " + left.reason));
  if (!report_.peer_note.empty()) items += html_element("li", escaped(report_.peer_note));
  return items.empty() ? "" : "<h2>What was left out</h2>\n<ul>\n" + items + "</ul>\n";
}

// What a method that plans chose, and why.
std::string DevicePage::decisions() const {
  std::string rows;
  for (const DecisionRow& row : device_.decisions) {
    if (row.method.empty()) continue;
    // What stands behind it is prices in units, which gnomon plan explains.
    const std::string reason = row.reason.substr(0, row.reason.find(';'));
    rows += "<tr>" + html_cell(escaped(row.kind) + "<small>" + escaped(row.query) + " hit</small>", "name") +
            html_cell(escaped(row.kept) + "<small>" + escaped(reason) + "</small>", "name") +
            html_cell(significant(row.baseline_cost, 4)) + html_cell(significant(row.cost, 4)) +
            html_cell(row.baseline_cost > 0.0 ? fixed(row.cost / row.baseline_cost, 3) : "–") +
            html_cell(std::to_string(row.probes)) + html_cell(fixed(row.planning_share, 1)) + "</tr>\n";
  }
  if (rows.empty()) return "";
  return "<h2>What auto decided</h2>\n<div class=\"wide\"><table class=\"decisions\">\n<thead><tr><th "
         "class=\"name\">rays</th><th class=\"name\">tree kept</th><th>cost in sah</th><th>cost in "
         "it</th><th>ratio</th><th>probe rays</th><th>planning</th></tr></thead>\n<tbody>\n" +
         rows +
         "</tbody>\n</table></div>\n<p class=\"soft\">Costs are counts of a probe ray in the binary tree, "
         "1.0 a box and "
         "1.2 a triangle; sah is by surface area with subtrees moved, dearer to build than sah-balanced. "
         "Planning: "
         "work of choosing and building over that of building sah, part of auto's build time. A tree must "
         "repay "
         "itself over " +
         count_text(kPlannedRays) + " rays. gnomon plan says more.</p>\n";
}

}  // namespace gnomon::compare
