// gnomon render: a picture of a scene, and one of how much work its rays were.
#include <chrono>
#include <cmath>
#include <memory>

#include "build_timing.h"
#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "gnomon/render/heat_map.h"
#include "gnomon/render/picture_tracing.h"
#include "gnomon/render/png.h"
#include "gnomon/render/ray_recorder.h"
#include "gnomon/render/render.h"
#include "gnomon/render/tone.h"
#include "gnomon/scene/ray_set.h"
#include "heuristic_options.h"
#include "interrupt.h"
#include "numbers.h"
#include "plan_choice.h"
#include "planned_tracers.h"
#include "render_plan.h"
#include "scene_source.h"
#include "tree_source.h"

namespace gnomon::app {
namespace {

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  BuildOptions build;
  HeuristicOptions heuristic;
  std::string tree_file;  // empty: build one
  PlanRequest plan;
  RenderOptions render;
  double exposure = 0.0;      // in steps of two around the automatic one
  std::uint32_t samples = 0;  // of path tracing; 0: a preview
  std::string order = "given";
  std::string file, heat_map, record;
  std::uint64_t record_rays = 100'000;
};

struct Outcome {
  RenderResult result;
  double exposure = 1.0;
  double seconds = 0.0;
  HeatScale heat;
  RayRecord record;
  [[nodiscard]] std::uint64_t rays() const { return result.camera_rays + result.other_rays; }
};

PlanOutcome plan_of(const Options& options, const cl::Context& context, const TimedBuild& build,
                    const Scene& scene, const Progress& progress) {
  if (options.samples == 0 && options.plan.instead.empty())
    return no_plan(options.plan, "a preview has few rays; --samples plans");
  return plan_picture(options.plan, options.render, context, build, scene, progress);
}

RenderResult render_planned(const cl::Context& context, const Scene& scene, const Options& options,
                            const TimedBuild& build, const PlanOutcome& plan, const Progress& progress,
                            const RayObserver& observer) {
  if (!plan.plan) return render_paths(context, build.tree, scene, options.render, progress, observer);
  const TraceOptions how = picture_tracing(context.device(), scene, options.render.sort_by_light);
  const PlannedTracers trees(context, scene, build, plan, how);
  return render_paths(context, trees.tracers(), trees.closest_tree(), scene, options.render, progress,
                      observer);
}

Outcome render_timed(const Options& options, const cl::Context& context, const TimedBuild& build,
                     const PlanOutcome& plan, const Scene& scene, const Progress& progress) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  RayRecorder recorder(options.record_rays, options.render.seed);
  RayObserver observer;
  if (!options.record.empty()) observer = [&](const TracedRays& traced) { recorder.add(traced); };
  outcome.result = options.samples == 0
                       ? render(context, build.tree, scene, options.render, progress)
                       : render_planned(context, scene, options, build, plan, progress, observer);
  outcome.record = recorder.record();
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.exposure =
      auto_exposure(outcome.result.picture, outcome.result.coverage) * std::exp2(options.exposure);
  outcome.heat = heat_scale(outcome.result.boxes);
  return outcome;
}

void write_pictures(const Options& options, const Outcome& outcome) {
  const RenderResult& result = outcome.result;
  const RgbImage picture = tone_map(result.picture, outcome.exposure);
  stop_if_interrupted();
  write_png(picture, options.file);
  if (!options.record.empty()) write_ray_record(options.record, outcome.record);
  if (options.heat_map.empty()) return;
  write_png(heat_map(options.render.width, options.render.height, result.boxes, outcome.heat),
            options.heat_map);
}

Json record_of(const Options& options, const RayRecord& record) {
  Json strata = Json::array();
  for (const RayStratum& stratum : record.strata) {
    strata.push_back({{"kind", to_string(stratum.kind)},
                      {"light", stratum.light == kNoLight ? Json(nullptr) : Json(stratum.light)},
                      {"depth", stratum.depth},
                      {"traced", stratum.traced},
                      {"stored", stratum.stored}});
  }
  return {{"file", options.record}, {"rays", record.rays.size()}, {"strata", strata}};
}

void add_outcome(Json& document, const Options& options, const Outcome& outcome) {
  Json& chosen = document["options"];
  chosen["width"] = options.render.width;
  chosen["height"] = options.render.height;
  chosen["method"] = options.samples == 0 ? "preview" : "paths";
  chosen["samples"] = options.render.samples;
  chosen["seed"] = options.render.seed;
  chosen["exposure"] = options.exposure;
  document["picture"] = options.file;
  document["render_notes"] = outcome.result.notes;
  document["seconds"] = outcome.seconds;
  document["device_seconds"] = 1e-3 * outcome.result.kernel_ms;
  document["rays"] = outcome.rays();
  document["camera_rays"] = outcome.result.camera_rays;
  document["record"] = nullptr;
  if (!options.record.empty()) document["record"] = record_of(options, outcome.record);
  document["heat_map"] = nullptr;
  if (options.heat_map.empty()) return;
  document["heat_map"] = {{"file", options.heat_map},
                          {"scale_max", outcome.heat.white},
                          {"max_boxes", outcome.heat.max},
                          {"mean_boxes", outcome.heat.mean}};
}

