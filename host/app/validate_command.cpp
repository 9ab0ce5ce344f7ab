// gnomon validate: whether tree and tracer are right, by invariants, the reference builder and the oracle.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "build_timing.h"
#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "exit_status.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/oracle.h"
#include "heuristic_options.h"
#include "interrupt.h"
#include "numbers.h"
#include "oracle_rows.h"
#include "ray_batch.h"
#include "scene_source.h"
#include "tree_source.h"

namespace gnomon::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kReferenceLimit =
    200'000;  // triangles the reference builder takes without being asked

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  BuildOptions build;
  HeuristicOptions heuristic;
  std::string tree_file;  // empty: build one
  std::uint64_t count = 20'000;
  std::uint64_t max_rays = 2'000;
  std::uint64_t seed = 1;
  double budget_seconds = 30.0;
  bool reference = false;
  RayFileOptions rays_in;
};

struct KindReport {
  std::string kind;
  OracleReport oracle;
};

struct Findings {
  std::optional<BvhFault> fault;
  std::optional<std::string> reference_hash;
  std::vector<KindReport> kinds;
  bool tree_differs = false;
  [[nodiscard]] std::uint64_t mismatches() const {
    std::uint64_t sum = 0;
    for (const KindReport& kind : kinds) sum += kind.oracle.mismatches();
    return sum;
  }
  [[nodiscard]] std::uint64_t judged() const {
    std::uint64_t sum = 0;
    for (const KindReport& kind : kinds) sum += kind.oracle.rays_judged;
    return sum;
  }
  [[nodiscard]] bool good() const { return !fault && !tree_differs && mismatches() == 0; }
};

void check_tree(Findings& findings, const Options& options, const BuildOptions& tree, const Scene& scene,
                const TimedBuild& build) {
  findings.fault = build.fault;
  if (build.fitted) return;  // no builder makes the same
  if (!options.reference && scene.triangles.size() > kReferenceLimit) return;
  findings.reference_hash = tree_hash(build_reference(scene.triangles, tree));
  findings.tree_differs = *findings.reference_hash != build.hash;
}

// What is left of the oracle's time is shared evenly by the kinds still to come.
void check_rays(Findings& findings, const Options& options, const Scene& scene, const Tracer& tracer,
                bool has_double, const Progress& progress) {
  const bool made = options.rays_in.file.empty();
  const auto given = made ? std::vector<NamedRays>{} : read_ray_file(options.rays_in);
  std::vector<std::string> names = ray_kind_names();
  if (!made) names.clear();
  for (const NamedRays& some : given) names.push_back(some.kind);
  double seconds_left = options.budget_seconds;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto rays =
        made ? make_rays(*ray_kind_from(names[i]), scene, tracer, options.count, options.seed, progress)
             : given[i].rays;
    const TraceResult closest = tracer.closest(rays, progress);
    const TraceResult any = tracer.any(rays, progress);
    const double share = std::max(0.0, seconds_left) / static_cast<double>(names.size() - i);
    OracleOptions oracle;
    oracle.max_rays = options.max_rays;
    oracle.pairs_of_floats = !has_double;
    oracle.time_budget = std::chrono::milliseconds(std::llround(1e3 * share));
    const auto start = Clock::now();
    findings.kinds.push_back(
        {names[i], judge(scene.triangles, rays, closest.hits, any.occluded, oracle, progress)});
    seconds_left -= std::chrono::duration<double>(Clock::now() - start).count();
  }
}

Json to_json(const KindReport& report) {
  const OracleReport& o = report.oracle;
  Json row{{"kind", report.kind}};
  add_oracle(row, o);
  row["rays"] = o.rays_given;  // the oracle's own count is of those judged
  row["judged"] = o.rays_judged;
  row["budget_exhausted"] = o.budget_exhausted;
  row["max_t_error_ulp"] = o.max_t_error_ulp;
  row["bad_rays"] = o.bad_rays;
  return row;
}

void add_findings(Json& document, const Options& options, const Findings& findings) {
  Json& chosen = document["options"];
  chosen["count"] = options.count;
  chosen["max_rays"] = options.max_rays;
  chosen["seed"] = options.seed;
  chosen["budget_s"] = options.budget_seconds;
  chosen["rays_in"] = options.rays_in.file.empty() ? Json(nullptr) : Json(options.rays_in.file);
  chosen["kinds"] = options.rays_in.kinds;
  document["tree_fault"] = findings.fault ? Json(findings.fault->what) : Json(nullptr);
  document["reference_hash"] = findings.reference_hash ? Json(*findings.reference_hash) : Json(nullptr);
  document["rays_judged"] = findings.judged();
  document["mismatches"] = findings.mismatches();
  document["ok"] = findings.good();
  document["kinds"] = Json::array();
  for (const KindReport& kind : findings.kinds) document["kinds"].push_back(to_json(kind));
}

