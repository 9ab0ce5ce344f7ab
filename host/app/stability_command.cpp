// gnomon stability: the catalogue of hard cases, or a long run, against the oracle.
#include <algorithm>
#include <memory>
#include <span>
#include <sstream>

#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "exit_status.h"
#include "gnomon/base/stats.h"
#include "gnomon/scene/write_file.h"
#include "gnomon/stability/cases.h"
#include "interrupt.h"
#include "numbers.h"
#include "scene_source.h"
#include "stability_rows.h"
#include "version.h"

namespace gnomon::app {
namespace {

struct Options {
  std::vector<std::string> scenes;
  std::string only;
  bool list = false;
  std::uint64_t seed = 1;
  std::uint32_t rays_per_case = 256;
  std::uint64_t soak_rays = 0;  // 0: the catalogue
  unsigned threads = 0;
  std::string rows;
  std::string builder;
  std::string flavour;
  DeviceOptions device;
};

std::vector<std::uint32_t> numbers_of(const std::string& only) {
  std::vector<std::uint32_t> numbers;
  std::istringstream words(only);
  for (std::string word; std::getline(words, word, ',');) {
    const auto number = parse_count(word);
    if (!number || *number > 1000000) {
      throw Error(ErrorCode::kInvalidArgument,
                  "--only \"" + only + "\": write numbers with commas between, as in 3,17");
    }
    numbers.push_back(static_cast<std::uint32_t>(*number));
  }
  return numbers;
}

std::vector<Scene> scenes_of(const Options& options, Console& console) {
  std::vector<Scene> scenes;
  for (const std::string& source : options.scenes) {
    SceneOptions scene;
    scene.source = source;
    scenes.push_back(load_scene(scene, console));
    scenes.back().name = source;
  }
  return scenes;
}

// One row a line, written when all are at hand: a run that fails leaves the file as it was.
void append_rows(const std::string& file, const std::vector<Json>& rows) {
  if (file.empty()) return;
  std::string text;
  for (const Json& row : rows) text += row.dump() + "\n";
  append_to_file(file, std::as_bytes(std::span(text)));
}

Json start_row(const char* kind, const cl::Context& context, const Options& options) {
  return {{"bench", "stability"},
          {"schema", 1},
          {"kind", kind},
          {"commit", commit()},
          {"device", context.device().name},
          {"driver", context.device().driver},
          {"fp64", context.device().fp64},
          {"seed", options.seed}};
}

Json document_of(const Options& options, const cl::Context& context, const std::vector<Json>& rows, bool ok) {
  Json document = start_document("stability");
  add_device(document, &context.device());
  document["options"] = {{"scenes", options.scenes},
                         {"only", options.only},
                         {"seed", options.seed},
                         {"rays_per_case", options.rays_per_case},
                         {"rays", options.soak_rays}};
  document["ok"] = ok;
  document["rows"] = rows;
  return document;
}

int finish(const Options& options, Console& console, const cl::Context& context,
           const std::vector<Json>& rows, bool ok, const std::string& text) {
  append_rows(options.rows, rows);
  console.print(document_of(options, context, rows, ok));
  console.print(text + (ok ? console.paint(Paint::kGood, "ok") : console.paint(Paint::kBad, "FAILED")) +
                "\n");
  return ok ? kOk : kMismatch;
}

int run_cases(const Options& options, Console& console) {
  stability::CatalogueOptions catalogue;
  catalogue.only = numbers_of(options.only);
  catalogue.seed = options.seed;
  catalogue.rays = options.rays_per_case;
  catalogue.builder = options.builder;
  catalogue.flavour = options.flavour;
  catalogue.scenes = scenes_of(options, console);
  const cl::Context context = open_device(options.device);
  const auto verdicts = stability::run_catalogue(context, catalogue, console.progress());
  stop_if_interrupted();
  std::vector<Json> rows;
  for (const stability::Verdict& verdict : verdicts) {
    rows.push_back(start_row("case", context, options));
    rows.back().update(to_json(verdict));
  }
  const bool ok = std::all_of(verdicts.begin(), verdicts.end(), [](const auto& v) { return v.ok(); });
  return finish(options, console, context, rows, ok, verdict_table(verdicts, console) + "\n");
}

// Over the parts: how evenly wrong t is.
Json spread_of_p99(const stability::SoakReport& report) {
  std::vector<double> p99;
  for (const stability::SoakPart& part : report.parts) p99.push_back(part.oracle.t_errors.quantile(0.99));
  return to_json(spread_of(p99));
}

int run_soak(const Options& options, Console& console) {
  if (!options.builder.empty() || !options.flavour.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "--builder and --flavour are of the catalogue; a long run goes through all of them");
  }
  stability::SoakOptions soak;
  soak.rays = options.soak_rays;
  soak.seed = options.seed;
  soak.threads = options.threads;
  soak.scenes = scenes_of(options, console);
  const cl::Context context = open_device(options.device);
  const stability::SoakReport report = stability::soak(context, soak, console.progress());
  const bool exact = context.device().fp64;
  const stability::SoakPart total = report.total();
  Json row = start_row("soak", context, options);
  row["options"] = {{"rays", options.soak_rays}, {"flavours", report.flavours}};
  row["stopped"] = report.stopped;
  row["seconds"] = report.seconds;
  row.update(to_json(total, exact));
  row["tolerance_ulp"] = exact ? Json(stability::kMostUlp) : Json(nullptr);  // else each hit has its own
  for (const char* key : {"scene", "scene_hash", "builder", "offset"})
    row.erase(key);  // each part has its own
  row["t_error_p99_of_parts"] = spread_of_p99(report);
  row["parts"] = Json::array();
  for (const stability::SoakPart& part : report.parts) row["parts"].push_back(to_json(part, exact));
  if (report.stopped)
    console.note("stopped after " + std::to_string(total.rays) + " rays; these are what they gave");
  const bool ok = total.ok(exact) && total.rays > 0;
  const int status = finish(options, console, context, {row}, ok, soak_table(report, exact) + "\n");
  return report.stopped && ok ? kInterrupted : status;
}

int run(const Options& options, Console& console) {
  if (options.list) {
    Json cases = Json::array();
    for (const auto& info : stability::catalogue()) cases.push_back(to_json(info));
    Json document = start_document("stability");
    document["cases"] = cases;
    console.print(document);
    console.print(case_list(stability::catalogue()));
    return kOk;
  }
  return options.soak_rays > 0 ? run_soak(options, console) : run_cases(options, console);
}

}  // namespace