std::string facts_of(const Options& options, const cl::DeviceInfo& device, const Scene& scene,
                     const std::string& heuristic, const TimedBuild& build, const PlanOutcome& plan,
                     const Outcome& outcome) {
  Facts facts;
  facts.add("device", describe(device));
  facts.add("scene", describe(scene));
  facts.add("heuristic", heuristic);
  facts.add("tree", describe(build));
  facts.add("plan", describe(plan));
  facts.add("picture", options.file + ", " + std::to_string(options.render.width) + " x " +
                           std::to_string(options.render.height) + ", " +
                           std::to_string(options.render.samples) +
                           (options.samples == 0 ? " samples a pixel, a preview" : " paths a pixel"));
  if (!options.heat_map.empty()) {
    facts.add("heat map", options.heat_map + ", 0 (black) to " + fixed(outcome.heat.white, 0) +
                              " boxes a camera ray (pale), " + fixed(outcome.heat.mean, 1) + " on average, " +
                              fixed(outcome.heat.max, 0) + " at most");
  }
  if (!options.record.empty()) {
    facts.add("record", options.record + ", " + std::to_string(outcome.record.rays.size()) + " rays in " +
                            std::to_string(outcome.record.strata.size()) + " strata");
  }
  facts.add("rays", std::to_string(outcome.rays()) + " in " + fixed(outcome.seconds, 2) + " s");
  return facts.text();
}

int run(Options options, Console& console) {
  options.render.heat_map = !options.heat_map.empty();
  if (options.samples != 0) options.render.samples = options.samples;
  if (!options.record.empty() && options.samples == 0) {
    throw Error(ErrorCode::kInvalidArgument, "--record stores the rays of path tracing: give --samples, too");
  }
  options.build.check();
  options.render.check();
  options.plan.check();
  if (options.plan.asked && options.plan.name != "auto" && options.samples == 0) {
    throw Error(ErrorCode::kInvalidArgument,
                "--plan " + options.plan.name + " is for the rays of path tracing: give --samples, too");
  }
  check(options.heuristic);
  const cl::Context context = open_device(options.device);
  const Scene scene = load_scene(options.scene, console);
  const TimedBuild build =
      tree_for_use(context, scene, options.tree_file, with_heuristic(options.build, options.heuristic, scene),
                   {1, false}, console.progress());
  const BuildOptions& tree = build.options;
  const PlanOutcome plan = plan_of(options, context, build, scene, console.progress());
  stop_if_interrupted();
  const Outcome outcome = render_timed(options, context, build, plan, scene, console.progress());
  write_pictures(options, outcome);
  for (const std::string& note : outcome.result.notes) console.note(note);
  Json document = start_document("render");
  add_device(document, &context.device());
  add_scene(document, options.scene, scene);
  add_tree_options(document, context.device(), scene.triangles.size(), tree);
  add_heuristic(document, options.heuristic, scene);
  add_build(document, build);
  add_tree_file(document, build);
  add_outcome(document, options, outcome);
  add_plan(document, plan);
  console.print(document);
  console.print(facts_of(options, context.device(), scene, describe(options.heuristic, tree, scene), build,
                         plan, outcome));
  return 0;
}

}  // namespace

void add_render_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("render", "Make a picture of a scene, and a heat map of the work.");
  add_scene_options(*command, options->scene);
  command->add_option("-o,--output", options->file, "the PNG file to write")->required()->type_name("PNG");
  command
      ->add_option("--heat-map", options->heat_map,
                   "also a picture of the boxes tested by each pixel's camera rays")
      ->type_name("PNG");
  add_count(*command, "--width", options->render.width, "in pixels, up to 16384");
  add_count(*command, "--height", options->render.height, "in pixels, up to 16384");
  CLI::Option* const samples = add_count(*command, "--samples", options->samples,
                                         "trace so many paths through each pixel, 1 to 4096: light as it "
                                         "is, and noise that halves with four times as many")
                                   ->check(CLI::Range(1, 4096))
                                   ->default_str("");
  add_count(*command, "--preview", options->render.samples,
            "without --samples: a preview from so many camera rays a pixel, up to 4096")
      ->excludes(samples);
  command
      ->add_option("--record", options->record, "with --samples: store a sample of the rays traced, by kind")
      ->type_name("GNR");
  add_count(*command, "--record-rays", options->record_rays, "so many rays in it at most")
      ->check(CLI::Range(1, 1000000000));
  command
      ->add_option(
          "--order", options->order,
          "with --samples: light sorts shadow rays by the light they go to and where to before they are "
          "traced, which pays in scenes where they cost much, such as cities; the same picture")
      ->check(CLI::IsMember({"given", "light"}))
      ->type_name("O")
      ->capture_default_str();
  add_count(*command, "--seed", options->render.seed, "the same seed gives the same picture");
  command->add_option("--exposure", options->exposure, "brighter or darker than by itself, in steps of two")
      ->check(CLI::Range(-20.0, 20.0))
      ->type_name("EV")
      ->capture_default_str();
  add_heuristic_options(*command, options->heuristic);
  add_build_options(*command, options->build);
  add_tree_file_option(*command, options->tree_file);
  add_plan_options(*command, options->plan,
                   "rays of a kind to come, that a tree must repay itself over; default: this picture's");
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Through the scene's first camera (else one that sees all of it), lit by its lights (else by a sun) "
      "and a\n"
      "sky. A preview has direct light, matt surfaces and light that bounced once, smoothed. With --samples "
      "paths\n"
      "are traced: matt and glossy surfaces and metals, all bounces. Ctrl-C leaves no half picture or "
      "record.\n\n" +
      explain_plans() +
      "\nExamples:\n  gnomon render model.glb -o model.png\n"
      "  gnomon render gen:atrium -o atrium.png --samples 64 --record rays.gnr\n"
      "  gnomon render gen:atrium -o atrium.png --heat-map boxes.png --preview 32");
  command->callback([&action, options, command] {
    settle(*command, options->plan);
    options->render.sort_by_light = options->order == "light";
    action = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace gnomon::app