std::string kind_table(const Findings& findings) {
  if (findings.kinds.empty()) return {};
  Table table(
      {"kind", "rays", "judged", "lost", "false", "wrong", "any/closest", "ties", "max t error (ulp)"});
  for (const KindReport& kind : findings.kinds) {
    const OracleReport& o = kind.oracle;
    table.add({kind.kind, std::to_string(o.rays_given), std::to_string(o.rays_judged), std::to_string(o.lost),
               std::to_string(o.false_hits), std::to_string(o.wrong_primitive),
               std::to_string(o.any_closest_disagree), std::to_string(o.ties), fixed(o.max_t_error_ulp, 2)});
  }
  return table.text() + "\n";
}

std::string facts_of(const cl::DeviceInfo& device, const Scene& scene, const std::string& heuristic,
                     const TimedBuild& build, const Findings& findings) {
  Facts facts;
  facts.add("device", describe(device));
  facts.add("scene", describe(scene));
  facts.add("heuristic", heuristic);
  facts.add("tree", describe(build));
  facts.add("invariants", findings.fault ? "BROKEN: " + findings.fault->what : "hold");
  if (findings.reference_hash) {
    facts.add("reference",
              findings.tree_differs ? "DIFFERS: hash " + *findings.reference_hash : "the same tree");
  } else if (build.fitted) {
    facts.add("reference", "none: a plan fitted this tree to rays");
  } else {
    facts.add("reference", "not built for so many triangles; --reference asks for it");
  }
  return facts.text();
}

std::string verdict(const Findings& findings, const Console& console) {
  if (findings.good()) return console.paint(Paint::kGood, "ok") + ": mismatches 0\n";
  return console.paint(Paint::kBad, "MISMATCH") + ": mismatches " + std::to_string(findings.mismatches()) +
         (findings.fault || findings.tree_differs ? ", and the tree is not as it should be" : "") + "\n";
}

int run(const Options& options, Console& console) {
  options.build.check();
  check(options.heuristic);
  const cl::Context context = open_device(options.device);
  const Scene scene = load_scene(options.scene, console);
  const TimedBuild build =
      tree_timed(context, scene, options.tree_file, with_heuristic(options.build, options.heuristic, scene),
                 {1, false}, console.progress());
  const BuildOptions& tree = build.options;
  Findings findings;
  check_tree(findings, options, tree, scene, build);
  if (findings.fault) {
    console.note("no rays are sent through a broken tree: they might never come back");
  } else {
    check_rays(findings, options, scene, Tracer(context, build.tree), context.device().fp64,
               console.progress());
  }
  stop_if_interrupted();
  if (findings.good() && findings.judged() == 0) {
    throw Error(ErrorCode::kDevice,
                "no ray was judged, so nothing is known; give more --count, --max-rays or --budget");
  }
  for (const KindReport& kind : findings.kinds) {
    if (!kind.oracle.budget_exhausted) continue;
    console.note(kind.kind + ": time for " + std::to_string(kind.oracle.rays_judged) +
                 " rays only; --budget gives more");
  }
  Json document = start_document("validate");
  add_device(document, &context.device());
  add_scene(document, options.scene, scene);
  add_tree_options(document, context.device(), scene.triangles.size(), tree);
  add_heuristic(document, options.heuristic, scene);
  add_build(document, build);
  add_tree_file(document, build);
  add_findings(document, options, findings);
  console.print(document);
  console.print(facts_of(context.device(), scene, describe(options.heuristic, tree, scene), build, findings) +
                "\n" + kind_table(findings) + verdict(findings, console));
  return findings.good() ? kOk : kMismatch;
}

}  // namespace

void add_validate_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("validate", "Check tree and hits against brute force in double precision.");
  add_scene_options(*command, options->scene);
  add_count(*command, "--count", options->count, "rays of each kind to trace");
  add_count(*command, "--max-rays", options->max_rays, "of them, so many to judge, evenly spread")
      ->check(CLI::Range(1, 1000000000));
  add_count(*command, "--seed", options->seed, "for the rays that are drawn at random");
  command->add_option("--budget", options->budget_seconds, "seconds the oracle may take in all")
      ->check(CLI::Range(1e-3, 1e6))
      ->type_name("S")
      ->capture_default_str();
  add_ray_file_options(*command, options->rays_in);
  command->add_flag("--reference", options->reference,
                    "build with the reference builder too, however large the scene");
  add_build_options(*command, options->build);
  add_heuristic_options(*command, options->heuristic);
  add_tree_file_option(*command, options->tree_file);
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Rays of every kind are traced for the closest and for any hit. The oracle tests each judged ray "
      "against all\n"
      "triangles with exact edge signs: lost and false hits, wrong triangles (ties apart: another triangle "
      "just as\n"
      "near), and answers where any and closest disagree are mismatches. So are broken invariants of the "
      "tree, and\n"
      "up to 200000 triangles any bit that differs from the reference builder's tree. Exit status 6 for a "
      "mismatch.\n\n" +
      explain_ray_kinds() +
      "\nExamples:\n  gnomon validate model.glb\n  gnomon validate gen:city:1M --budget 120 --max-rays 10k\n"
      "  gnomon validate model.glb --rays-in rays.gnr");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
