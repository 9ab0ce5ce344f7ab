// The page, its charts and the files beside it, as functions of a report.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/compare/axis.h"
#include "gnomon/compare/base64.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/report_json.h"
#include "gnomon/compare/words.h"
#include "support/sample_report.h"

using namespace gnomon::compare;
using Catch::Contains;
using gnomon::compare::test::sample_report;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

}  // namespace

TEST_CASE("the same report gives the same bytes, another report others") {
  const Report report = sample_report();
  CHECK(report_page(report) == report_page(sample_report()));
  CHECK(to_json_text(report) == to_json_text(sample_report()));
  Report other = report;
  other.devices[0].builds[1].rounds.wall_s[0] = 0.625;
  CHECK(report_page(other) != report_page(report));
}

TEST_CASE("a report comes back from its JSON as it was, and draws the same page") {
  const Report report = sample_report();
  const Report back = from_json_text(to_json_text(report), "there");
  CHECK(back == report);
  CHECK(report_page(back) == report_page(report));
  CHECK(to_csv(back) == to_csv(report));
}

TEST_CASE("each row of the JSON stands by itself") {
  const auto document = nlohmann::json::parse(to_json_text(sample_report()));
  CHECK(document.at("schema") == kSchema);
  std::set<std::string> names;
  for (const auto& row : document.at("devices").at(0).at("rows")) {
    CAPTURE(row.dump());
    for (const char* field : {"schema", "bench", "task", "name", "commit", "device", "driver", "scene",
                              "scene_hash", "triangles", "method"})
      REQUIRE(row.contains(field));
    REQUIRE(names.insert(row.at("name")).second);  // a name is one row's
    if (row.at("task") != "trace" || row.at("method") != "sah-best" || row.at("rays") != "primary") continue;
    REQUIRE(row.at("real_time") == 1e6);  // 1 s for 1000 rays, in ns
  }
  CHECK(names.size() == 4 * (1 + 2 + 2) + 3 * 2 + 4 + 3 + 1 + 1);
}

TEST_CASE("a report comes back from its rows, but for pictures and what a rerun needs") {
  Report report = sample_report();
  Report other = report;
  other.command = "another";
  const auto back = from_rows_text(to_rows_text(report) + to_rows_text(other), "there");
  REQUIRE(back.size() == 2);
  report.devices[0].pictures = other.devices[0].pictures = {};
  report.devices[0].done = other.devices[0].done = {};
  CHECK(back[0] == report);
  CHECK(back[1] == other);
  for (const char* text : {"{", R"({"bench": "spine", "schema": 1})",
                           R"({"bench": "compare", "schema": 1, "task": "build", "method": "m"})"}) {
    CAPTURE(text);
    REQUIRE_THROWS_WITH(from_rows_text(text, "old.jsonl"), Contains("old.jsonl, line 1"));
  }
}

TEST_CASE("a row's ratio is of the same round, the baseline's over its own") {
  std::size_t seen = 0;
  std::istringstream lines(to_rows_text(sample_report()));
  for (std::string line; std::getline(lines, line);) {
    const auto row = nlohmann::json::parse(line);
    CAPTURE(line);
    if (row.at("task") == "build" && row.at("method") == "sah-best") {
      REQUIRE(row.at("ratio") == nlohmann::json{{"median", 0.25}, {"min", 0.25}, {"max", 0.25}, {"n", 3}});
      ++seen;
    }
    if (row.at("task") == "trace" && row.at("method") == "sah-best" && row.at("rays") == "bounce") {
      REQUIRE(row.at("ratio") == nlohmann::json{{"median", 2.0}, {"min", 1.6}, {"max", 2.0}, {"n", 3}});
      ++seen;
    }
    if (row.at("task") == "size" && row.at("method") == "sah-fast") {
      REQUIRE(row.at("build_ratio").at("median") == 2.0);
      REQUIRE(row.at("trace_ratio").at("median") == 1.0);
      ++seen;
    }
  }
  CHECK(seen == 4);
}

