// Charts: what they show, where letters and texts stand, and how numbers are written.
#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "gnomon/compare/axis.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/plots.h"
#include "gnomon/compare/words.h"
#include "support/sample_report.h"
#include "support/text.h"

using namespace gnomon::compare;
using Catch::Contains;
using gnomon::compare::test::sample_report;
using gnomon::test::count_of;

TEST_CASE("gains by light are the baseline's cost over a method's") {
  for (const Chart& chart : charts_of(sample_report(), sample_report().devices[0])) {
    if (chart.name != "areas") continue;
    CHECK_THAT(chart.inside, Contains("pah: 2.00, 26.00 against 13.00") && Contains("auto: 4.00") &&
                                 Contains("light 0 (a &lt;sun&gt;)"));
    return;
  }
  FAIL("no chart of areas");
}

TEST_CASE("what is said of a row's kinds leaves room for its name") {
  Report report = sample_report();
  DeviceReport& device = report.devices[0];
  const auto rename = [](auto& rows, auto field, const std::string& from, const std::string& to) {
    for (auto& row : rows)
      if (row.*field == from) row.*field = to;
  };
  rename(device.methods, &MethodFacts::name, "sah-best", "sah-near-plane@camera");
  rename(device.builds, &BuildRow::method, "sah-best", "sah-near-plane@camera");
  rename(device.traces, &TraceRow::method, "sah-best", "sah-near-plane@camera");
  rename(device.traces, &TraceRow::kind, "bounce", "rays-of-a-long-file.gnr");
  for (TraceRow& row : device.traces)
    if (row.method == "sah-near-plane@camera" && row.kind != "primary") row.rounds = {{9.0}, {9.0}};
  for (const Chart& chart : charts_of(report, device)) {
    if (chart.name != "break-even") continue;
    CHECK_THAT(chart.inside, Contains("1 of 2 kinds never") && !Contains("never: rays-of-a-long"));
  }
  // At any length of the kind's name the two stay apart, and the kind is named where there is room.
  std::size_t named = 0;
  for (std::size_t letters = 1; letters < 40; ++letters) {
    const std::string kind(letters, 'n');
    for (TraceRow& row : device.traces)
      if (row.kind != "primary") row.kind = kind;
    for (const Chart& chart : charts_of(report, device)) {
      if (chart.name != "break-even") continue;
      const bool is_named = chart.inside.find(">never: " + kind + "<") != std::string::npos;
      named += is_named ? 1 : 0;
      CAPTURE(letters);
      // 8.2: of an n in DejaVu Sans; between what is at the picture's ends.
      REQUIRE((!is_named || 8.2 * static_cast<double>(letters + 7 + 24) < kChartWidth - 24.0));
    }
  }
  CHECK(named > 5);
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

TEST_CASE("nothing is drawn over a letter") {
  std::size_t scatters = 0;
  for (const auto& [name, svg] : chart_files(sample_report())) {
    if (svg.find("class=\"stem") == std::string::npos) continue;
    ++scatters;
    CAPTURE(name);
    const std::size_t letters = count_of(svg, "class=\"dot");
    REQUIRE(letters >= 3);
    REQUIRE(count_of(svg, "class=\"stem") == letters);
    // From the first letter on: each with its mark beneath it, and no line, point, path or word else.
    const std::string top = svg.substr(svg.find("class=\"dot"));
    REQUIRE(count_of(top, "<line") == 0);
    REQUIRE(count_of(top, "<path") == letters);
    REQUIRE(count_of(top, "class=\"mark ") == letters);
    REQUIRE(count_of(top, "<text") == letters);
    REQUIRE(count_of(top, "class=\"letter\"") == letters);
  }
  CHECK(scatters >= 4);
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
        const std::string letters = (*it)[3];
        double width = 8.3 * static_cast<double>(letters.size());  // digits of DejaVu Sans
        if (letters.find('M') != std::string::npos) width += 3.0;
        const std::string anchor = (*it)[2];
        const double left = std::stod((*it)[1]) - (anchor == "middle" ? 0.5 * width
                                                   : anchor == "end"  ? width
                                                                      : 0.0);
        CAPTURE(lo, hi, it->str());
        if (it->str().find("\"letter\"") != std::string::npos) continue;  // placed by the group around it
        REQUIRE(left >= -2.0);
        REQUIRE(left + width <= kChartWidth + 1.0);
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
