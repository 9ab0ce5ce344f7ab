// The page, as a function of a report.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "gnomon/compare/charts.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/report_json.h"
#include "support/sample_report.h"
#include "support/text.h"

using namespace gnomon::compare;
using Catch::Contains;
using gnomon::compare::test::sample_report;
using gnomon::test::count_of;

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