TEST_CASE(
    "several devices are one table: their trees, their wrong answers, and ratios of rounds that took turns") {
  Report report = sample_report();
  report.devices.push_back(report.devices[0]);
  report.devices[1].name = "another";
  report.devices[0].across = {{"", 0, {{2.0, 3.0}, {2.0, 3.0}}}, {"primary", 1000, {{1.0, 1.0}, {1.0, 1.0}}}};
  report.devices[1].across = {{"", 0, {{4.0, 4.0}, {4.0, 4.0}}},
                              {"primary", 1000, {{8.0, 10.0}, {8.0, 10.0}}}};
  const std::string page = report_page(report);
  const std::size_t from = page.find("<table class=\"devices\">");
  REQUIRE(from != std::string::npos);
  const std::string table = page.substr(from, page.find("</table>", from) - from);
  CAPTURE(table);
  CHECK(count_of(table, "<tr>") == 3);
  CHECK(count_of(table, "<td>01234567</td>") == 2);
  CHECK(count_of(table, "<td>0 of 200</td>") == 2);
  CHECK_THAT(table,
             Contains("<td>0.625<small>0.500 to 0.750</small></td><td>0.113<small>0.100 to 0.125</small>"));
  CHECK_THAT(report_page(sample_report()), !Contains("class=\"devices\""));
  CHECK(from_rows_text(to_rows_text(report), "there").at(0).devices.at(1).across == report.devices[1].across);
}

TEST_CASE("every decision of a plan is on the page, with its reason and what planning cost") {
  const std::string page = report_page(sample_report());
  CHECK_THAT(page, Contains("What auto decided") && Contains("sah-mix<small>10 % &lt;cheaper&gt;</small>") &&
                       Contains("<td>0.900</td>") && Contains("<td>4.5</td>"));
  Report none = sample_report();
  none.devices[0].decisions.clear();
  CHECK_THAT(report_page(none), !Contains("What auto decided"));
}

TEST_CASE("gains by light are the baseline's cost over a method's") {
  for (const Chart& chart : charts_of(sample_report(), sample_report().devices[0])) {
    if (chart.name != "areas") continue;
    CHECK_THAT(chart.inside, Contains("pah: 2.00, 26.00 against 13.00") && Contains("auto: 4.00") &&
                                 Contains("light 0 (a &lt;sun&gt;)"));
    return;
  }
  FAIL("no chart of areas");
}

TEST_CASE("a text that is no report is refused with its name and what to do") {
  for (const char* text :
       {"", "{", "[]", "{}", R"({"bench": "spine", "schema": 1})", R"({"bench": "compare", "schema": 2})"}) {
    CAPTURE(text);
    REQUIRE_THROWS_WITH(from_json_text(text, "old.json"),
                        Contains("old.json") && Contains("another name with -o"));
  }
}

TEST_CASE("the CSV has a line for each method and kind, with as many cells as the head") {
  const std::string csv = to_csv(sample_report());
  CHECK(count_of(csv, "\n") == 1 + 4 * 2);
  std::size_t commas = 0;
  for (std::size_t at = 0; at < csv.size();) {
    const std::size_t end = csv.find('\n', at);
    const std::size_t here = count_of(csv.substr(at, end - at), ",");
    if (at == 0) commas = here;
    CAPTURE(csv.substr(at, end - at));
    REQUIRE(here == commas);
    at = end + 1;
  }
}