void add_stability_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("stability", "Run the rays, shapes and areas on which tracers go wrong.");
  command
      ->add_option("scenes", options->scenes, "scenes for case 18 or the long run; generated ones otherwise")
      ->type_name("SCENE");
  command->add_flag("--list", options->list, "name all cases and end");
  command->add_option("--only", options->only, "run these cases, as in 3,17")->type_name("NUMBERS");
  command->add_option("--builder", options->builder, "through this builder alone, named as in the table")
      ->type_name("NAME");
  command->add_option("--flavour", options->flavour, "through this flavour alone, as in \"wide portable\"")
      ->type_name("NAME");
  add_count(*command, "--rays-per-case", options->rays_per_case, "of one kind on one shape, about")
      ->check(CLI::Range(1, 1000000));
  add_count(*command, "--rays", options->soak_rays,
            "a long run instead: so many rays of mixed kinds, as in 1e6 or 1e8; 0: the catalogue");
  add_count(*command, "--threads", options->threads, "of the oracle in a long run; 0: all");
  add_count(*command, "--seed", options->seed, "for shapes and rays");
  command->add_option("--rows", options->rows, "append one JSON row a line to this file")->type_name("FILE");
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Every case goes through every builder and every flavour of tracing that the device has. Counts are of "
      "rays: lost\n"
      "hits, false ones, wrong triangles, any hit against closest hit; t errors are in ulp of the exact t. A "
      "long run\n"
      "places each scene at 0, 1e3 and 1e5 times its size from the origin and aims half of its rays at "
      "corners and edges;\n"
      "Ctrl-C ends it with what it has. Exit status 6 when a case fails, 130 when a long run was stopped.\n\n"
      "Examples:\n  gnomon stability\n  gnomon stability --only 1,2,3 --rays-per-case 100k\n"
      "  gnomon stability model.glb --rays 1e6");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
