// Writes what README, the pages of methods and of devices and the pictures show of comparisons, from stored
// rows and from nothing else; or checks that they are what the rows give. RESULTS is the pages' folder.
//
//   compare_figures COMPARE.jsonl DEVICES.jsonl README.md RESULTS PICTURES [--check]
//   compare_figures --page COMPARE.jsonl PAGE.html    the first scene's page, without the pictures that rows
//   do not hold
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/charts.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/page.h"
#include "gnomon/compare/report_json.h"
#include "gnomon/compare/words.h"
#include "page_file.h"

namespace {

using namespace gnomon;
using namespace gnomon::compare;
namespace fs = std::filesystem;

std::string range(const Spread& s) {
  if (s.count == 0) return "–";
  return significant(s.median) + " (" + significant(s.min) + "–" + significant(s.max) + ")";
}

// Of several reports of the same scene and as many devices the last one counts.
std::vector<Report> newest(const std::string& file) {
  std::vector<Report> kept;
  for (Report& report : from_rows_text(page::read(file), file)) {
    const auto old = std::find_if(kept.begin(), kept.end(), [&](const Report& other) {
      return other.scene_hash == report.scene_hash && other.devices.size() == report.devices.size();
    });
    if (old != kept.end()) {
      *old = std::move(report);
      continue;
    }
    kept.push_back(std::move(report));
  }
  return kept;
}

const BuildRow* build_of(const DeviceReport& device, const std::string& method) {
  const auto found = std::find_if(device.builds.begin(), device.builds.end(),
                                  [&](const BuildRow& row) { return row.method == method; });
  return found == device.builds.end() ? nullptr : &*found;
}

const TraceRow* trace_of(const DeviceReport& device, const std::string& method, const std::string& kind) {
  const auto found = std::find_if(device.traces.begin(), device.traces.end(), [&](const TraceRow& row) {
    return row.method == method && row.kind == kind;
  });
  return found == device.traces.end() ? nullptr : &*found;
}

std::string option(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.options)
    if (key == name) return value;
  return "–";
}

std::string scene_of(const Report& report) {
  return report.scene_name + ", " + std::to_string(report.triangles) + " triangles";
}

std::string methods_table(const Report& report) {
  const DeviceReport& device = report.devices.front();
  const BuildRow* const base = build_of(device, kBaseline);
  if (base == nullptr) return "";
  std::string out =
      "| method | build | tracing, all kinds | memory | wrong answers |\n|---|---|---|---|---|\n";
  for (const MethodFacts& method : device.methods) {
    const BuildRow* const build = build_of(device, method.name);
    if (method.name == kBaseline || build == nullptr) continue;
    const Wrong wrong = wrong_of(device, method.name);
    out += "| " + method.name + " | " + range(build_gain(device, kBaseline, method.name, report.clock)) +
           " | " + range(trace_gain(device, kBaseline, method.name, kAllKinds, report.clock)) + " | " +
           fixed(static_cast<double>(build->bytes) / static_cast<double>(base->bytes), 2) + " | " +
           std::to_string(wrong.wrong) + " of " + std::to_string(wrong.judged) + " |\n";
  }
  return out;
}

std::string device_of(const DeviceReport& device) {
  return device.name + " (driver " + device.driver + ")";
}

// Builders as they come and peers: variants, mixtures and published heuristics have '/', '+' or '@' in their
// names.
bool at_a_glance(const std::string& method) {
  return method != kBaseline && method.find_first_of("/+@") == std::string::npos;
}

// One line a method, the same of each scene side by side.
std::string glance_table(const std::vector<Report>& reports) {
  std::string head = "| method |";
  std::string rule = "\n|---|";
  for (const Report& report : reports) {
    head += " " + scene_of(report) + ": tracing | build | wrong answers |";
    rule += "---|---|---|";
  }
  std::string out = head + rule + "\n";
  for (const MethodFacts& method : reports.front().devices.front().methods) {
    if (!at_a_glance(method.name)) continue;
    out += "| " + method.name + " |";
    for (const Report& report : reports) {
      const DeviceReport& device = report.devices.front();
      const Wrong wrong = wrong_of(device, method.name);
      out += " " + range(trace_gain(device, kBaseline, method.name, kAllKinds, report.clock)) + " | " +
             range(build_gain(device, kBaseline, method.name, report.clock)) + " | " +
             std::to_string(wrong.wrong) + " of " + std::to_string(wrong.judged) + " |";
    }
    out += "\n";
  }
  return out;
}

std::string readme_section(const std::vector<Report>& reports) {
  if (reports.empty()) return "";
  std::string out;
  for (const Report& report : reports)
    out += (out.empty() ? "> " : ">\n> ") + advise(report, report.devices.front()).use + "\n";
  return out + "\nTimes as fast as " + kBaseline +
         (reports.front().clock == "cpu" ? ", by processor time" : ", by waiting time") +
         ", in rounds that took turns: median (least–greatest).\n\n" + glance_table(reports) +
         "\n![Speed of tracing by method, with its spread](bench/pictures/compare-gain.svg)\n\n"
         "All methods, by kind of rays, with their memory: [methods](bench/results/compare.md). PoCL, its "
         "portable path and Mesa's\nrusticl beside each other: [devices](bench/results/devices.md).\n";
}