TEST_CASE("the page holds every chart, asks nothing of a network and lets no text break out") {
  const Report report = sample_report();
  const std::string page = report_page(report);
  for (const char* chart :
       {"pareto-accuracy", "pareto-memory", "gain", "build-trace", "break-even", "boxes", "triangles",
        "prediction-primary", "prediction-bounce", "errors", "size-build", "size-trace", "areas"}) {
    CAPTURE(chart);
    REQUIRE_THAT(page, Contains("<figure id=\"" + std::string(chart) + "\">"));
  }
  CHECK(count_of(page, "<svg ") == charts_of(report, report.devices[0]).size());
  CHECK(chart_files(report).size() == charts_of(report, report.devices[0]).size());
  // Neither addresses nor anything that fetches: pictures are data.
  for (const char* fetching :
       {"http:", "https:", "url(", "@import", "<script src", "fetch(", "XMLHttpRequest"}) {
    CAPTURE(fetching);
    REQUIRE(count_of(page, fetching) == 0);
  }
  CHECK(count_of(page, "<img ") == 2);
  CHECK(count_of(page, "src=\"data:image/png;base64,") == 2);
  // The scene's name has "</script>" in it: it ends no element but those that are meant.
  CHECK(count_of(page, "</script>") == 3);
  CHECK(count_of(page, "<script") == 3);
  CHECK_THAT(page, Contains("a scene &amp; more") && Contains("a device &lt;of&gt; sorts"));
  CHECK_THAT(page, !Contains("not complete"));
  CHECK_THAT(page, Contains("no time: the budget is 1 s") && Contains("fedcba9876543210"));
}

TEST_CASE("what is embedded as data is what the JSON file says, pictures apart") {
  const Report report = sample_report();
  const std::string page = report_page(report);
  const std::string head = "id=\"rows\">";
  const std::size_t from = page.find(head) + head.size();
  auto embedded = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  auto written = nlohmann::json::parse(to_json_text(report));
  written.at("devices").at(0).at("pictures").at("png") = nlohmann::json::object();
  CHECK(embedded == written);
}

TEST_CASE("an interrupted report says so and has the charts that its rows allow") {
  Report report = sample_report();
  DeviceReport& device = report.devices[0];
  device.complete = false;
  device.traces.clear();
  device.accuracies.clear();
  device.pictures = {};
  const std::string page = report_page(report);
  CHECK_THAT(page, Contains("This report is not complete"));
  CHECK(count_of(page, "<svg ") == 5);  // predictions, sizes, areas
  CHECK_THAT(page, !Contains("type=\"range\""));
}

TEST_CASE("a chart's file stands alone and has both colour schemes") {
  for (const auto& [name, svg] : chart_files(sample_report())) {
    CAPTURE(name);
    REQUIRE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    REQUIRE_THAT(svg, Contains("prefers-color-scheme:dark") && Contains("<title>"));
    REQUIRE(count_of(svg, "<svg") == count_of(svg, "</svg>"));
    REQUIRE(count_of(svg, "<g>") + count_of(svg, "<g ") == count_of(svg, "</g>"));
    REQUIRE_THAT(svg, !Contains("nan") && !Contains("inf"));
  }
}

TEST_CASE("letters never cover each other, and a lone one stays on its point") {
  std::vector<Place> points(20, {200.0, 100.0, 30.0});
  const auto letters = place_letters(points, {50.0, 390.0, 250.0});
  CHECK(letters[0].x == 200.0);
  CHECK(letters[0].y == 100.0);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CAPTURE(i, j);
      REQUIRE(std::hypot(letters[i].x - letters[j].x, letters[i].y - letters[j].y) >= 16.0);
    }
  }
}

