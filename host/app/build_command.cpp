// gnomon build: builds a tree and says how long each stage took and what came out.
#include <memory>
#include <string_view>

#include "build_timing.h"
#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "gnomon/tree/tree_export.h"
#include "gnomon/tree/tree_file.h"
#include "heuristic_options.h"
#include "interrupt.h"
#include "numbers.h"
#include "plan_choice.h"
#include "plan_rays.h"
#include "ray_batch.h"
#include "scene_source.h"

namespace gnomon::app {
namespace {

constexpr std::string_view kTreeFile = ".gnb";
constexpr std::string_view kPlainTree = ".bvh2";

struct Options {
  SceneOptions scene;
  std::string file;
  DeviceOptions device;
  BuildOptions build;
  HeuristicOptions heuristic;
  BuildRuns runs{3, true};
  PlanRequest plan;
  RayFileOptions rays_in;
};

// Rays of a kind that trees are planned for where nothing else is said: 64 a pixel of 512 x 512.
constexpr double kAssumedRays = 16'777'216.0;

std::string stage_table(const TimedBuild& build) {
  if (build.median.stages.empty()) return {};
  Table table({"stage", "ms"});
  for (const auto& [stage, ms] : build.median.stages) table.add({stage, fixed(ms, 3)});
  return table.text();
}

std::string facts_of(const cl::DeviceInfo& device, const Scene& scene, const Options& options,
                     const std::string& heuristic, const TimedBuild& build, const std::string& plan) {
  const double mtris = 1e-3 * static_cast<double>(scene.triangles.size()) / build.total_ms.median;
  Facts facts;
  facts.add("device", describe(device));
  facts.add("scene", describe(scene));
  facts.add("build", fixed(build.total_ms.median, 2) + " ms (median of " + std::to_string(build.runs.repeat) +
                         ", " + fixed(build.total_ms.min, 2) + " to " + fixed(build.total_ms.max, 2) + "), " +
                         fixed(mtris, 2) + " Mtris/s");
  facts.add("builder", to_string(options.build.builder));
  facts.add("heuristic", heuristic);
  facts.add("plan", plan);
  facts.add("tree", describe(build));
  facts.add("leaves", fixed(build.stats.mean_leaf, 2) + " triangles on average, " +
                          std::to_string(build.stats.largest_leaf) + " at most");
  facts.add("memory", format_bytes(build.tree.bytes()) + " tree, " +
                          format_bytes(build.median.scratch_bytes) + " scratch");
  if (!options.file.empty()) facts.add("written", options.file);
  return facts.text();
}

void check_name(const std::string& file) {
  if (file.empty() || file.ends_with(kTreeFile) || file.ends_with(kPlainTree)) return;
  throw Error(ErrorCode::kInvalidArgument, "-o " + file + ": a name that ends in " + std::string(kTreeFile) +
                                               " keeps the tree for gnomon, one in " +
                                               std::string(kPlainTree) + " for other programs");
}

void write(const Options& options, const Scene& scene, const TimedBuild& build) {
  if (options.file.empty()) return;
  if (options.file.ends_with(kPlainTree)) return export_bvh2(options.file, build.host, scene.triangles);
  save_tree(options.file, build.host, build.options, scene.triangles, build.fitted);
}

// Rays of a file, or those of the scene's camera and lights.
std::vector<PlanRays> rays_to_come(const Options& options, const cl::Context& context, const Scene& scene,
                                   const TimedBuild& build, const Progress& progress) {
  const auto expected = [&](double known) {
    return options.plan.expected != 0 ? static_cast<double>(options.plan.expected) : known;
  };
  std::vector<PlanRays> out;
  if (options.rays_in.file.empty()) {
    for (const RayKind kind : {RayKind::kPrimary, RayKind::kBounce, RayKind::kShadow})
      out.push_back(rays_to_plan_for(kind, scene, context, build.tree, expected(kAssumedRays), 1, progress));
    return out;
  }
  for (const NamedRays& some : read_ray_file(options.rays_in)) {
    const double traced = some.traced > 0 ? static_cast<double>(some.traced) : kAssumedRays;
    out.push_back(rays_to_plan_for(some.kind, some.kind == "shadow" ? Query::kAny : Query::kClosest,
                                   some.rays, expected(traced)));
  }
  return out;
}

// A build by itself traces nothing: there is a plan where the user says which rays will come, or that they
// do.
PlanOutcome plan_of(const Options& options, const PlanTask& plain, const Progress& progress) {
  const PlanRequest& request = options.plan;
  if (!request.instead.empty()) return no_plan(request, request.instead + " says which tree");
  if (!request.asked && request.expected == 0 && options.rays_in.file.empty())
    return no_plan(request, "nothing is known of rays to come; --expect N or --rays-in FILE says it");
  const std::vector<PlanRays> rays = rays_to_come(options, plain.context, plain.scene, plain.plain, progress);
  PlanTask task = plain;
  for (const PlanRays& kind : rays) task.to_come.push_back({kind.query, kind.probe, kind.expected});
  task.draw = [&] { return rays; };
  task.wanted = TreesWanted::kOneForAll;
  return plan_for(request, task, progress);
}

int run(const Options& options, Console& console) {
  options.build.check();
  options.plan.check();
  check(options.heuristic);
  check_name(options.file);
  const cl::Context context = open_device(options.device);
  const Scene scene = load_scene(options.scene, console);
  const BuildOptions tree = with_heuristic(options.build, options.heuristic, scene);
  TimedBuild build = build_for_use(context, scene, tree, options.runs, console.progress());
  stop_if_interrupted();
  const PlanTask task{context, scene, build, {}, "", {}};
  const PlanOutcome plan = plan_of(options, task, console.progress());
  stop_if_interrupted();
  if (!plan.chosen.empty() && plan.tree(0) != nullptr) adopt(build, task, *plan.tree(0));
  write(options, scene, build);
  Json document = start_document("build");
  add_device(document, &context.device());
  add_scene(document, options.scene, scene);
  add_tree_options(document, context.device(), scene.triangles.size(), tree);
  add_heuristic(document, options.heuristic, scene);
  add_build(document, build);
  add_plan(document, plan);
  document["tree_file"] = options.file.empty() ? Json(nullptr) : Json(options.file);
  console.print(document);
  console.print(facts_of(context.device(), scene, options, describe(options.heuristic, tree, scene), build,
                         describe(plan)) +
                "\n" + stage_table(build));
  return 0;
}

}  // namespace

void add_build_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("build", "Build a bounding volume hierarchy on a device and time it.");
  add_scene_options(*command, options->scene);
  command
      ->add_option(
          "-o,--output", options->file,
          "write the tree: FILE.gnb, for --tree of trace, validate, render and info; FILE.bvh2, plain, "
          "for other programs")
      ->type_name("FILE");
  add_count(*command, "--repeat", options->runs.repeat, "timed builds, after one to warm up")
      ->check(CLI::Range(1, 10000));
  add_build_options(*command, options->build);
  add_heuristic_options(*command, options->heuristic);
  add_plan_options(
      *command, options->plan,
      "rays of a kind to come, that a tree must repay itself over; default: as many as the record "
      "of --rays-in counted, else 16777216");
  add_ray_file_options(*command, options->rays_in);
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Binned over all three axes, or with --builder fast along a curve: built sooner, traced a little "
      "slower.\n"
      "--builder best divides large triangles into parts first and moves subtrees afterwards: built later, "
      "for "
      "trees\n"
      "that cost rays less, far less where long triangles overlap.\n"
      "The tree depends on the triangles and the options under \"Tree\" and \"Rays\" alone: its hash is the "
      "same\n"
      "on every device. Times by stage are the device's own; the total is wall clock and includes the "
      "upload:\n"
      "  prepare, bin, split, partition  boxes of triangles, then large nodes, a level at a time\n"
      "  subtrees, compact, gather       the rest, a work-group each; nodes and triangles side by side\n"
      "  parts, load to renumber         of --builder best: dividing triangles, moving subtrees\n"
      "  bound to tree over clusters     of --builder fast: along the curve, chunk by chunk, and their "
      "tree\n\n" +
      explain_plans() + "\n" + std::string(kHeuristicHelp) +
      "\nExamples:\n  gnomon build model.glb\n  gnomon build gen:city:1M --bins 32 --device gpu --json\n"
      "  gnomon build gen:city:1M --heuristic window --light 0\n"
      "  gnomon build gen:city:1M --builder fast\n"
      "  gnomon build gen:city:1M --expect 1G -o city.gnb\n"
      "  gnomon build gen:city:1M --builder best -o city.gnb\n"
      "  gnomon build gen:atrium --heuristic near-plane --point 0,2,0 --direction 1,0,0 --fov 90,60 --share "
      "0.8");
  command->callback([&action, options, command] {
    settle(*command, options->plan);
    action = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace gnomon::app