std::string methods_page(const std::vector<Report>& reports) {
  std::string out =
      "# Methods beside each other\n\n<!-- Written by compare_figures from compare.jsonl; take rows with "
      "bench/rerun.sh compare. -->\n\n"
      "What `gnomon compare` says of scenes, and every method. Times as fast as " +
      std::string(kBaseline) +
      ", round by round: median\n(least–greatest); memory over its. Methods are explained on every page that "
      "`gnomon compare` writes. A command says whether waiting time (`--clock wall`) or processor time "
      "counts.\n";
  for (const Report& report : reports) {
    const DeviceReport& device = report.devices.front();
    const Advice advice = advise(report, device);
    out += "\n## " + scene_of(report) + "\n\n`" + report.command + "` on " + device_of(device) + ", commit " +
           report.commit + ":\n\n";
    for (const std::string& sentence : advice.all())
      if (!sentence.empty()) out += sentence + "\n\n";
    out += methods_table(report);
  }
  return out;
}

// Charts of the first scene.
std::map<std::string, std::string> pictures(const std::vector<Report>& reports) {
  std::map<std::string, std::string> out;
  if (reports.empty()) return out;
  for (const Chart& chart : charts_of(reports.front(), reports.front().devices.front()))
    if (chart.name == "pareto-memory" || chart.name == "gain")
      out["compare-" + chart.name + ".svg"] = chart.file;
  return out;
}

std::string devices_table(const Report& report) {
  const std::vector<std::string> kinds = kinds_of(report.devices.front());
  std::string out = "| device | tree | wrong answers | build |";
  std::string rule = "|---|---|---|---|";
  for (const std::string& kind : kinds) {
    out += " " + kind + " |";
    rule += "---|";
  }
  out += "\n" + rule + "\n";
  for (const DeviceReport& device : report.devices) {
    const BuildRow* const build = build_of(device, kBaseline);
    const Wrong wrong = wrong_of(device, kBaseline);
    out += "| " + device.name + " (" + device.platform + ", driver " + device.driver + ", " +
           std::to_string(device.compute_units) + " compute units) | " +
           (build == nullptr ? "–" : "`" + build->tree_hash + "`") + " | " + std::to_string(wrong.wrong) +
           " of " + std::to_string(wrong.judged) + " | " + range(across_gain(report, device, "")) + " |";
    for (const std::string& kind : kinds) out += " " + range(across_gain(report, device, kind)) + " |";
    out += "\n";
  }
  return out;
}

// What each device gains by methods that are there, from its own rounds.
std::string paths_table(const Report& report) {
  std::string out =
      "| device | method | flavour | rays | boxes a ray | triangles a ray | of sah-balanced's speed |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const DeviceReport& device : report.devices) {
    for (const MethodFacts& method : device.methods) {
      const BuildRow* const build = build_of(device, method.name);
      for (const std::string& kind : kinds_of(device)) {
        const TraceRow* const row = trace_of(device, method.name, kind);
        if (row == nullptr || build == nullptr) continue;
        out += "| " + device.name + " | " + method.name + " | " + build->flavour + " | " +
               std::to_string(row->rays) + " " + kind + " | " +
               (row->counted ? fixed(row->boxes_per_ray, 3) : "–") + " | " +
               (row->counted ? fixed(row->triangles_per_ray, 3) : "–") + " | " +
               range(trace_gain(device, kBaseline, method.name, kind, report.clock)) + " |\n";
      }
    }
  }
  return out;
}

std::string devices_page(const std::vector<Report>& reports) {
  std::string out =
      "# Over devices\n\n<!-- Written by compare_figures from devices.jsonl; take rows with bench/rerun.sh "
      "devices. -->\n\n"
      "The same method on every OpenCL device at hand. Trees are to have the same hash everywhere. Times are "
      "ratios of "
      "rounds that\ntook turns in one process, above 1 is faster than the first device: median "
      "(least–greatest). Counts "
      "are exact; the packet\nflavour counts boxes of wide trees, the thread flavour those of binary ones.\n";
  for (const Report& report : reports) {
    out += "\n## " + scene_of(report) + "\n\n`" + report.command + "`, commit " + report.commit + ", " +
           option(report, "rounds") + " rounds at most.\n\n" + devices_table(report) +
           "\nMethods on each device, in rounds of that device alone:\n\n" + paths_table(report);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const char* const usage =
      "usage: compare_figures COMPARE.jsonl DEVICES.jsonl README.md RESULTS PICTURES [--check]\n"
      "       compare_figures --page COMPARE.jsonl PAGE.html\n\n"
      "Writes what README, the pages in RESULTS and the charts in PICTURES show of comparisons, from rows of "
      "gnomon\n"
      "compare --rows; --check: exits 1 where one is another. --page: the page of the first scene's rows, "
      "without pictures.\n";
  if (gnomon::bench::taught(argc, argv, usage)) return 0;
  if (argc < 6 && !(argc == 4 && std::string(argv[1]) == "--page")) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    if (argc == 4) return page::settle(argv[3], report_page(newest(argv[2]).at(0)), false) ? 0 : 1;
    const bool check = argc > 6 && std::string(argv[6]) == "--check";
    const std::vector<Report> reports = newest(argv[1]);
    bool same = page::settle(
        argv[3], page::with_section(page::read(argv[3]), "compare", readme_section(reports)), check);
    const fs::path results(argv[4]);
    same = page::settle((results / "compare.md").string(), methods_page(reports), check) && same;
    same = page::settle((results / "devices.md").string(), devices_page(newest(argv[2])), check) && same;
    for (const auto& [name, svg] : pictures(reports))
      same = page::settle((fs::path(argv[5]) / name).string(), svg, check) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_figures: %s\n", error.what());
    return 1;
  }
}