TEST_CASE("texts stay inside the picture, wherever ticks fall") {
  const std::regex text(
      R"re(<text x="([-0-9.]+)" y="[-0-9.]+"(?: text-anchor="(\w+)")?[^>]*>([^<]*)</text>)re");
  std::size_t seen = 0;
  for (int k = 0; k < 400; ++k) {
    // Ranges from a part of a decade to many of them, small numbers and large ones.
    const double lo = std::pow(10.0, -9.0 + 0.0425 * k);
    const double hi = lo * (1.01 + 0.13 * (k % 37) + std::pow(10.0, k % 11) - 1.0);
    Scatter scatter;
    scatter.x_label = scatter.y_label = "error";
    scatter.dots = {{"A", 0, lo, lo, ""}, {"B", 1, hi, hi, ""}};
    RowPlot rows;
    rows.x_label = "error";
    rows.rows = {{"A", {{0, lo, lo, lo, ""}, {0, hi, hi, hi, ""}}, ""}};
    for (const Svg& svg : {draw(scatter), draw(rows)}) {
      const std::string drawn = svg.file("t");
      for (std::sregex_iterator it(drawn.begin(), drawn.end(), text), end; it != end; ++it, ++seen) {
        const double width = 8.3 * static_cast<double>((*it)[3].length());  // digits of DejaVu Sans
        const std::string anchor = (*it)[2];
        const double left = std::stod((*it)[1]) - (anchor == "middle" ? 0.5 * width
                                                   : anchor == "end"  ? width
                                                                      : 0.0);
        CAPTURE(lo, hi, it->str());
        if (it->str().find("\"letter\"") != std::string::npos) continue;  // placed by the group around it
        REQUIRE(left >= -2.0);
        REQUIRE(left + width <= kChartWidth + 2.0);
      }
    }
  }
  CHECK(seen > 4000);
}

TEST_CASE("a logarithmic axis holds its values and labels round numbers in between") {
  const std::vector<std::vector<double>> ranges{{1.0},      {0.97, 1.02}, {1e-9, 1e12}, {3.0, 40.0},
                                                {0.0, 5.0}, {},           {1e6, 1.1e6}};
  for (const auto& values : ranges) {
    const LogAxis axis(values, 50.0, 390.0);
    for (const double value : values) {
      if (value == 0.0) continue;
      CAPTURE(value);
      REQUIRE(axis.at(value) >= 50.0);
      REQUIRE(axis.at(value) <= 390.0);
    }
    const auto ticks = axis.ticks();
    CAPTURE(axis.lo(), axis.hi());
    REQUIRE(ticks.size() >= 2);
    REQUIRE(ticks.size() <= 9);
    for (const auto& tick : ticks) {
      REQUIRE(axis.at(tick.value) >= 50.0);
      REQUIRE(axis.at(tick.value) <= 390.0);
    }
  }
  CHECK(tick_text(0.5) == "0.5");
  CHECK(tick_text(20000.0) == "20k");
  CHECK(tick_text(1.5e6) == "1.5M");
  CHECK(tick_text(0.002) == "0.002");
  CHECK(tick_text(0.0001) == "1e-4");
  CHECK(tick_text(0.00015) == "1.5e-4");
  CHECK(tick_text(7e-13) == "7e-13");
}

TEST_CASE("numbers are written for people") {
  CHECK(time_text(0.0123456) == "12.3 ms");
  CHECK(time_text(12.3456) == "12.3 s");
  CHECK(time_text(4.56e-9) == "4.56 ns");
  CHECK(count_text(167.0) == "167");
  CHECK(count_text(3.14e6) == "3.1 million");
  CHECK(count_text(999.9e6) == "1.0 billion");
  CHECK(bytes_text(1536.0) == "1.50 KiB");
  CHECK(list_text({"a", "b", "c"}) == "a, b and c");
  CHECK(escaped("<a href=\"x\">&") == "&lt;a href=&quot;x&quot;&gt;&amp;");
}

TEST_CASE("bytes come back from base64") {
  for (const std::string& bytes :
       {std::string(), std::string("\0", 1), std::string("\xff\x00\x7f", 3), std::string("four")})
    CHECK(from_base64(to_base64(bytes)) == bytes);
  CHECK(to_base64("any carnal pleas") == "YW55IGNhcm5hbCBwbGVhcw==");
  CHECK_THROWS_AS(from_base64("AA*A"), gnomon::Error);
}
