// gnomon plan: which trees a scene's rays need, and why.
#include <memory>
#include <sstream>

#include "commands.h"
#include "device_builder.h"
#include "device_choice.h"
#include "document.h"
#include "interrupt.h"
#include "plan_choice.h"
#include "plan_rays.h"
#include "ray_batch.h"
#include "scene_source.h"

namespace gnomon::app {
namespace {

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  std::vector<std::string> kinds{"primary", "bounce", "shadow"};
  RayFileOptions rays_in;
  std::string query = "closest";
  std::uint64_t expected = 16'777'216;  // 64 a pixel of 512 x 512
  std::uint64_t seed = 1;
  PlanOptions plan;
};

std::vector<PlanRays> rays_of(const Options& options, const Scene& scene, const cl::Context& context,
                              const Progress& progress) {
  const auto expected = static_cast<double>(options.expected);
  std::vector<PlanRays> out;
  if (!options.rays_in.file.empty()) {
    for (const NamedRays& some : read_ray_file(options.rays_in)) {
      const Query query = options.query == "any" || some.kind == "shadow" ? Query::kAny : Query::kClosest;
      out.push_back(rays_to_plan_for(some.kind == "file" ? options.rays_in.file : some.kind, query, some.rays,
                                     expected));
    }
    return out;
  }
  const DeviceBvh tree = build_device(context, scene.triangles, {}, nullptr, progress);
  for (const std::string& kind : options.kinds)
    out.push_back(
        rays_to_plan_for(*ray_kind_from(kind), scene, context, tree, expected, options.seed, progress));
  return out;
}

int run(const Options& options, Console& console) {
  options.plan.check();
  const cl::Context context = open_device(options.device);
  const Scene scene = load_scene(options.scene, console);
  std::vector<PlanRays> rays = rays_of(options, scene, context, console.progress());
  stop_if_interrupted();
  PlanOptions how = options.plan;
  how.light_space = traces_wide(context.device(), TraceFlavour::kAuto);
  how.local_trees = how.light_space;
  if (how.local_trees) add_regions(rays, scene);
  how.packets = takes_packets(context.device(), TraceFlavour::kAuto);
  const Plan plan = make_plan(scene.triangles, rays, how, device_builder(context), console.progress());
  stop_if_interrupted();
  Json document = start_document("plan");
  add_device(document, &context.device());
  add_scene(document, options.scene, scene);
  const bool drawn = options.rays_in.file.empty();
  document["options"] = {{"rays", drawn ? Json(options.kinds) : Json(nullptr)},
                         {"rays_in", drawn ? Json(nullptr) : Json(options.rays_in.file)},
                         {"kinds", options.rays_in.kinds},
                         {"expected_rays", options.expected},
                         {"seed", options.seed},
                         {"plan", options.plan.choice}};
  document.update(Json::parse(to_json(plan)));
  console.print(document);
  console.print(plan_table(plan));
  return 0;
}

}  // namespace

void add_plan_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand("plan", "Say which trees a scene's rays need, and why.");
  add_scene_options(*command, options->scene);
  add_ray_kind_options(*command, options->kinds, options->rays_in);
  command
      ->add_option("--query", options->query,
                   "what is asked of the file's rays: closest or any; of a record's shadow rays always any")
      ->check(CLI::IsMember({"closest", "any"}))
      ->type_name("Q")
      ->capture_default_str();
  add_expected_rays(*command, options->expected);
  add_count(*command, "--seed", options->seed, "for the rays that are drawn at random");
  command->add_option("--plan", options->plan.choice, "auto, or the tree to keep without a test")
      ->type_name("NAME")
      ->capture_default_str();
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      std::string(kPlanHelp) + "\n" + explain_ray_kinds() +
      "\nExamples:\n  gnomon plan model.glb\n  gnomon plan gen:city:100k --rays shadow --expect 1G --json\n"
      "  gnomon plan model.glb --rays-in my.rays --query any\n"
      "  gnomon render model.glb -o picture.png --samples 64 --record rays.gnr && gnomon plan model.glb "
      "--rays-in rays.gnr");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
