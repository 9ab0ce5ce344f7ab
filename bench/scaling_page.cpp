// Writes the page and the charts of how times grow with triangles and fall with compute units, from the rows
// of scaling_bench and from nothing else; or checks that they are what the rows give.
//
//   scaling_page ROWS.jsonl PAGE.md PICTURES [--check]
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "gnomon/compare/plots.h"
#include "page_file.h"

namespace {

using nlohmann::json;
using page::head_of;
using page::line_of;
using page::number;
using Rows = std::vector<json>;

std::string spread(const json& s, double scale, const char* format) {
  const auto part = [&](const char* which) { return number(scale * s.at(which).get<double>(), format); };
  return part("median") + " (" + part("min") + "–" + part("max") + ")";
}

std::string count(const json& row, const char* key) {
  return std::to_string(row.at(key).get<std::uint64_t>());
}

// Rows of a part, of the last commit that has any.
Rows newest(const Rows& rows, const std::string& part) {
  Rows kept;
  for (const json& row : rows) {
    if (row.at("part") != part) continue;
    if (!kept.empty() && kept.front().at("commit") != row.at("commit")) kept.clear();
    kept.push_back(row);
  }
  if (kept.empty()) throw std::runtime_error("no rows of bench scaling, schema 1, part " + part);
  return kept;
}

std::string taken_on(const json& row) {
  return row.at("device").get<std::string>() + " (driver " + row.at("driver").get<std::string>() +
         "), commit " + row.at("commit").get<std::string>();
}

class Page {
 public:
  explicit Page(const std::string& text) {
    Rows rows;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.empty()) continue;
      json row = json::parse(line);
      if (row.at("bench") == "scaling" && row.at("schema") == 1) rows.push_back(std::move(row));
    }
    for (json& row : newest(rows, "sizes"))
      (row.at("task") == "build" ? builds_ : traces_).push_back(std::move(row));
    units_ = newest(rows, "units");
    std::stable_sort(builds_.begin(), builds_.end(), [](const json& a, const json& b) {
      return std::pair(a.at("scene"), a.at("builder")) < std::pair(b.at("scene"), b.at("builder"));
    });
    if (builds_.empty() || traces_.empty())
      throw std::runtime_error("rows of builds or of tracing are missing");
  }

  [[nodiscard]] std::string text() const {
    return "# How times grow\n\n<!-- Written by scaling_page from scaling.jsonl; take rows with "
           "bench/rerun.sh "
           "scaling. -->\n\n![Time of a build by triangles](../pictures/scaling-build.svg)\n"
           "![Time of a ray by triangles](../pictures/scaling-trace.svg)\n\nMedians of " +
           count(builds_.front().at("build_s"), "n") + " rounds (least–greatest), one thread, " +
           builds_.front().at("clock").get<std::string>() + ", on " + taken_on(builds_.front()) +
           ".\n\n## Builds\n\nGrowth is over the scene a tenth as large. Memory at once is the whole "
           "process'.\n" +
           builds() + "\n## Tracing\n\nAs many rays of a kind in scenes of every size.\n" + traces() +
           "\n## Compute units\n\nThe same device with fewer units, " +
           units_.front().at("clock").get<std::string>() + " time, on " + taken_on(units_.front()) + ".\n" +
           units();
  }

  [[nodiscard]] std::string build_chart() const {
    gnomon::compare::CurvePlot plot = curves(builds_, "builder", "build, ms", [](const json& row) {
      return 1e3 * row.at("build_s").at("median").get<double>();
    });
    const auto& first = plot.curves.front().points;
    plot.guide = {first.front(),
                  {first.back().first, first.front().second * first.back().first / first.front().first}};
    return draw(plot).file("Time of a build by triangles; along the dashed line it is proportional to them");
  }

  [[nodiscard]] std::string trace_chart() const {
    return draw(curves(traces_, "rays", "ns per ray",
                       [](const json& row) {
                         return per_ray(row) * row.at("trace_s").at("median").get<double>();
                       }))
        .file("Time of a ray by triangles");
  }

 private:
  [[nodiscard]] std::string builds() const {
    std::string out = head_of({"scene", "builder", "triangles", "build, ms", "growth", "n log n would be",
                               "bytes a triangle", "memory at once, MiB"});
    for (const json& row : builds_) {
      const double bytes = row.at("tree_bytes").get<double>() + row.at("wide_bytes").get<double>();
      out += line_of({row.at("scene"), row.at("builder"), count(row, "triangles"),
                      spread(row.at("build_s"), 1e3, "%.1f"),
                      row.contains("growth") && !row.at("growth").is_null()
                          ? spread(row.at("growth"), 1.0, "%.2f")
                          : "–",
                      row.contains("n_log_n") && !row.at("n_log_n").is_null()
                          ? number(row.at("n_log_n").get<double>(), "%.2f")
                          : "–",
                      number(bytes / row.at("triangles").get<double>(), "%.0f"),
                      number(row.at("peak_bytes").get<double>() / (1024.0 * 1024.0), "%.0f")});
    }
    return out;
  }

  [[nodiscard]] std::string traces() const {
    std::string out = head_of({"scene", "triangles", "rays", "ns a ray"});
    for (const json& row : traces_)
      out += line_of({row.at("scene"), count(row, "triangles"),
                      count(row, "ray_count") + " " + row.at("rays").get<std::string>(),
                      spread(row.at("trace_s"), per_ray(row), "%.1f")});
    return out;
  }

  [[nodiscard]] std::string units() const {
    std::string out = head_of({"scene", "task", "units", "time, ms", "times as fast as one unit"});
    for (const json& row : units_) {
      const std::string rays = row.value("rays", "");
      out +=
          line_of({row.at("scene").get<std::string>() + ", " + count(row, "triangles") + " triangles",
                   row.at("task").get<std::string>() + (rays.empty() ? "" : ", " + rays), count(row, "units"),
                   spread(row.at("seconds"), 1e3, "%.1f"), spread(row.at("speed_up"), 1.0, "%.2f")});
    }
    return out;
  }

  // Nanoseconds a ray of a batch's seconds.
  static double per_ray(const json& row) { return 1e9 / row.at("ray_count").get<double>(); }

  // A curve for each scene and what else tells rows apart.
  template <typename Value>
  static gnomon::compare::CurvePlot curves(const Rows& rows, const char* field, const std::string& label,
                                           Value value) {
    gnomon::compare::CurvePlot plot;
    plot.x_label = "triangles";
    plot.y_label = label;
    plot.straight = true;
    for (const json& row : rows) {
      const std::string name = row.at("scene").get<std::string>() + ", " + row.at(field).get<std::string>();
      auto curve =
          std::find_if(plot.curves.begin(), plot.curves.end(), [&](const auto& c) { return c.name == name; });
      if (curve == plot.curves.end()) curve = plot.curves.insert(curve, {name, {}});
      curve->points.emplace_back(row.at("triangles").get<double>(), value(row));
    }
    return plot;
  }

  Rows builds_, traces_, units_;
};

}  // namespace

int main(int argc, char** argv) {
  const bool check = argc == 5 && std::string(argv[4]) == "--check";
  const char* const usage =
      "usage: scaling_page ROWS.jsonl PAGE.md PICTURES [--check]\n\nWrites the page and the charts of how "
      "times grow from "
      "rows of scaling_bench; --check: exits 1 where one is another.\n";
  if (gnomon::bench::taught(argc, argv, usage)) return 0;
  if (argc != 4 && !check) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    const Page page(page::read(argv[1]));
    const std::filesystem::path pictures(argv[3]);
    bool same = page::settle(argv[2], page.text(), check);
    same = page::settle((pictures / "scaling-build.svg").string(), page.build_chart(), check) && same;
    same = page::settle((pictures / "scaling-trace.svg").string(), page.trace_chart(), check) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scaling_page: %s\n", error.what());
    return 1;
  }
}
